#!/usr/bin/python3
"""Every key of the model file with values that nobody means: each run ends with a plain word, and a result is a number.

schema_walk.py TALUS [--jobs N] [--seconds S] [--memory GB] [--only SECTION[.KEY]] [--keep DIR]

Keys come from talus.schema.json (of the program), models are the examples: of each section one that has it, the quickest. One run for
each key and value. Passes: exit 0, 8 (not valid), 3, 4, 5 or 6 with a message; nothing that is not finite in the tables and the summary of
a run that ends with 0; no signal, no exit 1, no exit 7 within the memory given. Runs that are still on their way after S seconds are
ended: they count as running, which is no fault. Exit 1 when any fails; one line for each.
"""
import argparse, collections, concurrent.futures, csv, json, math, os, pathlib, re, resource, shutil, subprocess, sys, tempfile, time

import tomllib

VALUES = ["0", "1", "-1", "1e-300", "1e300", "1.7976931348623157e308", "-1e300", "1e15", "1e-9", "9223372036854775807", "nan", "inf", '""',
          '"abc"', "[]", "[[0,0],[0,0]]", "true", '"1e300 m"', '"-0"']
# Sections of which the examples have none that is quick.
SMALL = '''talus = 1
[material.rock]
density = 2500
[joint.j]
friction_angle = "30 deg"
[contact]
joint = "j"
[[region]]
name = "r"
polygon = [[0, 0], [4, 0], [4, 3], [0, 3]]
sides = ["base", "right", "top", "left"]
material = "rock"
kind = "rigid"
joint = "j"
[[tessellation]]
name = "t"
region = "r"
cells = "triangles"
size = 1.0
irregularity = 0.5
joint = "j"
[[fault]]
name = "f"
points = [[0, 1], [4, 1.4]]
joint = "j"
[[traces]]
name = "tr"
lines = [[[0, 2], [4, 2.3]]]
joint = "j"
[[support]]
name = "b"
along = "base"
[[stage]]
name = "s"
kind = "dynamic"
duration = 0.002
'''
ROOT = pathlib.Path(__file__).resolve().parents[2]


def sections(schema):
    """Each section with its keys."""
    out = {}
    for name, what in schema["properties"].items():
        inner = what.get("items", what)
        if isinstance(inner.get("additionalProperties"), dict):
            inner = inner["additionalProperties"]
        if "properties" in inner:
            out[name] = list(inner["properties"])
    out[""] = [name for name in schema["properties"] if name not in out]
    return out


def short(model, text):
    """Overrides by which a model ends soon."""
    out = []
    for stage in model.get("stage", []):
        if stage.get("kind") == "dynamic":
            out.append(f"stage.{stage['name']}.duration=2e-3")
    return out + ["output.field_interval=0", "output.save_interval=0", "output.pictures=false"]


def place(model, section):
    """Dotted path of the first entry of a section; None where the model has none."""
    if section == "":
        return ""
    there = model.get(section)
    if not there:
        return None
    if isinstance(there, list):
        return f"{section}.{there[0].get('name', 0)}."
    if section in ("material", "joint", "history", "bolt_type"):
        return f"{section}.{next(iter(there))}."
    return f"{section}."


def run(talus, model, overrides, out, seconds, memory, verb=("run",)):
    words = [talus, *verb, str(model), "-q", "--threads", "1", "-o", out]
    for item in overrides:
        words += ["--set", item]

    def limits():
        resource.setrlimit(resource.RLIMIT_AS, (memory, memory))
        resource.setrlimit(resource.RLIMIT_FSIZE, (1 << 28, 1 << 28))

    begun = time.monotonic()
    try:
        done = subprocess.run(words, capture_output=True, text=True, errors="replace", timeout=seconds, preexec_fn=limits)
        return done.returncode, (done.stderr + done.stdout).strip(), time.monotonic() - begun
    except subprocess.TimeoutExpired:
        return None, "", seconds


