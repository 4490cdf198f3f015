#!/usr/bin/env python3
"""Fails on an include that goes up in the order of the folders (docs/architecture.md), and on files that include each
other in a ring, a source counted as one with its header.

Usage: check_layers.py src/talus
"""
import pathlib
import re
import sys

# each folder and the folders it may include, besides itself
ALLOWED = {
    "base": "",
    "record": "base",
    "geometry": "base",
    "mesh": "base geometry",
    "schema": "base",
    "model": "base schema geometry record mesh",
    "maps": "base schema geometry model",
    "cut": "base schema geometry model",
    "blocks": "base geometry model cut",
    "rows": "base geometry model cut blocks",
    "contact": "base geometry model cut blocks rows",
    "corners": "base geometry model cut blocks rows contact",
    "supports": "base geometry model cut blocks rows",
    "solve": "base model blocks rows",
    "step": "base geometry model cut blocks rows contact corners supports solve",
    "penalty": "base geometry model cut blocks rows contact corners supports solve step",
    "output": "base geometry model cut blocks",
    "audit": "base geometry output",
    "run": "base schema geometry record model cut blocks rows contact corners supports solve step penalty output",
    "results": "base schema geometry record model maps cut blocks rows contact corners supports solve step output audit plot run",
    "plot": "base geometry record model maps cut output",
    "report": "base schema geometry model cut output plot",
    "study": "base schema record output plot",
}


def rings(root, files):
    """Files that lead back to themselves, as text."""
    uses = {}
    for path in files:
        name = str(path.relative_to(root).with_suffix(""))
        found = re.findall(r'#include\s+"talus/([^"]+)\.h"', path.read_text())
        uses.setdefault(name, set()).update(other for other in found if other != name)
    out, done = [], set()

    def visit(name, trail):
        if name in trail:
            out.append("ring: " + " -> ".join(trail[trail.index(name):] + [name]))
        elif name not in done:
            for other in sorted(uses.get(name, ())):
                visit(other, trail + [name])
            done.add(name)

    for name in sorted(uses):
        visit(name, [])
    return out


def main() -> int:
    root = pathlib.Path(sys.argv[1])
    wrong = []
    files = sorted(p for p in root.rglob("*") if p.suffix in (".h", ".cpp"))
    for path in files:
        relative = path.relative_to(root)
        if len(relative.parts) == 1:
            continue  # talus.h, the public face
        folder = relative.parts[0]
        if folder not in ALLOWED:
            wrong.append(f"{path}: folder '{folder}' is not in the order; add it to tools/check_layers.py")
            continue
        allowed = set(ALLOWED[folder].split()) | {folder}
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = re.match(r'\s*#include\s+"([^"]+)"', line)
            if not match:
                continue
            parts = match.group(1).split("/")
            if parts[0] != "talus":
                wrong.append(f"{path}:{number}: write includes from the root: \"talus/...\"")
            elif parts[1] not in allowed:
                wrong.append(f"{path}:{number}: {folder}/ may not include {parts[1]}/")
    wrong += rings(root, files)
    for text in wrong:
        print(text)
    print(f"{len(files)} files, {len(wrong)} wrong includes")
    return 1 if wrong or not files else 0


if __name__ == "__main__":
    sys.exit(main())
