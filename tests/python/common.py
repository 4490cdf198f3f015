"""What the tests of the Python package share: where things are, and a block on a slope."""
import pathlib
import sys

BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
ROOT = pathlib.Path(__file__).resolve().parents[2]
EXAMPLES = ROOT / "examples"
PROGRAM = BUILD / "app/talus"

SLOPE = """talus = 1
[model]
gravity = [4.905, -8.495709]
[material.rock]
density = "2600 kg/m3"
[joint.face]
friction_angle = "15 deg"
[contact]
joint = "face"
[[block]]
name = "slope"
polygon = [[-1, -1], [12, -1], [12, 0], [-1, 0]]
material = "rock"
kind = "fixed"
[[block]]
name = "block"
polygon = [[0, 0], [1, 0], [1, 1], [0, 1]]
material = "rock"
kind = "rigid"
[[stage]]
name = "slide"
kind = "dynamic"
duration = "0.5 s"
time_step = "1 ms"
[[stage]]
name = "on"
kind = "dynamic"
duration = "0.5 s"
time_step = "1 ms"
[[monitor]]
name = "block"
point = [0.5, 0.5]
"""
