#!/usr/bin/env python3
"""Whether the daily tests notice a numerical constant that is half or twice what it should be.

Usage: tests/mutation.py [--room ROOM]... [--only NAME]... [--table FILE] [--list]

Takes a copy of the working tree to build/mutation, builds it, and for each constant of contact, solve, supports, step and
audit (or of the rooms given) halves it, builds, runs the tests of units, verification and the command, puts it back, and
doubles it. The table (build/mutation/table.csv) grows by a row each and is gone on with where it was broken off. A constant
is caught by a test that fails, or by a build that does. A few minutes each on two processors: some hours for all.
"""
import argparse
import csv
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build/mutation"
ROOMS = ("contact", "solve", "supports", "step", "audit")
LINE = re.compile(r"constexpr (?:double|int|int64_t|size_t) ((?:k[A-Z]\w* = [^;{]+?(?:, |(?=;)))+);")
ITEM = re.compile(r"(k[A-Z]\w*) = (-?\d[\d.]*(?:e-?\d+)?)(?=$| ?[/*])")


def constants(root, rooms):
    """(file, name, value) of every constant that is written as a number, or begins with one."""
    for room in rooms:
        for path in sorted((root / "src/talus" / room).glob("*.*")):
            for line in path.read_text().splitlines():
                match = LINE.search(line)
                for part in match.group(1).split(", ") if match else ():
                    item = ITEM.match(part.strip())
                    if item and float(item.group(2)) != 0:
                        yield path.relative_to(root), item.group(1), item.group(2)


def times(value, factor):
    whole = re.fullmatch(r"-?\d+", value)
    if not whole:
        return repr(float(value) * factor)
    changed = int(value) * 2 if factor > 1 else int(value) // 2
    return str(changed)


def copy_tree():
    tree = WORK / "tree"
    tree.mkdir(parents=True, exist_ok=True)
    names = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.split("\n")
    for name in filter(None, names):
        to = tree / name
        if (ROOT / name).is_file() and not (to.is_file() and to.read_bytes() == (ROOT / name).read_bytes()):
            to.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, to)
    return tree


def build(tree):
    if not (WORK / "build/build.ninja").exists():
        subprocess.run(["cmake", "--preset", "release", "-B", WORK / "build", "-DTALUS_PYTHON=OFF", "-DTALUS_STUDIES=OFF"], cwd=tree, check=True,
                       stdout=subprocess.DEVNULL)
    done = subprocess.run(["cmake", "--build", WORK / "build", "--target", "unit", "verification", "command", "talus_app"], capture_output=True, text=True)
    return "" if done.returncode == 0 else "the build: " + next((line for line in done.stdout.splitlines() if "error:" in line), "?")[-120:]


def first_failure():
    for tests in ("^unit:", "^verification:", "^command:"):
        done = subprocess.run(["ctest", "-j", "2", "--stop-on-failure", "-R", tests], cwd=WORK / "build", capture_output=True, text=True)
        if done.returncode:
            failed = re.findall(r"^\s*\d+ - (.*) \((?:Failed|Timeout|Subprocess aborted|SEGFAULT)\)", done.stdout, re.M)
            return failed[0] if failed else "?"
    return ""


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("--room", action="append"), parser.add_argument("--only", action="append")
    parser.add_argument("--table", type=pathlib.Path, default=WORK / "table.csv"), parser.add_argument("--list", action="store_true")
    args = parser.parse_args()
    tree = ROOT if args.list else copy_tree()
    found = [c for c in constants(tree, args.room or ROOMS) if not args.only or c[1] in args.only]
    if args.list:
        for path, name, value in found:
            print(f"{path}: {name} = {value}")
        return 0
    known = {tuple(row[:3]) for row in csv.reader(args.table.open())} if args.table.exists() else set()
    trouble = build(tree) or first_failure()
    if trouble:
        sys.exit(f"nothing was changed yet, and this fails: {trouble}")
    passed = 0
    for path, name, value in found:
        for factor in (0.5, 2):
            changed = times(value, factor)
            if changed == value or (str(path), name, changed) in known:
                continue
            text = (tree / path).read_text()
            (tree / path).write_text(re.sub(rf"(\b{name} = ){re.escape(value)}(?=[,; /*])", rf"\g<1>{changed}", text, count=1))
            try:
                caught = build(tree) or first_failure()
            finally:
                (tree / path).write_text(text)
            passed += not caught
            with args.table.open("a", newline="") as file:
                csv.writer(file).writerow([path, name, changed, value, caught])
            print(f"{path.name}: {name} = {changed} (of {value}): {caught or 'NOBODY NOTICES'}", flush=True)
    print(f"{passed} passed unseen")
    return 1 if passed else 0


sys.exit(main())
