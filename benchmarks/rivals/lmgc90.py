#!/usr/bin/env python3
"""LMGC90 (contact dynamics of rigid polygons, nonlinear Gauss-Seidel) on the scenes of ../scenes.h; prints the lines
of results that talus-bench prints. TALUS_LMGC90 names the folder that holds its Python package, pylmgc90 (README.md);
TALUS_SCENE_BLOCKS the program scene-blocks, where it is not in build/release.

The course of a run and its measures are those of run_scene() in ../measures.cpp, written once more in Python: what
is timed is a step of LMGC90 alone.
"""

import argparse
import csv
import ctypes
import json
import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

GRAVITY = 9.81  # [m/s^2]
FREQUENCY = 2  # [Hz]
SAMPLES, STEPS_PER_COUNT = 32, 20
TOUCHING, OVERLAPPING = 1e-3, 1e-9  # [m]
STICKING, LOADED, JUDGED = 0.999, 1e-3, 1e-3

COLUMNS = ("engine scene phase blocks threads dt sweeps ms_step_median ms_step_min ms_step_max steps contact_points "
           "ns_block_step ns_point_step overlap_max overlap_mean overlap_rel_max slip_mean slip_max un_mean un_max "
           "balance_mean balance_max coulomb_max drift_max sink_max error_worst rss_bytes bytes_per_block "
           "cpu_s_per_simulated_s samples slip_median slip_worst un_median un_worst overlap_worst").split()


# --- the scene ------------------------------------------------------------------------------------------------------

class Scene:
    """The polygons that scene-blocks prints. Those of fewer corners than others repeat their last one."""

    def __init__(self, name):
        root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
        program = os.environ.get("TALUS_SCENE_BLOCKS",
                                 os.path.join(root, "build", "release", "benchmarks", "scene-blocks"))
        told = json.loads(subprocess.run([program, name], check=True, capture_output=True, text=True).stdout)
        self.kind, self.friction, self.density = told["kind"], told["friction"], told["density"]
        self.fixed = np.array([block["fixed"] for block in told["blocks"]])
        self.polygons = [np.array(block["corners"], dtype=float) for block in told["blocks"]]
        most = max(len(polygon) for polygon in self.polygons)
        self.corners = np.array([np.pad(p, ((0, most - len(p)), (0, 0)), mode="edge") for p in self.polygons])
        start, end = self.corners, np.roll(self.corners, -1, axis=1)
        crossed = start[..., 0] * end[..., 1] - start[..., 1] * end[..., 0]
        self.area = crossed.sum(axis=1) / 2
        self.centroid = ((start + end) * crossed[..., None]).sum(axis=1) / (6 * self.area[:, None])
        self.arms = self.corners - self.centroid[:, None]

    def posed(self, moved, angle):
        """Corners of all blocks whose centroids have moved and that have turned about them."""
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        x, y = self.arms[..., 0], self.arms[..., 1]
        return (self.centroid + moved)[:, None] + np.stack([c * x - s * y, s * x + c * y], axis=-1)


# --- LMGC90 ---------------------------------------------------------------------------------------------------------

def field(value):
    """A number in the fourteen characters that LMGC90 reads, with all digits that fit."""
    return next(text for text in (f"{value:.{digits}f}" for digits in range(12, -1, -1)) if len(text) <= 14)


