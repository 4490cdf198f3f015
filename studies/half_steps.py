#!/usr/bin/python3
"""Does a shaken model move as far at half and at a quarter of its step, and if not, is that chance?

half_steps.py TALUS OUT MODEL... [--runs N] [--perturb SHARE] [--rest SECONDS] [--jobs N] [--set KEY=VALUE]

Peak and residual displacement of each monitor over the last stage, made longer by SECONDS (5) so that what rocks comes to rest
before it is called residual (of the highest block, where a model has none), at the step that the model runs with, a half and a quarter of it. A value is the same when it is within 10 % or 0.1 mm. Each is
run again with gravity changed by 1e-9 of it: where that moves a value by more than 1 % or 0.01 mm the motion is
chaotic and one run says little ("by chance"); of those that are not the same N runs (64) at the step and N at a quarter of it, gravity drawn within SHARE (1e-3, less than
is known of a model: rocking that has just begun is no chaos at 1e-9 and goes elsewhere at 1e-4) of its own, are of one kind where the medians are the same or the rank test of Mann and Whitney (two-sided, 5 %) does not tell them apart: by
chance alone it does in one of twenty. Python with scipy.
"""
import argparse, concurrent.futures, csv, json, math, os, random, re, statistics, subprocess, sys, tomllib

from scipy.stats import mannwhitneyu

ALONG, UP = ".displacement_x [m]", ".displacement_y [m]"
UNIT = {"": 1.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0}
SAME, FLOOR, CHANCE = 0.10, 1e-4, 0.1     # chance: share of both that tells chaos


class Fault(Exception):
    pass


def gravity(model, share):
    found = re.search(r"^gravity = \[(.*?), *(.*?)\]", model, re.M)
    return f"model.gravity=[{found[1]},{float(found[2]) * (1 + share)!r}]"


def run(args, path, out, sets):
    done, asked = os.path.join(out, "summary.json"), os.path.join(out, "asked.json")
    with open(path) as f: ask = [os.path.realpath(args.talus), os.path.getmtime(args.talus), f.read(), args.set + sets]
    known = None
    if os.path.exists(asked) and os.path.exists(done):
        with open(asked) as f: known = json.load(f)
    if known != ask:
        command = [args.talus, "run", path, "-o", out, "--force", "--threads", "1"]
        for s in args.set + sets: command += ["--set", s]
        done_run = subprocess.run(command, capture_output=True, text=True)
        if not os.path.exists(done) or done_run.returncode == 2: raise Fault(f"{' '.join(command)}: {done_run.stderr.strip()}")
        with open(asked, "w") as f: json.dump(ask, f)
    with open(done) as f: return json.load(f)


def measures(out, summary):
    """{monitor peak, monitor residual: m} over the last stage."""
    with open(os.path.join(out, "histories.csv")) as f: rows = list(csv.DictReader(f))
    begin, values = summary["stages"][-1]["begin [s]"], {}
    last = [r for r in rows if float(r["t [s]"]) >= begin - 1e-9]
    for name in rows[0]:
        if not name.endswith(ALONG): continue
        monitor = name[:-len(ALONG)]
        way = [(float(r[name]), float(r[monitor + UP])) for r in last]
        far = [math.hypot(x - way[0][0], y - way[0][1]) for x, y in way]
        values[monitor + " peak"], values[monitor + " residual"] = max(far), far[-1]
    return values


def with_monitor(args, path, out):
    """The model's own file, or one beside it with a monitor on its highest block."""
    with open(path) as f: text = f.read()
    if "[[monitor]]" in text: return path
    run(args, path, out, [f"stage.{tomllib.loads(text)['stage'][-1]['name']}.duration=1 ms"])
    with open(os.path.join(out, "blocks.csv")) as f: top = max(csv.DictReader(f), key=lambda b: float(b["y [m]"]))
    path = os.path.join(os.path.dirname(path), "monitored_" + os.path.basename(path))
    with open(path, "w") as f:
        f.write(text + f'\n[[monitor]]\nname = "top"\npoint = [{top["x [m]"]}, {top["y [m]"]}]\n')
    return path