def not_finite(folder):
    """The first number of the results that is not finite, with its place."""
    for path in sorted(pathlib.Path(folder).glob("*.csv")):
        with open(path, newline="") as file:
            for number, row in enumerate(csv.reader(file), 1):
                for cell in row:
                    if re.fullmatch(r"[-+]?(nan|inf)", cell):
                        return f"{path.name}:{number}: {cell}"
    def look(x, where):
        if isinstance(x, dict):
            return next(filter(None, (look(v, f"{where}.{k}") for k, v in x.items())), None)
        if isinstance(x, list):
            return next(filter(None, (look(v, f"{where}[{k}]") for k, v in enumerate(x))), None)
        return where if x is None and where != ".valid" else None
    try:
        return look(json.load(open(os.path.join(folder, "summary.json"))), "")
    except (OSError, ValueError) as error:
        return str(error)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("talus")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=10)
    parser.add_argument("--memory", type=float, default=3)
    parser.add_argument("--only", default="")
    parser.add_argument("--keep")
    args = parser.parse_args()
    talus, memory = os.path.abspath(args.talus), int(args.memory * 2 ** 30)
    schema = json.load(open(ROOT / "docs/talus.schema.json"))
    work = args.keep or tempfile.mkdtemp(prefix="talus_walk_")
    os.makedirs(work, exist_ok=True)
    models = []
    for path in sorted((ROOT / "examples").glob("*/*.toml")):
        text = path.read_text()
        if "talus_study" in text or "[[map]]" in text:
            continue
        model = tomllib.loads(text)
        code, told, took = run(talus, path, short(model, text), f"{work}/first", 5, memory)
        shutil.rmtree(f"{work}/first", ignore_errors=True)
        if code in (0, 8):
            models.append((took, path, model, short(model, text)))
    small = pathlib.Path(work) / "small" / "small.toml"
    small.parent.mkdir(exist_ok=True)
    small.write_text(SMALL)
    models.append((0, small, tomllib.loads(SMALL), ["output.field_interval=0"]))
    models.sort(key=lambda m: m[0])
    tasks, unreached = [], []
    for section, keys in sections(schema).items():
        if section in ("map", "maps"):
            continue  # read by talus cut alone
        for key in keys:
            if args.only and not f"{section}.{key}".startswith(args.only):
                continue
            having = [m for m in models if place(m[2], section) is not None]
            if not having:
                unreached.append(f"{section}.{key}")
                continue
            def uses(m):
                there = m[2].get(section, {}) if section else m[2]
                first = there[0] if isinstance(there, list) else next(iter(there.values())) if section in ("material", "joint", "history", "bolt_type") else there
                return key in first
            best = next((m for m in having if uses(m)), having[0])
            for value in VALUES:
                tasks.append((f"{place(best[2], section)}{key}={value}", best))

    def one(numbered):
        number, (override, (_, path, _, more)) = numbered
        out = f"{work}/{number:05d}"
        kept = [item for item in more if item.split("=")[0] != override.split("=")[0]]
        code, told, took = run(talus, path, [*kept, override], out, args.seconds, memory)
        fault = ""
        if code is None:
            outcome = "running"
        elif code < 0 or code > 128:
            outcome, fault = f"signal {-code if code < 0 else code - 128}", "signal"
        else:
            outcome = f"exit {code}"
            if code in (1, 2, 7, 10) or code not in (0, 3, 4, 5, 6, 8):
                fault = outcome
            elif code == 0 and (bad := not_finite(out)):
                fault = f"not finite: {bad}"
            elif code not in (0, 8) and not told:
                fault = "no message"
            elif code == 3 and took > 2:
                fault = f"refused after {took:.1f} s"
        shutil.rmtree(out, ignore_errors=True)
        return outcome, fault and f"{path.parent.name}: --set '{override}': {fault}: {told[:160]}"

    counts, faults = collections.Counter(), []
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for outcome, fault in pool.map(one, enumerate(tasks)):
            counts[outcome] += 1
            if fault:
                faults.append(fault)
                print(fault, flush=True)
    if not args.keep:
        shutil.rmtree(work, ignore_errors=True)
    print(f"{len(tasks)} runs of {len(tasks) // len(VALUES)} keys x {len(VALUES)} values: "
          + ", ".join(f"{n} {what}" for what, n in sorted(counts.items())) + f"; {len(faults)} faults")
    if unreached:
        print("no example has: " + ", ".join(unreached))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