def write_model(folder, scene, alert):
    """The files that LMGC90 reads. Corners are given where they lie: it finds centroid, area and inertia itself."""
    os.mkdir(os.path.join(folder, "DATBOX"))

    def write(name, lines):
        with open(os.path.join(folder, "DATBOX", name), "w") as file:
            file.write("\n".join(lines) + "\n")

    none = field(0)
    bodies, driven = [], []
    for number, (polygon, fixed) in enumerate(zip(scene.polygons, scene.fixed), 1):
        bodies += ["$bdyty", f" RBDY2{number:7d}", "$blmty",
                   f" PLAIN      1  behav  stone  avrd={none}  gyrd={none}", "$nodty",
                   f" NO3xx      1                coo1={none}  coo2={none}  coo3={none}", "$tacty",
                   f" POLYG      1  color  {'fixed' if fixed else 'loose'}  nb_vertex={len(polygon):7d}"]
        bodies += [f"{'':29}coo1={field(x):>14}  coo2={field(y):>14}" for x, y in polygon] + ["$$$$$$"]
        if fixed:
            driven += ["$bdyty", f" RBDY2{number:7d}", "$nodty", " NO3xx      1", "$dofty"]
            driven += [f" vlocy  {dof:5d}" + 4 * f" {0:14.7e}" + f" {1:14.7e} {0:14.7e}" for dof in (1, 2, 3)]
            driven += ["$$$$$$"]
    write("BODIES.DAT", bodies)
    write("DRV_DOF.DAT", driven)
    write("BULK_BEHAV.DAT", ["$gravy", f"{'':19}grv1={0:14.7e}  grv2={-GRAVITY:14.7e}  grv3={0:14.7e}",
                             "$behav  lawty", f" stone  {'RIGID':30}  Umas={scene.density:14.7e}"])
    # two fixed blocks never meet: a contact of theirs could move nothing
    write("TACT_BEHAV.DAT", ["$behav", f" joint  {'IQS_CLB':30}  fric={scene.friction:14.7e}"] + [
        f"$seety\n cdbdy  cdtac  cdcol  behav  anbdy  antac  ancol       alert\n"
        f" RBDY2  POLYG  loose  joint  RBDY2  POLYG  {other}      {alert:14.7e}" for other in ("loose", "fixed")])


class Engine:
    """LMGC90 by its wrapped calls alone; its own package on top of them wants scipy and more."""

    def __init__(self, scene, options, folder):
        sys.path.insert(0, os.path.join(options.lmgc90, "pylmgc90", "chipy"))
        import lmgc90 as calls
        self.calls, self.scene, self.options = calls, scene, options
        self.sweeps, self.unconverged = 0, 0
        write_model(folder, scene, options.alert)
        calls.overall_Initialize()
        calls.timer_InitializeTimers()
        calls.utilities_setStopMode(False)  # errors become exceptions
        calls.utilities_DisableLogMes()
        calls.overall_SetWorkingDirectory(folder)
        calls.overall_DIME(2, 1)
        calls.TimeEvolution_SetTimeStep(options.dt)
        calls.Integrator_InitTheta(options.theta)
        calls.bulk_behav_ReadBehaviours()
        calls.tact_behav_ReadBehaviours()
        calls.RBDY2_ReadBodies()
        calls.RBDY2_LoadBehaviours()
        calls.RBDY2_ReadDrivenDof()
        calls.POLYG_LoadTactors()
        calls.overall_InitEntityList()
        calls.RBDY2_ComputeMass()
        calls.nlgs_SetCheckType(f"{options.norm:5}", options.tolerance, 1.0)
        self.pairs = calls.parameters_getInteractionId("PLPLx")
        self.start = self.position()
        wrong = np.abs(self.start[:, :2] - scene.centroid).max()
        if wrong > 1e-9:
            raise RuntimeError(f"LMGC90 has read blocks {wrong:g} m from where they are")

    def position(self):
        return self.calls.RBDY2_GetAllBodyVector("Coor_").reshape(-1, 3)

    def moved(self):
        return (self.position() - self.start)[:, :2]

    def polygons(self):
        return self.scene.posed(self.moved(), (self.position() - self.start)[:, 2])

    def set_gravity(self, gravity):
        self.calls.bulk_behav_SetGravity(np.array([gravity[0], gravity[1], 0.0]))

    def step(self):
        calls, options = self.calls, self.options
        calls.overall_CleanWriteOutFlags()
        calls.TimeEvolution_IncrementStep()
        calls.RBDY2_IncrementStep()
        calls.RBDY2_ComputeFext()
        calls.RBDY2_ComputeBulk()
        calls.RBDY2_ComputeFreeVelocity()
        calls.overall_SelectProxTactors(1)
        calls.PLPLx_SelectProxTactors(0)
        calls.inter_handler_2D_recupRloc(self.pairs)
        calls.nlgs_ExPrep(options.storage)
        self.sweeps, missed = 0, int(self.contact_points() > 0)
        while missed == 1 and self.sweeps < options.sweeps:
            calls.nlgs_ExIter(options.check)
            self.sweeps += options.check
            missed = calls.nlgs_AfterIterCheck()
        calls.nlgs_ExPost()
        calls.nlgs_UpdateTactBehav()
        calls.inter_handler_2D_stockRloc(self.pairs)
        calls.RBDY2_ComputeDof()
        calls.TimeEvolution_UpdateStep()
        calls.RBDY2_UpdateDof()
        self.unconverged += missed != 0

    def contact_points(self):
        return self.calls.inter_handler_2D_tgetNb(self.pairs)

    def contacts(self):
        """(block a, block b, normal from a to b, normal and tangent impulse, normal and tangent velocity of b against
        a) of the last step, the tangent being the normal turned left. The velocities are those that the bodies have:
        what LMGC90 keeps of a point is its solution of the point alone."""
        if self.contact_points() == 0:
            none = np.zeros(0)
            return none.astype(int), none.astype(int), none.reshape(0, 2), none, none, none, none
        real = self.calls.inter_handler_2D_getAll(self.pairs)
        whole = self.calls.inter_handler_2D_getAllIdata(self.pairs)
        a, b, point, normal = whole[:, 3] - 1, whole[:, 2] - 1, real[:, 0:2], real[:, 4:6]
        velocity, position = self.calls.RBDY2_GetAllBodyVector("V____").reshape(-1, 3), self.position()

        def at_point(body):
            x, y = (point - position[body, :2]).T
            return velocity[body, :2] + velocity[body, 2:] * np.stack([-y, x], axis=-1)

        u = at_point(b) - at_point(a)
        # forces on the first of its pair, along its normal and along that normal turned right
        return (a, b, normal, real[:, 7] * self.options.dt, -real[:, 6] * self.options.dt,
                (u * normal).sum(axis=1), u[:, 1] * normal[:, 0] - u[:, 0] * normal[:, 1])