def apart(a, b, share=1.0):
    return [k for k in a if abs(a[k] - b[k]) > share * max(FLOOR, SAME * max(abs(a[k]), abs(b[k])))]


def one(args, path):
    name = "_".join(os.path.abspath(path).removesuffix(".toml").split("/")[-3:])
    out = lambda tag: os.path.join(args.out, name, tag)
    os.makedirs(os.path.join(args.out, name), exist_ok=True)
    path = with_monitor(args, path, out("short"))
    with open(path) as f: text = f.read()
    stage = tomllib.loads(text)["stage"][-1]
    given = re.fullmatch(r"([0-9.eE+-]+) *([a-z]*)", str(stage["duration"]))
    if not given or given[2] not in UNIT: raise Fault(f"{path}: duration {stage['duration']!r} of the last stage is no number of s, ms, us or min")
    seconds = float(given[1]) * UNIT[given[2]]
    longer = [f"stage.{stage['name']}.duration={seconds + args.rest!r} s"]
    found, valid, step = [], True, 0.0
    for part in (1, 2, 4):
        cut = [f"new:stage.{stage['name']}.time_step={step / part!r} s"] if part > 1 else []
        s = run(args, path, out(f"part{part}"), longer + cut)
        if s["status"] != "finished": return f"{name:<34} not finished at a step cut by {part}"
        if part == 1: step = s["stages"][-1]["dt [s]"]
        valid = valid and s["valid"]
        found.append(measures(out(f"part{part}"), s))
    show = lambda keys: "; ".join(f"{k} " + " ".join(f"{1e3 * v[k]:.4g}" for v in found) for k in keys) + " mm"
    word = "" if valid else "  NOT VALID"
    keys = sorted(set(apart(found[0], found[1]) + apart(found[0], found[2])))
    told = measures(out("told"), run(args, path, out("told"), longer + [gravity(text, 1e-9)]))
    if not keys: return f"{name:<34} the same{', by chance' if apart(found[0], told, CHANCE) else ''} {show(found[0])}{word}"
    kind = "chaotic" if apart(found[0], told, CHANCE) else f"NOT the same {show(keys)}"
    chance = random.Random(name)
    many = {}
    for part in (1, 4):
        many[part] = []
        for i in range(args.runs):
            sets = longer + [gravity(text, args.perturb * (2 * chance.random() - 1)),
                    f"new:stage.{stage['name']}.time_step={step / part!r} s"]
            folder = out(f"many{part}_{i}")
            s = run(args, path, folder, sets)
            if s["status"] == "finished": many[part].append(measures(folder, s))
    said, no = [], False
    for k in keys:
        a, b = [v[k] for v in many[1]], [v[k] for v in many[4]]
        if min(len(a), len(b)) < 2: return f"{name:<34} {kind}, and too few runs finished{word}"
        p, middle = mannwhitneyu(a, b, alternative="two-sided").pvalue, [statistics.median(a), statistics.median(b)]
        no = no or (p < 0.05 and bool(apart({k: middle[0]}, {k: middle[1]})))
        said.append(f"{k}: medians {1e3 * middle[0]:.4g} {1e3 * middle[1]:.4g} mm of {len(a)} {len(b)}, p {p:.3f}")
    return f"{name:<34} {kind}, {'NOT of one kind' if no else 'of one kind'}: {'; '.join(said)}{word}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("talus"), parser.add_argument("out"), parser.add_argument("models", nargs="+")
    parser.add_argument("--runs", type=int, default=64), parser.add_argument("--perturb", type=float, default=1e-3)
    parser.add_argument("--rest", type=float, default=5.0)
    parser.add_argument("--jobs", type=int, default=2), parser.add_argument("--set", action="append", default=[])
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for line in pool.map(lambda m: one(args, m), args.models): print(line, flush=True)


try:
    main()
except Fault as fault:
    sys.exit(str(fault))
