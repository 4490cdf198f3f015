#!/usr/bin/env python3
"""Contact forces as unknowns beside conventional DDA and the printed equations, on the same models with known answers:
errors, ledger and time over stiffness of the springs and length of the step, as the tables and the figure of
docs/comparison.md; and what ten steps of a tunnel of 5,224 blocks cost.

Usage: compare.py BUILD_DIR OUT [CASE ...]        (all cases, "cost" among them, take some minutes)

OUT gets comparison.csv (every run), tables.md, comparison.svg and, case by case, the result folders: `talus report` of two
of them shows both, `talus compare` their differences.
"""
import csv
import json
import math
import os
import pathlib
import re
import statistics
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parent.parent / "examples"
DOMINOES = 0.5598  # [s] by contact forces at steps of 0.02, 0.01 and 0.005 ms


def column(run, name):
    """A column of histories.csv by the beginning of its title, and the times."""
    with open(run / "histories.csv") as f:
        rows = list(csv.reader(f))
    at = next(i for i, title in enumerate(rows[0]) if title.startswith(name))
    return [float(r[0]) for r in rows[1:]], [float(r[at]) for r in rows[1:]]


def last(run, name):
    return column(run, name)[1][-1]


def bar(run):
    """Impulse on the bar, in units of M1 v0; exact 1.7177 with ten sub-blocks or many."""
    return last(run, "impact.impulse_x") / (2.25 * 1.25) / 1.7176693 - 1


def incline(run):
    return math.hypot(last(run, "block.displacement_x"), last(run, "block.displacement_y")) / 1.314291 - 1


def stands(run):
    """Slip of a block that should stand [m]; told as a share of 1 mm."""
    return math.hypot(last(run, "block.displacement_x"), last(run, "block.displacement_y")) / 1e-3


def shaken(run):
    return last(run, "block.displacement_x") / 1.423471 - 1


def rocking(run):
    """Time of the third impact, where the top passes the upright; exact 1.9794 s."""
    t, x = column(run, "top.displacement_x")
    upright = 0.25 - 0.015978688  # the top of the block that stands, from where it begins
    passed = [t[i] for i in range(1, len(x)) if (x[i - 1] - upright) * (x[i] - upright) < 0]
    return passed[2] / 1.9794 - 1 if len(passed) > 2 else float("nan")


def dominoes(run):
    """Time at which the tenth domino has leant by half its height, over that of contact forces at short steps."""
    t, x = column(run, "top_10.displacement_x")
    at = next((i for i in range(1, len(x)) if x[i] > 0.025), None)
    if at is None:
        return float("nan")
    return (t[at - 1] + (0.025 - x[at - 1]) / (x[at] - x[at - 1]) * (t[at] - t[at - 1])) / DOMINOES - 1


def arch(run):
    return last(run, "left.force_y") / -137674 - 1 if last(run, "left.force_y") < 0 else last(run, "left.force_y") / 137674 - 1


# model, what is set for both, error, springs [Pa] over four decades, steps [s]
CASES = {
    "bar": (EXAMPLES / "impact_bar/impact_bar.toml", [], bar, [4e6, 4e7, 4e8, 4e9, 4e10], ["20 us", "100 us", "500 us"]),
    "incline": (EXAMPLES / "incline/incline.toml", [], incline, [1e8, 1e9, 1e10, 1e11, 1e12], ["1 ms", "5 ms", "20 ms"]),
    "stands": (EXAMPLES / "incline/incline.toml", ['joint.face.friction_angle="30.1 deg"'], stands, [1e8, 1e9, 1e10, 1e11, 1e12], ["1 ms", "5 ms", "20 ms"]),
    "shaken": (EXAMPLES / "sliding_block/sliding_block.toml", [], shaken, [1e8, 1e9, 1e10, 1e11, 1e12], ["1 ms", "5 ms", "20 ms"]),
    "rocking": (EXAMPLES / "rocking_block/rocking_block.toml", [], rocking, [1e8, 1e9, 1e10, 1e11, 1e12], ["0.2 ms", "1 ms", "5 ms"]),
    "dominoes": (EXAMPLES / "dominoes/dominoes.toml", ['output.history_interval="0.5 ms"'], dominoes, [1e6, 1e7, 1e8, 1e9, 1e10], ["0.02 ms", "0.1 ms", "0.5 ms"]),
    "arch": (EXAMPLES / "arch/arch.toml", [], arch, [4e8, 4e9, 4e10, 4e11, 4e12], ["0.2 ms", "2 ms", "10 ms"]),
}


