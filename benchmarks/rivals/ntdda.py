#!/usr/bin/env python3
"""ntdda (implicit DDA with penalty contacts and open-close iterations) on the scenes of ../scenes.h; prints the lines
that talus-bench prints. README.md says how the program that TALUS_NTDDA names is built.

Usage: ntdda.py SCENE [--dt 5e-3] [--settle 1] [--shake 2] [--shake_g 0.3]
       and of ntdda alone [--penalty 5] [--openclose 1e-6] [--displacement 1e-3] [--keep FOLDER]

The blocks come from the program scene-blocks: TALUS_SCENE_BLOCKS names it, build/release has it otherwise. What ntdda
does not tell stays empty; "sweeps" is the mean number of solutions of the equations in a step, "contact_points" counts
all points that its search finds, open ones too.
"""

import argparse
import json
import math
import os
import statistics
import subprocess
import sys
import tempfile

GRAVITY = 9.81  # [m/s^2]
FREQUENCY = 2  # [Hz] of the shaking
SAMPLES = 32  # instants of a phase at which overlap is looked for
YOUNG, POISSON = 5e9, 0.29  # [Pa], as talus_engine.cpp
TOUCHING, OVERLAPPING = 1e-3, 1e-9  # [m] as measure_overlap() of measures.h

HEADER = ("engine,scene,phase,blocks,threads,dt,sweeps,ms_step_median,ms_step_min,ms_step_max,steps,contact_points,"
          "ns_block_step,ns_point_step,overlap_max,overlap_mean,overlap_rel_max,slip_mean,slip_max,un_mean,un_max,"
          "balance_mean,balance_max,coulomb_max,drift_max,sink_max,error_worst,rss_bytes,bytes_per_block,"
          "cpu_s_per_simulated_s,samples,slip_median,slip_worst,un_median,un_worst,overlap_worst")

ANALYSIS = """<?xml version="1.0" standalone="no"?>
<Berkeley:DDA xmlns:Berkeley="http://www.tsoft.com/~bdoolin/dda">
<Analysis type="dynamic">
  <Analysistype type="dynamic"/>
  <Rotation type="exact"/>
  <Gravity flag="no"/>
  <Gravaccel value="{gravity}"/>
  <Autotimestep flag="no"/>
  <Autopenalty flag="no" pfactor="{penalty}"/>
  <Planestrain flag="yes"/>
  <Numtimesteps timesteps="{steps}"/>
  <Maxtimestep maxtimestep="{dt}"/>
  <Opencloselimit maxopenclose="0"/>
  <Maxdisplacement maxdisplacement="{displacement}"/>
  <Saveinterval step="1"/>
  <AConstants>
    <Openclose value="{openclose}"/>
    <Opencriteria value="0.0000002"/>
    <NormSpringPen value="0.0004"/>
    <AngleOverlap value="3.0"/>
    <ShearNormRatio value="2.5"/>
  </AConstants>
  <Blockmaterial type="1">
    <Unitmass>{density}</Unitmass>
    <Unitweight>{weight}</Unitweight>
    <Youngsmod>{young}</Youngsmod>
    <Poissonratio>{poisson}</Poissonratio>
    <Damping>0</Damping>
    <Istress>0 0 0</Istress>
    <Ivelocity>0 0 0</Ivelocity>
    <Istrain>0 0 0</Istrain>
  </Blockmaterial>
  <Jointproperties type="1">
    <Friction>{friction}</Friction>
    <Cohesion>0</Cohesion>
    <Tensile>0</Tensile>
  </Jointproperties>
</Analysis>
</Berkeley:DDA>
"""


def scene_blocks(name):
    root = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    program = os.environ.get("TALUS_SCENE_BLOCKS",
                             os.path.join(root, "build", "release", "benchmarks", "scene-blocks"))
    done = subprocess.run([program, name], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr.strip())
    return json.loads(done.stdout)


def centroid(corners):
    x_0, y_0 = corners[0]
    area = x = y = 0.0
    for (x_1, y_1), (x_2, y_2) in zip(corners[1:], corners[2:]):
        part = (x_1 - x_0) * (y_2 - y_0) - (x_2 - x_0) * (y_1 - y_0)
        area += part
        x += part * (x_1 + x_2 - 2 * x_0) / 3
        y += part * (y_1 + y_2 - 2 * y_0) / 3
    return x_0 + x / area, y_0 + y / area, area / 2