# --- accuracy: measures.cpp -----------------------------------------------------------------------------------------

def near_pairs(corners, fixed, distance):
    """Pairs of blocks, not both fixed, whose boxes are nearer than that; the fixed one first."""
    low, high = corners.min(axis=1), corners.max(axis=1)

    def near(i, j):
        return np.all((low[i] <= high[j] + distance) & (low[j] <= high[i] + distance), axis=-1)

    moving = np.flatnonzero(~fixed)
    cell = (high - low)[moving].max() + distance
    filled = {}
    for k, place in zip(moving, map(tuple, np.floor((low[moving] / cell)).astype(int))):
        filled.setdefault(place, []).append(k)
    first, second = [], []
    for (x, y), here in filled.items():
        for i, k in enumerate(here):
            others = here[i + 1:]
            for step in ((1, -1), (1, 0), (1, 1), (0, 1)):
                others = others + filled.get((x + step[0], y + step[1]), [])
            first += [k] * len(others)
            second += others
    first, second = np.array(first, dtype=int), np.array(second, dtype=int)
    kept = near(first, second)
    first, second = [first[kept]], [second[kept]]
    for k in np.flatnonzero(fixed):
        beside = moving[near(k, moving)]
        first.append(np.full(len(beside), k))
        second.append(beside)
    return np.concatenate(first), np.concatenate(second)


def separation_along_edges(a, b):
    """Of every pair, the largest distance over the edges of a by which all of b lies outside that edge."""
    along = np.roll(a, -1, axis=1) - a
    length = np.hypot(along[..., 0], along[..., 1])
    is_edge = length > 0  # not between repeated corners
    outward = np.stack([along[..., 1], -along[..., 0]], axis=-1) / np.where(is_edge, length, 1)[..., None]
    distance = np.einsum("pec,pkc->pek", outward, b) - np.einsum("pec,pec->pe", outward, a)[..., None]
    return np.where(is_edge, distance.min(axis=2), -np.inf).max(axis=1)


