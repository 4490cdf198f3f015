#!/usr/bin/python3
"""A corpus of hard steps: the first of each random model that sweeps alone do not solve, solved by the chain of solvers.

hard_steps.py TALUS [--seeds A-B] [--cpu SECONDS] [--keep DIR]

Rock in two or three joint sets, hard or elastic, with and without cohesion and stress of the ground, friction up to 80 degrees. Each
is run by damped motion with 30 sweeps a step and no other solver, which leaves the equations of the first step that these do not
solve; `talus replay` must solve them to the tolerance of the model (or to its `limit`: told as loose). Prints who solved how many, in how many
iterations. Exit 1 when one is not solved.
"""
import argparse, collections, glob, json, math, os, random, re, shutil, subprocess, sys, tempfile

import rock


def model(seed):
    r = random.Random(seed)
    size, hard = r.uniform(10, 40), r.random() < 0.7
    blocks = 15 * 8 ** r.random()
    sets = r.choice((2, 2, 3))
    first = r.uniform(0, 180)
    angles = [first + k * 180 / sets + r.uniform(-15, 15) for k in range(sets)]
    spacing = size * sets / math.sqrt(blocks) / 1.6
    joint = f'friction_angle = "{r.choice((r.uniform(15, 45), r.uniform(60, 80))):.1f} deg"\n'
    if r.random() < 0.4: joint += f'cohesion = "{10 ** r.uniform(-2, -0.3):.3f} MPa"\n'
    if not hard:
        k = 5 * 10 ** r.uniform(0, 1)
        joint += f'normal_stiffness = "{k:.1f} GPa/m"\nshear_stiffness = "{0.5 * k:.1f} GPa/m"\n'
    stress = rock.ground(size + 0.1, f"{r.uniform(0.5, 8):.2f} MPa", r.uniform(0.4, 2)) if r.random() < 0.5 else ""
    joints = "".join(f'[[joint_set]]\nname = "set {k}"\nangle = "{a:.1f} deg"\nspacing = "{spacing * r.uniform(0.7, 1.4):.2f} m"\noffset = "{r.uniform(0, spacing):.2f} m"\n'
                     for k, a in enumerate(angles))
    if stress:
        shape, sides = [[0, 0], [size, 0], [size, size], [0, size]], ["base", "right", "top", "left"]
    else:  # a slope
        x = size / math.tan(math.radians(r.uniform(45, 80)))
        shape, sides = [[-size, -0.3 * size], [1.5 * size, -0.3 * size], [1.5 * size, size], [x, size], [0, 0], [-size, 0]], ["base", "right", "top", "face", "toe", "left"]
    return f'''{rock.head(r)}{joint}[contact]
joint = "natural"
{stress}[[region]]
name = "rock"
polygon = {[[round(a, 3) for a in p] for p in shape]}
sides = {json.dumps(sides)}
material = "rock"
joint = "natural"
{joints}{rock.supports()}[[stage]]
name = "rest"
kind = "static"
integration = "dynamic"
duration = "2 s"
time_step = "{10 ** r.uniform(-3.3, -2):.5f} s"
elasticity = "implicit"
[solver]
method = "gauss_seidel"
second_solver = false
max_sweeps = 30
limit = 1e-8
'''


def hard_step(talus, seed, cpu, folder):
    """The file of the step's equations and the errors [m] that are allowed, or None: all were solved in time."""
    file, out = os.path.join(folder, "m.toml"), os.path.join(folder, f"run{seed}")
    with open(file, "w") as f: f.write(model(seed))
    done = rock.run(talus, file, out, cpu)
    steps = glob.glob(out + "/step_*.json")
    allowed = re.search(r"allowed ([-+.e0-9]+) m", " ".join(done.stderr.split()))
    if steps and allowed: return steps[0], float(allowed[1])
    if done.returncode in (0, 5, 6, 8, 152, -24): return None
    sys.exit(f"seed {seed}: exit {done.returncode}: {done.stderr[-400:]}")


def main():
    a = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    a.add_argument("talus"), a.add_argument("--seeds", default="0-99"), a.add_argument("--cpu", type=int, default=20)
    a.add_argument("--keep", metavar="DIR", help="where the files of the steps go")
    a = a.parse_args()
    first, last = map(int, a.seeds.split("-"))
    by, iterations, loose, unsolved, easy, largest = collections.Counter(), collections.Counter(), 0, [], 0, 0
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(first, last + 1):
            found = hard_step(a.talus, seed, a.cpu, folder)
            if not found:
                easy += 1
                continue
            file, tolerance = found
            said = subprocess.run([a.talus, "replay", file, "--method", "auto", "--tolerance", repr(tolerance)], capture_output=True, text=True).stdout
            answer = re.search(r"^  (\w+) +(\d+) iterations, contact error ([-+.e0-9]+|nan|inf) m", said, re.M)
            points = int(re.search(r"(\d+) points", said)[1])
            error, largest = float(answer[3]), max(largest, points)
            by[answer[1]] += 1
            iterations[answer[1]] = max(iterations[answer[1]], int(answer[2]))
            if not error <= 1e3 * tolerance: unsolved.append(f"seed {seed}: {points} points, error {error:.3g} m, allowed {tolerance:.3g} m")
            loose += tolerance < error <= 1e3 * tolerance
            if a.keep: os.makedirs(a.keep, exist_ok=True), shutil.copy(file, os.path.join(a.keep, f"{seed}.json"))
    steps = sum(by.values())
    print("\n".join(unsolved + [f"{steps} hard steps of {last - first + 1} models, of up to {largest} points: {steps - len(unsolved)} solved, {loose} of them loose"] +
                    [f"  {n} by {name}, at most {iterations[name]} iterations" for name, n in by.most_common()]))
    return 1 if unsolved or steps < (last - first + 1) / 2 else 0


if __name__ == "__main__":
    sys.exit(main())