def height(run):
    """Closure of the tunnel's height [mm]: there is no exact one."""
    return 1e3 * last(run, "height.convergence")


CASES["tunnel"] = (HERE / "tunnel.toml", [], height, [4e8, 4e9, 4e10, 4e11, 4e12], ["5 ms", "20 ms"])
PRINTED = ("bar", "incline", "stands", "shaken")  # of which the paper prints all equations
OF_FORCES = {"tunnel": ['stage.ground.integration="implicit"', 'stage.dig.integration="implicit"']}  # static stages as large models take them


# --- what a step costs: the tunnel again in rock of 5,224 blocks, dug; the steps after it ---
LARGE = ['region.rock.polygon=[[-78.115, -78.115], [78.115, -78.115], [78.115, 78.115], [-78.115, 78.115]]',
         'load.overburden.pressure="0.558 MPa"']
FORCES, PENALTY = ("contact_forces", ['stage.ground.integration="implicit"']), ("penalty", [])
DYNAMIC = ['stage.dig.kind="dynamic"']
STATIC = ["stage.dig.unbalanced=1e-12"]  # none rests before its last step
# what, formulation and how the ground comes to rest, step [ms], how the steps are taken
COST = [
    ("contact forces, a step of 0.5 ms", FORCES, 0.5, DYNAMIC + ['stage.dig.elasticity="implicit"']),
    ("contact forces, a static step of 10 ms", FORCES, 10, STATIC + ['stage.dig.integration="implicit"']),
    ("penalty, a step of 0.5 ms", PENALTY, 0.5, DYNAMIC),
    ("penalty, a step of 5 ms", PENALTY, 5, DYNAMIC),
    ("penalty, a static step of 10 ms", PENALTY, 10, STATIC),
]


def processor_seconds():
    """Of all programs run so far."""
    now = os.times()
    return now.children_user + now.children_system


def cost(talus, out):
    """Milliseconds and iterations of each of the ten steps after the tunnel is dug, one thread: the difference of two runs,
    medians of three."""
    rows = []
    for name, (formulation, ground), step, how in COST:
        took = {10: [], 20: []}
        for steps in (10, 20) * 3:
            folder = out / "cost" / f"{steps}"
            overrides = LARGE + ground + how + [f'model.formulation="{formulation}"', f'stage.dig.time_step="{step} ms"',
                                                f'stage.dig.duration="{steps * step:g} ms"']
            begun = processor_seconds()
            run_one(talus, HERE / "tunnel.toml", folder, overrides, ["--threads", "1"])
            took[steps].append(processor_seconds() - begun)
        iterations = json.loads((folder / "summary.json").read_text())["solver"]["iterations_mean"]
        rows.append((name, 100 * (statistics.median(took[20]) - statistics.median(took[10])), iterations))
    return rows


def run_one(talus, model, out, overrides, options=()):
    # a time step goes before the share of a stable limit
    own = out.parent / "model" / model.name
    own.parent.mkdir(parents=True, exist_ok=True)
    stepped = any(".time_step=" in text for text in overrides)
    own.write_text("".join(line for line in model.read_text().splitlines(True) if not (stepped and line.startswith("safety"))))
    command = [talus, "run", str(own), "-o", str(out), "--force", "-q", *options]
    for text in overrides:
        command += ["--set", text]
    begun = time.perf_counter()
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=600)
    wall = time.perf_counter() - begun
    return done.returncode, wall, done.stdout


def row(talus, case, out, formulation, overrides, name):
    model, common, error, _, _ = CASES[case]
    folder = out / case / name
    code, wall, said = run_one(talus, model, folder, [f'model.formulation="{formulation}"'] + common + overrides)
    if code not in (0, 8):
        why = re.sub(r"\s+", " ", said).strip()
        return {"case": case, "name": name, "error": float("nan"), "closure": float("nan"), "wall": wall, "note": why[:100]}
    summary = json.loads((folder / "summary.json").read_text())
    note = "" if summary.get("valid") else "not valid"
    cut = summary.get("penalty", {}).get("steps_cut", 0)
    if cut:
        note += f"{', ' if note else ''}{cut} steps cut"
    return {"case": case, "name": name, "error": error(folder), "closure": summary["energy_closure"], "wall": wall, "note": note}


def stepped(case, step):
    stages = re.findall(r'\[\[stage\]\]\s*\nname = "([^"]+)"', CASES[case][0].read_text())
    return [f'stage.{stage}.time_step="{step}"' for stage in stages]


