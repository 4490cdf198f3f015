#!/usr/bin/python3
"""Random tunnels in rock of two joint sets with stiffness, at rest and cut: each ends in equilibrium, or names what is loose.

tunnels.py TALUS [--seeds A-B] [--jobs N] [--cpu SECONDS] [--least SHARE]

20 to 160 blocks, joints of 5 to 50 GPa/m, in-situ stress, two static stages at their defaults. Passes: exit 0 and valid, or exit 6
with the farthest block named. Exit 1 when fewer than SHARE (29 of 30) pass; one line for each that does not.
"""
import argparse, concurrent.futures, math, os, random, sys, tempfile

import rock


def model(seed):
    r = random.Random(seed)
    size, height = r.uniform(18, 30), r.uniform(3.5, 6)
    pressure, k0, kn = r.uniform(0.5, 6), r.uniform(0.4, 2), 5 * 10 ** r.uniform(0, 1)
    steep, flat = r.uniform(50, 130), r.uniform(-30, 30)
    blocks = 20 * 8 ** r.random()
    one = size / math.sqrt(blocks) * math.sqrt(abs(math.sin(math.radians(steep - flat))))
    stretch = r.uniform(0.7, 1.4)
    spacings = one * stretch, one / stretch
    sets = "".join(f'[[joint_set]]\nname = "{n}"\nangle = "{a:.1f} deg"\nspacing = "{s:.2f} m"\noffset = "{r.uniform(0, s):.2f} m"\n'
                   for n, a, s in zip(("steep", "flat"), (steep, flat), spacings))
    shape = r.choice(("horseshoe", "circle"))
    opening = (f'shape = "horseshoe"\nwidth = "{height * r.uniform(0.9, 1.2):.2f} m"\nheight = "{height:.2f} m"\nsegments = 8\n'
               if shape == "horseshoe" else f'shape = "circle"\ndiameter = "{height:.2f} m"\nsegments = 16\n')
    return f'''{rock.head(r)}friction_angle = "{r.uniform(20, 45):.1f} deg"
normal_stiffness = "{kn:.1f} GPa/m"
shear_stiffness = "{kn * r.uniform(0.3, 1):.1f} GPa/m"
[contact]
joint = "natural"
{rock.ground(size, f"{pressure:.3f} MPa", k0)}[[load]]
name = "overburden"
along = "top"
pressure = "{pressure:.3f} MPa"
[[region]]
name = "rock"
polygon = [[0, 0], [{size:.2f}, 0], [{size:.2f}, {size:.2f}], [0, {size:.2f}]]
sides = ["base", "right", "top", "left"]
material = "rock"
joint = "natural"
{sets}[[opening]]
name = "tunnel"
center = [{size / 2:.2f}, {size / 2:.2f}]
{opening}rock = "kept"
{rock.supports()}[[stage]]
name = "rest"
kind = "static"
duration = "10 s"
[[stage]]
name = "excavation"
kind = "static"
duration = "10 s"
excavate = ["tunnel"]
reset_displacements = true
'''


def run(talus, seed, cpu):
    with tempfile.TemporaryDirectory() as folder:
        file, out = os.path.join(folder, "m.toml"), os.path.join(folder, "out")
        with open(file, "w") as f: f.write(model(seed))
        done = rock.run(talus, file, out, cpu)
    said = " ".join(done.stderr.split())
    return "" if done.returncode == 0 or done.returncode == 6 and 'farthest "' in said else f"exit {done.returncode}: {said[-300:]}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("talus"), parser.add_argument("--seeds", default="0-59"), parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--cpu", type=int, default=20), parser.add_argument("--least", type=float, default=29 / 30)
    arguments = parser.parse_args()
    first, last = map(int, arguments.seeds.split("-"))
    seeds, passed = range(first, last + 1), 0
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for seed, fault in zip(seeds, pool.map(lambda s: run(arguments.talus, s, arguments.cpu), seeds)):
            if fault: print(f"seed {seed} | {fault}", flush=True)
            else: passed += 1
    print(f"{passed} of {len(seeds)} in equilibrium, or what is loose named")
    return 1 if passed < arguments.least * len(seeds) else 0


if __name__ == "__main__":
    sys.exit(main())
