#!/usr/bin/env python3
"""Sources and docs/theory.md name each other: each "theory 4.6" and "eq. 4.3" of a comment is there, and each numbered
equation is named beside the code that computes it.

Usage: check_theory.py ROOT
"""
import pathlib, re, sys

NUMBER = r"\d+(?:\.\d+[a-z]?)?"
LIST = rf"({NUMBER}(?:[ \n/]*(?:,|to|and)[ \n/]*{NUMBER})*)"


def numbers_in(theory):
    """Sections and paragraphs, and equations, which have a tag."""
    places = set(re.findall(r"^#+ (\d+(?:\.\d+)?)", theory, re.M)) | set(re.findall(r"^\*\*(\d+\.\d+)", theory, re.M))
    return places, set(re.findall(r"\\tag\{(\d+\.\d+[a-z]?)\}", theory))


def main():
    root = pathlib.Path(sys.argv[1])
    places, equations = numbers_in((root / "docs/theory.md").read_text())
    wrong, named = [], set()
    for path in sorted((root / "src/talus").rglob("*")):
        if path.suffix not in (".h", ".cpp"):
            continue
        text = path.read_text()
        for what, known in ((r"theory(?:\.md)?(?:[ \n/]+sections?)?", places), (r"eq\.", equations)):
            for found in re.finditer(rf"\b{what}[ \n/]+{LIST}", text, re.I):
                if "of the paper" in text[found.end():found.end() + 16]:
                    continue  # that one's numbers are its own
                for number in re.findall(NUMBER, found.group(1)):
                    if number not in known:
                        line = text.count("\n", 0, found.start()) + 1
                        wrong.append(f"{path.relative_to(root)}:{line}: there is no {found.group(0)!r}: {number}")
                    elif known is equations:
                        named.add(number)
    wrong += [f"docs/theory.md: equation {n} is named by no source" for n in sorted(equations - named)]
    print("\n".join(wrong + [f"{len(places)} paragraphs, {len(equations)} equations, {len(wrong)} wrong"]))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