def rows_of(talus, case, out):
    """Every run of a case: both formulations at their defaults, over steps and springs; the best of that search with what later
    corrections offer; and the printed equations."""
    _, _, _, springs, steps = CASES[case]
    rows = [row(talus, case, out, "contact_forces", OF_FORCES.get(case, []), "forces, its defaults")]
    for step in steps if case not in OF_FORCES else []:
        rows.append(row(talus, case, out, "contact_forces", stepped(case, step), f"forces, {step}"))
    rows.append(row(talus, case, out, "penalty", [], "penalty, its defaults"))
    for stiffness in springs:
        for step in steps:
            overrides = [f'new:penalty.normal_stiffness="{stiffness:g} Pa"'] + stepped(case, step)
            rows.append(row(talus, case, out, "penalty", overrides, f"penalty {stiffness:.0e} Pa, {step}"))
    best = [r for r in rows if r["name"].startswith("penalty ") and math.isfinite(r["error"])]
    if best and case not in OF_FORCES:
        choice = min(best, key=lambda r: abs(r["error"]))
        stiffness, step = re.match(r"penalty (\S+) Pa, (.*)", choice["name"]).groups()
        overrides = [f'new:penalty.normal_stiffness="{float(stiffness):g} Pa"'] + stepped(case, step)
        for name, more in (("exact rotation", ['penalty.rotation="exact"']),
                           ("mean acceleration", ['penalty.rotation="exact"', 'penalty.scheme="mean_acceleration"']),
                           ("6 iterations", ["penalty.max_iterations=6"])):
            rows.append(row(talus, case, out, "penalty", overrides + more, f"best, {name}"))
    if case in PRINTED:
        for step in steps:
            rows.append(row(talus, case, out, "as_printed", stepped(case, step), f"printed, {step}"))
    return rows


def told(row):
    """An error as a cell of a table."""
    if not math.isfinite(row["error"]):
        return "fails" if "fail" in row["note"] or "not solved" in row["note"] else "does not come"
    return f"{row['error']:.1e}" + (" *" if "not valid" in row["note"] else "")


def table(case, rows):
    _, _, _, springs, steps = CASES[case]
    of = {r["name"]: r for r in rows if r["case"] == case}
    lines = [f"### {case}", "", "| | " + " | ".join(steps) + " |", "|---" * (len(steps) + 1) + "|"]
    for head, name in [("contact forces", "forces, {}"), *((f"springs of {s:.0e} Pa", f"penalty {s:.0e} Pa, {{}}") for s in springs),
                       ("as printed", "printed, {}")]:
        cells = [of.get(name.format(step)) for step in steps]
        if any(cells):
            lines.append(f"| {head} | " + " | ".join(told(c) if c else "" for c in cells) + " |")
    forces, penalty = of["forces, its defaults"], of["penalty, its defaults"]
    lines += ["", f"Both at their defaults: {told(forces)} and {told(penalty)}; ledger left over {forces['closure']:.0e} and "
              f"{penalty['closure']:.0e}." + "".join(f" The best of the search, with {n[6:]}: {told(r)}." for n, r in of.items()
                                                      if n.startswith("best, "))]
    return "\n".join(lines) + "\n"


def cheapest(rows, cases):
    lines = ["### time to 1 %", "", "| case | contact forces | penalty |", "|---|---|---|"]
    for case in cases:
        cells = []
        for kind in ("forces", "penalty"):
            good = [r for r in rows if r["case"] == case and r["name"].startswith(kind) and abs(r["error"]) < 0.01]
            fastest = min(good, key=lambda r: r["wall"]) if good else None
            cells.append(f"{fastest['name'].split(', ', 1)[-1] if kind == 'forces' else fastest['name'][8:]}: {fastest['wall']:.2f} s"
                         if fastest else "none")
        lines.append(f"| {case} | {cells[0]} | {cells[1]} |")
    return "\n".join(lines) + "\n"


# --- the figure: error over the stiffness of the springs, a panel a case ---
WIDE, TALL, EDGE, DECADES = 250, 190, 52, (-8, 1)
COLOURS = ("#1b6ca8", "#c8553d", "#5b8c5a")


