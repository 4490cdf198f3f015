#!/usr/bin/env python3
"""Conventional DDA (model.formulation = "penalty") beside ntdda, the open implementation of it, on a dry wall at rest: the
same blocks, springs, friction and steps, one thread each, in turn on one machine. Prints medians of the time of a step.

Usage: conventional.py BUILD_DIR OUT [--scenes wall_400,wall_1k] [--repetitions 5] [--penalty 5] [--dt 5e-3]

TALUS_NTDDA names the program (rivals/README.md says how it is built from its sources); without it talus is timed alone.
A step of talus is the difference of two runs, of half a second and of a second, over the steps between them; ntdda's is the
median of its own clock over the same steps.
"""
import argparse
import json
import math
import os
import pathlib
import statistics
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "rivals"))
import ntdda


def model_text(scene, options):
    blocks = "".join(
        f'[[block]]\nname = "b{i}"\nmaterial = "stone"\nkind = "{"fixed" if b["fixed"] else "deformable"}"\n'
        f"polygon = {[[x, y] for x, y in b['corners']]}\n" for i, b in enumerate(scene["blocks"]))
    stages = "".join(f'[[stage]]\nname = "{name}"\nkind = "dynamic"\nduration = 0.5\ntime_step = {options.dt}\n'
                     for name in ("settle", "rest"))
    return f"""talus = 1
[model]
formulation = "penalty"
gravity = [0, -{ntdda.GRAVITY}]
[penalty]
normal_stiffness = {options.penalty * ntdda.YOUNG}
shear_share = 0.4
rotation = "exact"
[material.stone]
density = {scene["density"]}
young = {ntdda.YOUNG}
poisson = {ntdda.POISSON}
[joint.bed]
friction_angle = "{math.atan(scene["friction"]):.17g} rad"
[contact]
joint = "bed"
{stages}{blocks}"""


def talus_run(talus, model, out, more):
    begun = os.times()
    done = subprocess.run([talus, "run", str(model), "-o", str(out), "--force", "-q", "--threads", "1", *more],
                          capture_output=True, text=True)
    if done.returncode not in (0, 8):
        sys.exit(done.stderr[-2000:])
    now = os.times()
    return now.children_user + now.children_system - begun.children_user - begun.children_system


def talus_step(talus, model, out, dt):
    """Milliseconds of a step and iterations of a step."""
    half = talus_run(talus, model, out, ["--until", "settle"])
    whole = talus_run(talus, model, out, [])
    summary = json.loads((out / "summary.json").read_text())
    return 1e3 * (whole - half) / (0.5 / dt), summary["solver"]["iterations_mean"], summary["penalty"]["steps_cut"]


def ntdda_step(scene, folder, options):
    os.makedirs(folder, exist_ok=True)
    phases = ntdda.phases_of(options, False)
    ntdda.write_inputs(folder, scene, phases, options)
    ntdda.run_program(folder)
    steps, _, _ = ntdda.read_result(folder, scene)
    timed = [steps[i] for i in range(phases[0].timed_from + 1, phases[0].last + 1)]
    return 1e3 * statistics.fmean(s[1] for s in timed), statistics.fmean(s[2] for s in timed), sum(s[3] == 0 for s in timed)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build")
    parser.add_argument("out")
    parser.add_argument("--scenes", default="wall_400,wall_1k")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("--penalty", type=float, default=5, help="stiffness of a contact, in Young's moduli")
    parser.add_argument("--dt", type=float, default=5e-3)
    options = parser.parse_args()
    options.settle, options.shake, options.shake_g, options.openclose, options.displacement = 1, 0, 0, 1e-6, 1e-3
    build, out = pathlib.Path(options.build).resolve(), pathlib.Path(options.out)
    os.environ.setdefault("TALUS_SCENE_BLOCKS", str(build / "benchmarks/scene-blocks"))
    out.mkdir(parents=True, exist_ok=True)
    print("| scene | blocks | talus, ms a step | iterations | steps cut | ntdda, ms a step | solutions | unsettled | ntdda / talus |\n|"
          + "---|" * 9)
    for name in options.scenes.split(","):
        scene = ntdda.scene_blocks(name)
        model = out / f"{name}.toml"
        model.write_text(model_text(scene, options))
        ours, theirs = [], []
        for _ in range(options.repetitions):
            ours.append(talus_step(str(build / "app/talus"), model, out / name, options.dt))
            if os.environ.get("TALUS_NTDDA"):
                theirs.append(ntdda_step(scene, str(out / f"ntdda_{name}"), options))
        mine = statistics.median(t for t, _, _ in ours)
        cells = [name, str(len(scene["blocks"])), f"{mine:.2f}", f"{ours[0][1]:.2f}", str(ours[0][2])]
        if theirs:
            rival = statistics.median(t for t, _, _ in theirs)
            cells += [f"{rival:.2f}", f"{theirs[0][1]:.2f}", str(theirs[0][2]), f"{rival / mine:.1f}"]
        print("| " + " | ".join(cells) + " |", flush=True)


if __name__ == "__main__":
    main()
