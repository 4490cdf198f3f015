#!/usr/bin/env python3
"""Writes docs/python_api.md: every public name of the Python package, by its docstrings.

Usage: PYTHONPATH=BUILD_DIR/python tools/python_api.py [--check]   (--check: only whether the page is as it would be written)
"""
import inspect
import pathlib
import re
import sys

import talus

PAGE = pathlib.Path(__file__).resolve().parents[1] / "docs/python_api.md"
ORDER = ["Model", "Cut", "Run", "Instant", "Result", "State", "Results", "Frame", "Study", "StudyResults", "Error", "InputError", "FileError",
         "NumericalError", "Finding"]


def signature(name, what):
    """name(a, b=1): types stand in the package."""
    shown, keywords = [], False
    for p in inspect.signature(what).parameters.values():
        if p.name == "self":
            continue
        if p.kind == p.KEYWORD_ONLY and not keywords:
            keywords = True
            shown.append("*")
        stars = {p.VAR_POSITIONAL: "*", p.VAR_KEYWORD: "**"}.get(p.kind, "")
        keywords = keywords or p.kind == p.VAR_POSITIONAL
        shown.append(stars + p.name + ("" if p.default is p.empty else f"={p.default!r}"))
    return f"{name}({', '.join(shown)})"


def paragraphs(doc):
    return inspect.cleandoc(doc or "").rstrip()


def members(cls):
    """Public members, of the class and of those of the package that it stands on."""
    own = [c for c in cls.__mro__ if c.__module__.startswith("talus") and not issubclass(c, Exception)]
    for name in dict.fromkeys(n for c in own for n in vars(c)):
        if not name.startswith("_"):
            yield name, inspect.getattr_static(cls, name)


def entry(name):
    cls = getattr(talus, name)
    lines = [f"## {name}", "", "```text", paragraphs(cls.__doc__), "```", ""]
    fields = getattr(cls, "__dataclass_fields__", {})
    made = "__init__" in vars(cls) and cls.__module__ != "talus._talus" and name not in ("Run", "Frame") and not fields
    if made:
        lines.append(f"- `{signature('talus.' + name, cls.__init__)}`")
    for member, found in members(cls):
        if member in fields:
            continue
        if isinstance(found, property):
            doc, shown = found.__doc__, f"`{member}`"
        elif callable(found) or isinstance(found, (classmethod, staticmethod)):
            what = getattr(cls, member)
            doc, shown = what.__doc__, f"`{signature(member, what)}`"
        else:
            continue
        if not doc:
            sys.exit(f"{name}.{member} has no docstring")
        first, *rest = paragraphs(doc).split("\n\n", 1)
        lines.append(f"- {shown}: {' '.join(first.splitlines())}")
        for text in rest:
            lines += ["", "  ```text", *("  " + line if line else "" for line in text.splitlines()), "  ```", ""]
    lines += [f"- `{f.name}`" + ("" if f.default is f.default_factory else f" (`{f.default!r}`)") for f in fields.values()]
    return re.sub("\n{3,}", "\n\n", "\n".join(lines)).rstrip() + "\n"


def page():
    missing = set(talus.__all__) - set(ORDER) - {"__version__"}
    if missing:
        sys.exit(f"ORDER lacks {', '.join(sorted(missing))}")
    head = ("# Python API\n\nEvery public name of the package `talus`, as its docstrings have it ([a way in](python.md)). Arrays are NumPy's; shapes, units "
            "and signs stand with each. Numbers of the theory are those of [theory](theory.md).\n")
    return head + "\n" + "\n".join(entry(name) for name in ORDER)


def main():
    text = page()
    if sys.argv[1:] == ["--check"]:
        if not PAGE.exists() or PAGE.read_text() != text:
            sys.exit(f"{PAGE} is not what the docstrings say: tools/update_reference.sh BUILD_DIR writes it")
    else:
        PAGE.write_text(text)


if __name__ == "__main__":
    main()
