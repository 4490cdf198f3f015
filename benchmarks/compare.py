#!/usr/bin/env python3
"""Runs talus and other programs in turn on the same scenes, keeps every row, prints ratios talus / other.

Usage: compare.py run BUILD_DIR OUT_DIR [--quick] [--scenes A,B] [--repetitions N] [--sweeps K] [--threads T]
       compare.py table FILE.csv [--session all|latest|NAME]

A ratio is always of two runs that follow each other on the same machine; what is printed is the median of
these ratios with the smallest and the largest. Single times of a shared machine mean nothing.
"""

import argparse
import csv
import os
import re
import statistics
import subprocess
import sys
import time

# seconds of settling and of shaking (holding, where there is nothing to shake), by the first name that fits
DURATIONS = [("wall_500k", 0.05, 0.05), ("wall_50k", 0.5, 0.5), ("joint_50k", 0.5, 0.5), ("pile_50k", 4, 0.5),
             ("wall", 1, 2), ("joint", 1, 1), ("pile", 4, 1)]
SCENES = ["wall_1k", "wall_7k"]
ONE_STEP_SCENES = ["wall_1k", "joint_1k"]
QUICK_SCENES, QUICK_ONE_STEP_SCENES = ["wall_1k"], ["wall_400"]
QUICK_SECONDS, QUICK_REPETITIONS = 0.25, 2

TALUS = "talus-bench"
RIVALS = ["rivals/rival_box2d", "rivals/rival_box2d_o3", "rivals/rival_box2d3", "rivals/rival_chipmunk"]
# drivers that are not built, where TALUS_LMGC90 and TALUS_NTDDA name the programs; both take steps of their own
HERE = os.path.dirname(os.path.abspath(__file__))
LMGC90, NTDDA = os.path.join(HERE, "rivals", "lmgc90.py"), os.path.join(HERE, "rivals", "ntdda.py")
NTDDA_SCENES = ["wall_400", "wall_1k"]  # larger walls take it hours
ONE_STEP_TALUS, ONE_STEP_RIVALS = "talus-one-step", ["rivals/rival_siconos"]

RATIOS = [("ms_step_median", "step time"), ("cpu_s_per_simulated_s", "CPU per simulated second"),
          ("bytes_per_block", "bytes per block")]
OWN_COLUMNS = ["session", "commit", "repetition", "load_average"]
ERRORS = ["un_median", "un_worst", "slip_median", "slip_worst", "overlap_worst", "balance_max", "coulomb_max",
          "drift_max", "error_worst"]
# what a time is worth something with: means of the velocities of loaded points over g times a millisecond, at the
# worst of the instants looked at
LEVEL = 3e-3


def cpu_model():
    try:
        with open("/proc/cpuinfo") as info:
            for line in info:
                if line.startswith("model name"):
                    return line.split(":", 1)[1].strip()
    except OSError:
        pass
    return "unknown"


def commit():
    """Of the sources, with a plus where they have been changed since."""
    try:
        done = subprocess.run(["git", "describe", "--always", "--dirty=+"], cwd=HERE, capture_output=True, text=True)
        return done.stdout.strip() or "unknown"
    except OSError:
        return "unknown"


def slug(text):
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")


def run_program(program, arguments):
    """The rows a program prints, as dictionaries in the order of its header; none when it fails."""
    done = subprocess.run([program] + arguments, capture_output=True, text=True)
    if done.returncode != 0:
        print(f"{os.path.basename(program)} {' '.join(arguments)} failed: {done.stderr.strip()[-500:]}",
              file=sys.stderr)
        return []
    lines = done.stdout.splitlines()
    # a library may greet before the header
    start = next((i for i, line in enumerate(lines) if line.startswith("engine,")), len(lines))
    return list(csv.DictReader(lines[start:]))


