#!/usr/bin/env python3
"""Whether two builds give the same bits: runs every example with both, side by side on one thread each, and
compares histories, steps, joints and bolts byte by byte (of a run that is stopped, the rows both have but for
the last, which close windows of averages; of a model without a stage, the blocks it is cut into).

Usage: tools/same_bits.py OLD NEW [-s SECONDS] [EXAMPLE...]     OLD, NEW: build folders; a run stops after SECONDS (20)
"""
import argparse, csv, pathlib, subprocess, sys, tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def start(build, model, out, seconds):
    program = [str(pathlib.Path(build).resolve() / "app/talus")]
    verb = ["run", "--threads", "1", "--quiet"] if "[[stage]]" in model.read_text() else ["cut"]
    line = ["timeout", "--signal=INT", str(seconds), *program, *verb, str(model), "-o", str(out)]
    return subprocess.Popen(line, cwd=model.parent, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def rows_of(path):
    """Lines of numbers as they are; of tables with texts the cells, whatever their heads are called."""
    if not path.exists():
        return []
    if path.name in ("joints.csv", "slips.csv", "bolts.csv"):
        with path.open(newline="") as file:
            return [",".join(row).encode() for row in csv.reader(file)][1:]
    return path.read_bytes().splitlines()


def compare(old, new, stopped):
    """Rows compared and, where one differs, what differs."""
    count = 0
    tables = ["histories.csv", "steps.csv"]
    if not stopped:  # those are written at ends of stages, and where a run stops
        tables += ["joints.csv", "slips.csv", "bolts.csv", "blocks.json", "blocks.csv"]
    for name in tables:
        a, b = rows_of(old / name), rows_of(new / name)
        both = min(len(a), len(b))
        if stopped:
            both -= max(2, both // 20)
        for i in range(both):
            if a[i] != b[i]:
                return count, f"{name} row {i + 1} differs:\n  {a[i][:200].decode()}\n  {b[i][:200].decode()}"
        if len(a) != len(b) and not stopped:
            return count, f"{name}: {len(a)} rows and {len(b)}"
        count += max(both, 0)
    return count, "" if count else "nothing was written"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("old"), parser.add_argument("new"), parser.add_argument("names", nargs="*")
    parser.add_argument("-s", "--seconds", type=float, default=20)
    args = parser.parse_intermixed_args()
    models = sorted(ROOT.glob("examples/*/*.toml"))
    if args.names:
        models = [m for m in models if m.stem in args.names or m.parent.name in args.names]
    different = 0
    for model in models:
        with tempfile.TemporaryDirectory() as folder:
            outs = [pathlib.Path(folder) / "old", pathlib.Path(folder) / "new"]
            runs = [start(b, model, o, args.seconds) for b, o in zip((args.old, args.new), outs)]
            said = [r.communicate()[1] for r in runs]
            if all(r.returncode in (3, 4) for r in runs):
                print(f"{model.stem}: refused by both: {said[0].splitlines()[0][-100:]}")
                continue
            stopped = any(r.returncode not in (0, 8) for r in runs)
            count, what = compare(*outs, stopped)
            different += bool(what)
            whole = " (stopped)" if stopped else ""
            print(f"{model.stem}: " + (f"DIFFERENT: {what}" if what else f"same bits in {count} rows{whole}"), flush=True)
    print("all the same" if not different else f"{different} different")
    return 1 if different else 0


sys.exit(main())
