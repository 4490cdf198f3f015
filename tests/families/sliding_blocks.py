#!/usr/bin/python3
"""A block that slides over blocks whose joints slant, on level ground, a slope and a wall, against the way of a point mass.

sliding_blocks.py TALUS [--only TEXT] [--jobs N]

The block of 1 m begins at 2 m/s on fixed blocks of 0.1 to 0.7 m; friction 0 or 0.3; hard joints or 20 GPa/m; rigid or
deformable; steps of 0.2 or 1 ms. Way after 1 s to 1e-3 of it (1e-2 at 1 ms), no lift above what a joint gives (0.1 mm), and a
valid run. Exit 1 when a case fails; one line for each that does.
"""
import argparse, concurrent.futures, itertools, math, os, random, subprocess, sys, tempfile

ANGLES = (15, 30, 45, 60, 75, 105, 120, 135, 150, 165)
G = 9.81
# ground: its inclination, and gravity along and across it
GROUNDS = {"level": (0, 0, G), "slope": (-25, G * math.sin(math.radians(25)), G * math.cos(math.radians(25))), "wall": (90, 0, G)}


def way(along, across, mu, t=1.0, v=2.0):
    """Of a point mass: it stops where friction holds it."""
    a = along - mu * across
    return v * v / (-2 * a) if a < 0 and v / -a < t else v * t + a * t * t / 2


def model(case):
    ground, angle, mu, hard, kind, dt, spacing = case
    turn, along, across = GROUNDS[ground]
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    out = lambda x, y: f"[{c * x - s * y!r}, {s * x + c * y!r}]"
    joint = f'friction_angle = "{math.degrees(math.atan(mu)):.9f} deg"\n'
    if not hard: joint += 'normal_stiffness = "20 GPa/m"\nshear_stiffness = "20 GPa/m"\n'
    text = f'talus = 1\n[model]\ngravity = {out(along, -across)}\n[material.stone]\ndensity = "2500 kg/m3"\n'
    if kind == "deformable": text += 'young = "20 GPa"\npoisson = 0.2\n'
    text += f'[joint.j]\n{joint}[contact]\njoint = "j"\n'
    reach = way(along, across, mu) + 1.2
    shift, n = 0.5 / math.tan(math.radians(angle)), math.ceil((reach + 1) / spacing) + 1
    for i in range(n):
        x = -0.9 + i * spacing
        corners = ", ".join(out(*p) for p in ((x, 0), (x - shift, -0.5), (x + spacing - shift, -0.5), (x + spacing, 0)))
        text += f'[[block]]\nname = "f{i}"\npolygon = [{corners}]\nmaterial = "stone"\nkind = "fixed"\n'
    corners = ", ".join(out(*p) for p in ((-0.5, 0), (0.5, 0), (0.5, 1), (-0.5, 1)))
    text += f'[[block]]\nname = "b"\npolygon = [{corners}]\nmaterial = "stone"\nvelocity = {out(2, 0)}\n'
    if kind == "rigid": text += 'kind = "rigid"\n'
    return text + f'[[stage]]\nname = "go"\nkind = "dynamic"\nduration = "1 s"\ntime_step = "{dt} ms"\nelasticity = "implicit"\n[[monitor]]\nname = "b"\ncentroid = "b"\n'


def run(talus, case):
    with tempfile.TemporaryDirectory() as folder:
        file, out = os.path.join(folder, "m.toml"), os.path.join(folder, "out")
        with open(file, "w") as f: f.write(model(case))
        done = subprocess.run([talus, "run", file, "-o", out, "--quiet"], capture_output=True, text=True)
        if not os.path.exists(os.path.join(out, "histories.csv")): return f"exit {done.returncode}: {done.stderr.strip()[:200]}"
        with open(os.path.join(out, "histories.csv")) as f: rows = [r.split(",") for r in f.read().split("\n") if r and r[0] != "#"]
        x, y = ([float(r[rows[0].index(f"b.displacement_{a} [m]")]) for r in rows[1:]] for a in "xy")
    turn, along, across = GROUNDS[case[0]]
    c, s = math.cos(math.radians(turn)), math.sin(math.radians(turn))
    gone, lift = c * x[-1] + s * y[-1], max(c * b - s * a for a, b in zip(x, y))
    expected, bound = way(along, across, case[2]), 1e-3 if case[5] == 0.2 else 1e-2
    faults = []
    if done.returncode: faults.append(f"exit {done.returncode}")
    if abs(gone - expected) > bound * expected: faults.append(f"way {gone:.5f} m, expected {expected:.5f}")
    if lift > 1e-4: faults.append(f"lifts by {lift:.2g} m")
    return "; ".join(faults)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("talus"), parser.add_argument("--only", default=""), parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    pick = random.Random(5)
    cases = [(*c, pick.choice((0.1, 0.2, 0.3, 0.5, 0.7))) for c in
             itertools.product(GROUNDS, ANGLES, (0, 0.3), (True, False), ("rigid", "deformable"), (0.2, 1))]
    cases = [c for c in cases if arguments.only in " ".join(map(str, c))]
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for case, fault in zip(cases, pool.map(lambda c: run(arguments.talus, c), cases)):
            if fault: failed += 1; print(*case, "|", fault, flush=True)
    print(f"{len(cases) - failed} of {len(cases)} slide as they should")
    return 1 if failed or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