def separation_along_edges(a, b):
    """Largest distance, over the edges of a, by which all of b lies outside that edge."""
    best = -math.inf
    for (x_1, y_1), (x_2, y_2) in zip(a, a[1:] + a[:1]):
        length = math.hypot(x_2 - x_1, y_2 - y_1)
        out_x, out_y = (y_2 - y_1) / length, (x_1 - x_2) / length
        best = max(best, min(out_x * (x - x_1) + out_y * (y - y_1) for x, y in b))
    return best


def near_pairs(polygons, fixed, distance):
    """Pairs whose boxes are nearer than the distance: along x sorted, and not of two fixed blocks."""
    boxes = sorted((min(x for x, _ in p), max(x for x, _ in p), min(y for _, y in p), max(y for _, y in p), i)
                   for i, p in enumerate(polygons))
    open_boxes = []
    for box in boxes:
        open_boxes = [other for other in open_boxes if other[1] + distance >= box[0]]
        for other in open_boxes:
            if other[2] <= box[3] + distance and box[2] <= other[3] + distance and not (fixed[box[4]] and
                                                                                       fixed[other[4]]):
                yield other[4], box[4]
        open_boxes.append(box)


def overlap(polygons, fixed):
    """Deepest overlap, mean of those deeper than a nanometre, deepest over the root of the smaller area [m, m, -]"""
    depths, relative = [], 0.0
    for i, j in near_pairs(polygons, fixed, TOUCHING):
        a, b = polygons[i], polygons[j]
        depth = -max(separation_along_edges(a, b), separation_along_edges(b, a))
        if depth > OVERLAPPING:
            depths.append(depth)
            relative = max(relative, depth / math.sqrt(min(centroid(a)[2], centroid(b)[2])))
    return (max(depths), statistics.fmean(depths), relative) if depths else (0.0, 0.0, 0.0)