def panel(case, rows, x0, y0):
    _, _, _, springs, steps = CASES[case]
    of = {r["name"]: r for r in rows if r["case"] == case}
    low, high = math.log10(springs[0]) - 0.3, math.log10(springs[-1]) + 0.3
    left, right, top, bottom = x0 + EDGE, x0 + WIDE - 12, y0 + 24, y0 + TALL - 34
    place_x = lambda k: left + (math.log10(k) - low) / (high - low) * (right - left)
    place_y = lambda e: bottom - (min(max(math.log10(max(abs(e), 1e-30)), DECADES[0]), DECADES[1]) - DECADES[0]) / (
        DECADES[1] - DECADES[0]) * (bottom - top)
    out = [f'<text x="{x0 + 14}" y="{y0 + 15}" class="head">{case}</text>']
    for decade in range(DECADES[0], DECADES[1] + 1, 3):
        y = place_y(10.0 ** decade)
        out.append(f'<line x1="{left}" y1="{y:.1f}" x2="{right}" y2="{y:.1f}" class="grid"/>'
                   f'<text x="{left - 6}" y="{y + 4:.1f}" text-anchor="end">1e{decade}</text>')
    for k in springs:
        out.append(f'<text x="{place_x(k):.1f}" y="{bottom + 15}" text-anchor="middle">{k:.0e}</text>'.replace("e+", "e"))
    for colour, step in zip(COLOURS, steps):
        points = [(place_x(k), place_y(of[name]["error"])) for k in springs
                  if (name := f"penalty {k:.0e} Pa, {step}") in of and math.isfinite(of[name]["error"])]
        out.append('<polyline fill="none" stroke="{}" stroke-width="1.6" points="{}"/>'.format(
            colour, " ".join(f"{x:.1f},{y:.1f}" for x, y in points)))
        out += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.6" fill="{colour}"/>' for x, y in points]
        forces = of.get(f"forces, {step}")
        if forces and math.isfinite(forces["error"]):
            y = place_y(forces["error"])
            out.append(f'<line x1="{left}" y1="{y:.1f}" x2="{right}" y2="{y:.1f}" stroke="{colour}" stroke-width="1.4" stroke-dasharray="5 4"/>')
    legend = "&#160; ".join(f'<tspan fill="{colour}">{step}</tspan>' for colour, step in zip(COLOURS, steps))
    out.append(f'<text x="{right}" y="{y0 + 15}" text-anchor="end">{legend}</text>')
    return "\n".join(out)


def figure(rows, cases):
    drawn = [c for c in cases if c in CASES and c not in OF_FORCES]
    across = 3
    down = -(-len(drawn) // across)
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{across * WIDE}" height="{down * TALL + 26}" '
           f'viewBox="0 0 {across * WIDE} {down * TALL + 26}" font-family="DejaVu Sans, sans-serif" font-size="10">',
           '<style>.head{font-size:12px;font-weight:bold} .grid{stroke:#ddd} text{fill:#333}</style>',
           '<rect width="100%" height="100%" fill="white"/>']
    for i, case in enumerate(drawn):
        out.append(panel(case, rows, i % across * WIDE, i // across * TALL))
    out.append(f'<text x="{EDGE}" y="{down * TALL + 14}">size of the error over the stiffness of the springs [Pa], by step: full penalty, '
               'dashed contact forces; below 1e-8 at the foot</text>')
    return "\n".join(out + ["</svg>"]).replace('text{fill:#333}', '')


def main():
    talus, out = str(pathlib.Path(sys.argv[1]) / "app/talus"), pathlib.Path(sys.argv[2])
    wanted = sys.argv[3:] or [*CASES, "cost"]
    cases = [c for c in wanted if c in CASES]
    out.mkdir(parents=True, exist_ok=True)
    rows = [r for case in cases for r in rows_of(talus, case, out)]
    with open(out / "comparison.csv", "w") as f:
        writer = csv.DictWriter(f, ["case", "name", "error", "closure", "wall", "note"])
        writer.writeheader()
        writer.writerows(rows)
    pages = [table(case, rows) for case in cases] + ([cheapest(rows, cases)] if cases else [])
    if "cost" in wanted:
        lines = ["### cost of a step, tunnel of 5,224 blocks, one thread", "", "| | ms a step | iterations |", "|---|---|---|"]
        lines += [f"| {name} | {ms:.0f} | {iterations:.1f} |" for name, ms, iterations in cost(talus, out)]
        pages.append("\n".join(lines) + "\n")
    (out / "tables.md").write_text("\n".join(pages))
    if cases:
        (out / "comparison.svg").write_text(figure(rows, cases))
    print((out / "tables.md").read_text())


if __name__ == "__main__":
    main()
