"""What models of jointed rock have in common, and how one of them is run."""
import resource, subprocess


def head(r):
    """Gravity and a random rock, up to its joint `natural`, whose properties come next."""
    return f'''talus = 1
[model]
gravity = [0, -9.81]
[material.rock]
density = "2700 kg/m3"
young = "{r.uniform(5, 40):.1f} GPa"
poisson = 0.25
[joint.natural]
'''


def ground(level, pressure, k0):
    """Stress of the ground, from the height of its surface [m] and what presses on that [MPa]."""
    return f'[in_situ]\nlevel = {level:.2f}\npressure = "{pressure}"\ndensity = "2700 kg/m3"\nk0 = {k0:.2f}\n'


def supports():
    """The base held, both sides on rollers."""
    return "".join(f'[[support]]\nname = "{n}"\nalong = "{n}"\n' + ('' if n == "base" else 'x = "fixed"\ny = "free"\n')
                   for n in ("base", "right", "left"))


def run(talus, file, out, cpu):
    """`talus run` by one thread, for no more than so many seconds of processor."""
    return subprocess.run([talus, "run", file, "-o", out, "--threads", "1"], capture_output=True, text=True,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (cpu, cpu + 2)))