def append_rows(path, rows, own):
    """Adds rows to the file; a file of other columns is an error, not something to mix."""
    if not rows:
        return
    columns = OWN_COLUMNS + list(rows[0])
    is_new = not os.path.exists(path) or os.path.getsize(path) == 0
    if not is_new:
        with open(path, newline="") as file:
            if next(csv.reader(file)) != columns:
                sys.exit(f"{path} has other columns; move it away and start again")
    with open(path, "a", newline="") as file:
        writer = csv.DictWriter(file, columns, lineterminator="\n")
        if is_new:
            writer.writeheader()
        for row in rows:
            writer.writerow({**dict(zip(OWN_COLUMNS, own)), **row})


def durations(scene):
    return next((settle, shake) for name, settle, shake in DURATIONS if scene.startswith(name))


def programs(options, names):
    """Paths of those programs that are built."""
    paths = [os.path.join(options.build_dir, "benchmarks", name) for name in names]
    return [path for path in paths if os.path.exists(path)]


def rivals(options, scene, common, lengths):
    """(program, arguments) of those that run a whole scene."""
    result = [(path, common) for path in programs(options, RIVALS)]
    os.environ.setdefault("TALUS_SCENE_BLOCKS", os.path.join(options.build_dir, "benchmarks", "scene-blocks"))
    if os.environ.get("TALUS_LMGC90"):
        result.append((LMGC90, [scene] + lengths))
    if os.environ.get("TALUS_NTDDA") and scene in NTDDA_SCENES:
        result.append((NTDDA, [scene] + lengths))
    return result


def plan(options):
    """(program, arguments) of one repetition: talus before every other program, so that each ratio is of
    neighbours in time."""
    scenes = QUICK_SCENES if options.quick else SCENES
    one_step = QUICK_ONE_STEP_SCENES if options.quick else ONE_STEP_SCENES
    if options.scenes:
        scenes, one_step = options.scenes.split(","), []
    tuned = []
    for name in ("sweeps", "threads"):
        if getattr(options, name) is not None:
            tuned += ["--" + name, str(getattr(options, name))]
    for scene in scenes:
        settle, shake = (QUICK_SECONDS, QUICK_SECONDS) if options.quick else durations(scene)
        lengths = ["--settle", str(settle), "--shake", str(shake)]
        common = [scene, "--dt", str(options.dt)] + lengths
        for rival in rivals(options, scene, common, lengths):
            for talus in programs(options, [TALUS]):
                yield talus, common + tuned
            yield rival
    for scene in one_step:
        for rival in programs(options, ONE_STEP_RIVALS):
            for program in programs(options, [ONE_STEP_TALUS]) + [rival]:
                yield program, [scene, "--dt", str(options.dt), "--tolerance", "1e-4"]


def run(options):
    os.makedirs(options.out_dir, exist_ok=True)
    path = os.path.join(options.out_dir, slug(cpu_model()) + ".csv")
    session, version = time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime()), commit()
    repetitions = options.repetitions or (QUICK_REPETITIONS if options.quick else 5)
    if not list(plan(options)):
        sys.exit(f"no programs to compare in {options.build_dir}/benchmarks")
    if not programs(options, [TALUS]):
        print(f"{TALUS} is not built: the other programs alone, without ratios", file=sys.stderr)
    for repetition in range(1, repetitions + 1):
        for program, arguments in plan(options):
            name = os.path.basename(program)
            print(f"{repetition}/{repetitions} {name} {' '.join(arguments)}", file=sys.stderr)
            load = f"{os.getloadavg()[0]:.2f}"
            append_rows(path, run_program(program, arguments), (session, version, repetition, load))
    if os.path.exists(path):
        print_tables(path, session)


def number(row, column):
    return float(row[column]) if row.get(column) else None


def is_talus(row):
    return row["engine"].startswith("talus")


def neighbours(rows):
    """{(scene, phase, dt, talus, other): [(row of talus, row of the other program), ...]}, where the row of
    talus is of its last run before the other program's."""
    result, last = {}, {}
    for row in rows:
        place = (row["session"], row["repetition"], row["scene"], row["phase"])
        if is_talus(row):
            last[place] = row
        elif place in last:
            talus = last[place]
            threads = "" if talus["threads"] == "1" else f", {talus['threads']} threads"
            dt = row["dt"] if row["dt"] == talus["dt"] else f"{talus['dt']} / {row['dt']}"
            key = (row["scene"], row["phase"], dt, talus["engine"] + threads, row["engine"])
            result.setdefault(key, []).append((talus, row))
    return result