def looks_of(first, last):
    """The last step of each of 32 equal parts of the steps first+1 to last, as run_scene() chooses them."""
    steps = last - first
    return [first + i + 1 for i in range(steps) if i * SAMPLES // steps != (i + 1) * SAMPLES // steps]


class Phase:
    def __init__(self, name, first, last, timed_from):
        self.name, self.first, self.last, self.timed_from = name, first, last, timed_from
        self.looks = looks_of(timed_from, last)


def phases_of(options, shaken):
    settle, shake = round(options.settle / options.dt), round(options.shake / options.dt)
    phases = [Phase("settle", 0, settle, settle // 2)] if settle else []
    if shake:
        phases.append(Phase("shake" if shaken else "hold", settle, settle + shake, settle))
    return phases


def write_inputs(folder, scene, phases, options):
    steps = phases[-1].last
    looks = sorted(look for phase in phases for look in phase.looks)
    with open(os.path.join(folder, "model.txt"), "w") as file:
        print(len(scene["blocks"]), file=file)
        for block in scene["blocks"]:
            print(int(block["fixed"]), len(block["corners"]), *(repr(c) for p in block["corners"] for c in p),
                  file=file)
        print(len(looks), *looks, file=file)
    with open(os.path.join(folder, "run.ana"), "w") as file:
        file.write(ANALYSIS.format(gravity=GRAVITY, penalty=options.penalty, steps=steps, dt=repr(options.dt),
                                   displacement=options.displacement, openclose=options.openclose,
                                   density=scene["density"], weight=scene["density"] * GRAVITY, young=YOUNG,
                                   poisson=POISSON,
                                   friction=repr(math.degrees(math.atan(scene["friction"])))))
    with open(os.path.join(folder, "history.txt"), "w") as file:
        print(repr(options.dt), steps + 1, file=file)
        print(0, file=file)
        for phase in phases:
            for step in range(phase.last - phase.first):
                angle = 2 * math.pi * FREQUENCY * (step + 0.5) * options.dt
                print(repr(-options.shake_g * math.sin(angle)) if phase.name == "shake" else 0, file=file)


def run_program(folder):
    program = os.environ.get("TALUS_NTDDA")
    if not program:
        sys.exit("TALUS_NTDDA names no program (README.md)")
    command = [os.path.abspath(program), "model.txt", "run.ana", "history.txt", "result.txt"]
    with open(os.path.join(folder, "stdout.txt"), "w") as told, open(os.path.join(folder, "stderr.txt"), "w") as errors:
        code = subprocess.run(command, cwd=folder, stdout=told, stderr=errors).returncode
    if code != 0:
        with open(os.path.join(folder, "stderr.txt"), errors="replace") as errors:
            last = errors.read().strip().rsplit("\n", 1)[-1]
        sys.exit(f"{os.path.basename(program)} ended with {code}: {last[-300:]}")


def read_result(folder, scene):
    """Steps by number, blocks by the number of the step, bytes held before and after."""
    steps, blocks, memory = {}, {0: [block["corners"] for block in scene["blocks"]]}, (0.0, 0.0)
    with open(os.path.join(folder, "result.txt")) as file:
        for line in file:
            kind, *words = line.split()
            if kind == "step":
                steps[int(words[0])] = [float(word) for word in words[1:]]
            elif kind == "blocks":
                values = iter(float(word) for word in words[1:])
                blocks[int(words[0])] = [[(next(values), next(values)) for _ in block["corners"]]
                                         for block in scene["blocks"]]
            else:
                memory = tuple(float(word) for word in words)
    return steps, blocks, memory


def moved(scene, before, after):
    """Largest sideways and largest downward displacement of a moving block's centroid [m]"""
    sideways = down = 0.0
    for block, old, new in zip(scene["blocks"], before, after):
        if block["fixed"]:
            continue
        (x_0, y_0, _), (x_1, y_1, _) = centroid(old), centroid(new)
        sideways, down = max(sideways, abs(x_1 - x_0)), max(down, y_0 - y_1)
    return sideways, down


def print_phase(phase, scene, options, steps, blocks, memory):
    timed = [steps[i] for i in range(phase.timed_from + 1, phase.last + 1)]
    fixed = [block["fixed"] for block in scene["blocks"]]
    moving = fixed.count(False)
    wall = [1e3 * step[0] for step in timed]
    median, points = statistics.median(wall), statistics.fmean(step[4] for step in timed)
    depth, mean_depth, relative = overlap(blocks[phase.last], fixed)
    drift, sink = moved(scene, blocks[0], blocks[phase.last])
    row = {
        "engine": "ntdda", "scene": options.scene, "phase": phase.name, "blocks": moving, "threads": 1,
        "dt": options.dt, "sweeps": statistics.fmean(step[2] for step in timed), "ms_step_median": median,
        "ms_step_min": min(wall), "ms_step_max": max(wall), "steps": len(timed), "contact_points": points,
        "ns_block_step": 1e6 * median / moving, "ns_point_step": 1e6 * median / max(1, points),
        "overlap_max": depth, "overlap_mean": mean_depth, "overlap_rel_max": relative, "drift_max": drift,
        "sink_max": sink, "rss_bytes": memory[1], "bytes_per_block": (memory[1] - memory[0]) / moving,
        "cpu_s_per_simulated_s": sum(step[1] for step in timed) / (options.dt * len(timed)),
        "samples": len(phase.looks),
        "overlap_worst": max(overlap(blocks[look], fixed)[0] for look in phase.looks)}
    text = {name: value if isinstance(value, str) else f"{value:.6g}" for name, value in row.items()}
    print(",".join(text.get(column, "") for column in HEADER.split(",")), flush=True)
    start = blocks.get(phase.first)
    unsettled = sum(step[3] == 0 for step in timed)
    print(f"ntdda, {options.scene}, {phase.name}: contacts unsettled at the end of {unsettled} of {len(timed)} steps" +
          (f"; since its beginning sideways at most {1e3 * moved(scene, start, blocks[phase.last])[0]:.4g} mm, at its "
           f"instants {1e3 * max(moved(scene, start, blocks[look])[0] for look in phase.looks):.4g} mm" if start
           else ""), file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--dt", type=float, default=5e-3)
    parser.add_argument("--settle", type=float, default=1)
    parser.add_argument("--shake", type=float, default=2)
    parser.add_argument("--shake_g", type=float, default=0.3)
    parser.add_argument("--penalty", type=float, default=5, help="normal stiffness of a contact, in Young's moduli")
    parser.add_argument("--openclose", type=float, default=1e-6,
                        help="overlap that closes an open contact, in half widths of the model")
    parser.add_argument("--displacement", type=float, default=1e-3,
                        help="largest step of a corner, in half widths; contacts are looked for within 2.5 times that")
    parser.add_argument("--keep", help="folder for ntdda's files")
    options = parser.parse_args()
    scene = scene_blocks(options.scene)
    phases = phases_of(options, scene["kind"] == "wall")
    if not phases:
        sys.exit("neither settling nor shaking: nothing to do")
    with tempfile.TemporaryDirectory() as temporary:
        folder = options.keep or temporary
        os.makedirs(folder, exist_ok=True)
        write_inputs(folder, scene, phases, options)
        run_program(folder)
        steps, blocks, memory = read_result(folder, scene)
    print(HEADER)
    for phase in phases:
        print_phase(phase, scene, options, steps, blocks, memory)


if __name__ == "__main__":
    main()