def measure_overlap(scene, corners):
    first, second = near_pairs(corners, scene.fixed, TOUCHING)
    apart = [np.zeros(0)]
    for part in range(0, len(first), 100000):
        a, b = corners[first[part:part + 100000]], corners[second[part:part + 100000]]
        apart.append(np.maximum(separation_along_edges(a, b), separation_along_edges(b, a)))
    depth = np.maximum(0, -np.concatenate(apart))
    size = np.sqrt(np.minimum(scene.area[first], scene.area[second]))
    deep = depth[depth > OVERLAPPING]
    return {"overlap_max": depth.max(initial=0), "overlap_mean": deep.mean() if len(deep) else 0,
            "overlap_rel_max": (depth / size).max(initial=0)}


def measure_law(scene, contacts, dt, gravity):
    a, b, normal, pressed, rubbed, apart, along = contacts
    speed, mean = GRAVITY * JUDGED, pressed.mean() if len(pressed) else 0
    loaded = pressed > LOADED * mean
    sticking = loaded & (np.abs(rubbed) < STICKING * scene.friction * pressed)
    un, slip = np.abs(apart[loaded]) / speed, np.abs(along[sticking]) / speed
    tangent = np.stack([-normal[:, 1], normal[:, 0]], axis=-1)
    on_b = pressed[:, None] * normal + rubbed[:, None] * tangent
    mass = scene.density * scene.area[:, None]
    missing = mass * dt * np.array(gravity)
    np.add.at(missing, b, on_b)
    np.add.at(missing, a, -on_b)
    missing = (np.hypot(*missing.T) / (mass[:, 0] * GRAVITY * dt))[~scene.fixed]
    beyond = (np.abs(rubbed) - scene.friction * pressed) / mean if mean > 0 else np.zeros(0)
    error = {"un_mean": un.mean() if len(un) else 0, "un_max": un.max(initial=0),
             "slip_mean": slip.mean() if len(slip) else 0, "slip_max": slip.max(initial=0),
             "balance_mean": missing.mean(), "balance_max": missing.max(), "coulomb_max": beyond.max(initial=0)}
    error["error_worst"] = max(error["slip_max"], error["un_max"], error["coulomb_max"])
    return error


# --- running a scene ------------------------------------------------------------------------------------------------

def resident_bytes():
    ctypes.CDLL(None).malloc_trim(0)
    with open("/proc/self/statm") as file:
        return int(file.read().split()[1]) * resource.getpagesize()


def run_phase(engine, scene, options, phase, duration, resident_before):
    """One line of results, as a dictionary."""
    dt, steps = options.dt, round(duration / options.dt)
    first = steps // 2 if phase == "settle" else 0
    judged, gravity = steps - first, (0.0, -GRAVITY)
    milliseconds, sweeps, points, cpu, laws, overlap = [], [], [], 0.0, [], 0.0
    engine.unconverged = 0
    for i in range(steps):
        if phase == "shake":
            gravity = (-options.shake_g * GRAVITY * np.sin(2 * np.pi * FREQUENCY * (i + 0.5) * dt), -GRAVITY)
        engine.set_gravity(gravity)
        cpu_0, wall_0 = time.process_time(), time.perf_counter()
        engine.step()
        wall_1, cpu_1 = time.perf_counter(), time.process_time()
        if i < first:
            continue
        milliseconds.append(1e3 * (wall_1 - wall_0))
        cpu += cpu_1 - cpu_0
        sweeps.append(engine.sweeps)
        if len(milliseconds) % STEPS_PER_COUNT == 1:
            points.append(engine.contact_points())
        if (i - first) * SAMPLES // judged != (i + 1 - first) * SAMPLES // judged:
            laws.append(measure_law(scene, engine.contacts(), dt, gravity))
            overlap = max(overlap, measure_overlap(scene, engine.polygons())["overlap_max"])
    row = {"rss_bytes": resident_bytes()}
    moving, moved = int((~scene.fixed).sum()), engine.moved()[~scene.fixed]
    median, contact_points = float(np.median(milliseconds)), float(np.mean(points))
    row.update(measure_overlap(scene, engine.polygons()))
    row.update(measure_law(scene, engine.contacts(), dt, gravity))
    slip, un = [law["slip_mean"] for law in laws], [law["un_mean"] for law in laws]
    row.update({
        "engine": options.engine, "scene": options.scene,
        "phase": phase, "blocks": moving, "threads": 1, "dt": dt, "sweeps": float(np.mean(sweeps)),
        "ms_step_median": median, "ms_step_min": min(milliseconds), "ms_step_max": max(milliseconds),
        "steps": len(milliseconds), "contact_points": contact_points, "ns_block_step": 1e6 * median / max(1, moving),
        "ns_point_step": 1e6 * median / max(1, contact_points),
        "drift_max": np.abs(moved[:, 0]).max(initial=0), "sink_max": (-moved[:, 1]).max(initial=0),
        "bytes_per_block": (row["rss_bytes"] - resident_before) / max(1, moving),
        "cpu_s_per_simulated_s": cpu / (dt * len(milliseconds)), "samples": len(laws),
        "slip_median": np.median(slip), "slip_worst": max(slip), "un_median": np.median(un), "un_worst": max(un),
        "overlap_worst": overlap})
    if engine.unconverged:
        print(f"{phase}: {engine.unconverged} of {steps} steps end above the tolerance", file=sys.stderr)
    weight = scene.density * scene.area[~scene.fixed].sum() * GRAVITY
    a, _, normal, pressed, rubbed, _, _ = engine.contacts()
    carried = scene.fixed[a]
    force = (pressed * normal[:, 1] + rubbed * normal[:, 0])[carried].sum() / dt
    print(f"{phase}: {force:.6g} N of a weight of {weight:.6g} N on the fixed blocks", file=sys.stderr)
    return row