def spread_of_ratios(pairs, column):
    both = [(number(talus, column), number(other, column)) for talus, other in pairs]
    ratios = [a / b for a, b in both if a and b]
    if not ratios:
        return "-"
    return f"{statistics.median(ratios):.3g} ({min(ratios):.3g} to {max(ratios):.3g})"


def median_of(rows, column):
    values = [number(row, column) for row in rows]
    values = [value for value in values if value is not None]
    return f"{statistics.median(values):.4g}" if values else "-"


def level_of(rows):
    """Of a program, the worst mean velocities along the phase."""
    worst = []
    for column in ("un_worst", "slip_worst"):
        values = [number(row, column) for row in rows]
        if not values or None in values:
            return "-"
        worst.append(max(values))
    return f"{worst[0]:.2g}, {worst[1]:.2g}" + ("" if max(worst) <= LEVEL else " (missed)")


def print_table(title, header, lines):
    print(f"\n{title}\n")
    print("| " + " | ".join(header) + " |")
    print("|" + " --- |" * len(header))
    for line in lines:
        print("| " + " | ".join(line) + " |")


def print_tables(path, session):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        sys.exit(f"{path} holds no rows")
    if session == "latest":
        session = rows[-1]["session"]
    if session != "all":
        rows = [row for row in rows if row["session"] == session]
    if not rows:
        sys.exit(f"{path} holds no session {session}")

    lines = []
    for (scene, phase, dt, talus, other), pairs in neighbours(rows).items():
        line = [scene, phase, dt, f"{talus} / {other}", str(len(pairs))]
        reached = [level_of(rows) for rows in zip(*pairs)]
        lines.append(line + [spread_of_ratios(pairs, column) for column, _ in RATIOS] + reached)
    if lines:
        print_table("Ratios of neighbouring runs: median (smallest to largest)",
                    ["scene", "phase", "dt", "ratio", "runs"] + [title for _, title in RATIOS] +
                    [f"worst mean un, slip of talus ({LEVEL:g} asked)", "of the other"], lines)

    groups = {}
    for row in rows:
        # a solver that ends by its error takes as many sweeps as it needs
        sweeps = "" if row["phase"] == "one_step" else row["sweeps"]
        key = (row["scene"], row["phase"], row["engine"], row["threads"], row["dt"], sweeps)
        groups.setdefault(key, []).append(row)
    lines = []
    for key, members in groups.items():
        lowest = min(number(row, "ms_step_min") for row in members)
        highest = max(number(row, "ms_step_max") for row in members)
        line = list(key[:5]) + [median_of(members, "sweeps"),
                                f"{median_of(members, 'ms_step_median')} ({lowest:.3g} to {highest:.3g})"]
        lines.append(line + [median_of(members, column)
                             for column in ["contact_points", "cpu_s_per_simulated_s"] + ERRORS])
    print_table("Times and errors of every engine: medians over the repetitions, single steps in brackets",
                ["scene", "phase", "engine", "threads", "dt", "sweeps", "ms per step", "points",
                 "CPU s per simulated s"] + ERRORS, sorted(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    runner = commands.add_parser("run", help="run the programs and print the table")
    runner.add_argument("build_dir")
    runner.add_argument("out_dir")
    runner.add_argument("--quick", action="store_true", help="small scenes, short, twice")
    runner.add_argument("--scenes", help="names parted by commas, instead of the usual ones")
    runner.add_argument("--repetitions", type=int)
    runner.add_argument("--dt", type=float, default=1e-3)
    runner.add_argument("--sweeps", type=int, default=10,
                        help="of talus, 10 as documented; the other programs keep theirs")
    runner.add_argument("--threads", type=int, help="of talus")
    printer = commands.add_parser("table", help="print the table of a file again")
    printer.add_argument("file")
    printer.add_argument("--session", default="latest")
    options = parser.parse_args()
    if options.command == "run":
        run(options)
    else:
        print_tables(options.file, options.session)


if __name__ == "__main__":
    main()