def own_output():
    """What this program prints goes where it should; what the library prints goes to the error stream."""
    kept = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)
    return kept


def read_options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene")
    parser.add_argument("--dt", type=float, default=1 / 60, help="[s]")
    parser.add_argument("--settle", type=float, default=1, help="[s]")
    parser.add_argument("--shake", type=float, default=2, help="[s], the hold of scenes that are not shaken")
    parser.add_argument("--shake_g", type=float, default=0.3, help="[g], amplitude of the shaking")
    parser.add_argument("--tolerance", type=float, default=1e-4, help="at which its sweeps end")
    parser.add_argument("--norm", default="Quad", choices=["Quad", "QM/16", "Maxm"], help="of what it holds to it")
    parser.add_argument("--check", type=int, default=20, help="sweeps from one look at the error to the next")
    parser.add_argument("--sweeps", type=int, default=20000, help="at most")
    parser.add_argument("--theta", type=float, default=0.5, help="of its integrator")
    parser.add_argument("--alert", type=float, default=0.01, help="[m] blocks nearer than this have contact points")
    parser.add_argument("--storage", default="Stored_Delassus_Loops",
                        choices=["Stored_Delassus_Loops", "Exchange_Local_Global"])
    options = parser.parse_args()
    options.lmgc90 = os.environ.get("TALUS_LMGC90")
    if not options.lmgc90:
        parser.error("TALUS_LMGC90 does not name the folder that holds pylmgc90")
    # what a row does not tell otherwise
    own = [key for key in ("tolerance", "norm", "storage") if getattr(options, key) != parser.get_default(key)]
    options.engine = "-".join(["lmgc90"] + [f"{getattr(options, key)}" for key in own])
    return options


def main():
    options = read_options()
    output = own_output()
    scene = Scene(options.scene)
    resident_before = resident_bytes()
    with tempfile.TemporaryDirectory() as folder:
        engine = Engine(scene, options, folder)
        writer = csv.DictWriter(output, COLUMNS, lineterminator="\n")
        writer.writeheader()
        shaken = "shake" if scene.kind == "wall" else "hold"
        for phase, duration in (("settle", options.settle), (shaken, options.shake)):
            if round(duration / options.dt) == 0:
                continue
            row = run_phase(engine, scene, options, phase, duration, resident_before)
            writer.writerow({key: value if isinstance(value, str) else f"{value:.6g}" for key, value in row.items()})
            output.flush()


if __name__ == "__main__":
    main()
