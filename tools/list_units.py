#!/usr/bin/env python3
"""Writes the list of units in docs/architecture.md from the heads of the files.

A unit is a header, or a source without one, in src, kit, scene or formats; its tests and the files of single processors belong to it.
Its line in the list is the first sentence of the comment at its head. The list stands between two marker comments.

    python3 tools/list_units.py            # writes the list anew
    python3 tools/list_units.py --check    # fails if the list is not what the heads say, or if a unit has no head
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("src", "kit", "scene", "formats")
PAGE = "docs/architecture.md"
BEGIN = "<!-- units: written by tools/list_units.py -->"
END = "<!-- end of units -->"

# Files that belong to a unit of another name: tests and what they share, and kernels of one processor.
PART_OF_ANOTHER = re.compile(r"(_test|_test_.*|_kernels_(w1|sse2|avx2|avx512|avx512vl|neon|wasm))$")

# The end of a sentence: a full stop before a space, but not after an initial ("C. Ericson") or a short form ("e.g.").
SENTENCE_END = re.compile(r"(?<![ (][A-Z])(?<!\be\.g)(?<!\bi\.e)(?<!\bet al)(?<!\bvol)(?<!\bpp)(?<!\bComm)(?<!\bProc)[.](?=\s|$)")


def head_of(path):
    """The first paragraph of the comment at the head of a file; empty where there is none."""
    lines = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if line.startswith("//"):
            text = line[2:].strip()
            if not text and lines:
                break
            lines.append(text)
        elif lines or (line.strip() and not line.startswith("#pragma once")):
            break
    return " ".join(text for text in lines if text)


def first_sentence(text):
    found = SENTENCE_END.search(text)
    return text[: found.end()] if found else text


def find_units(root):
    """Folder -> {unit: file whose head speaks for it}, both in order of their names."""
    units = {}
    for top in FOLDERS:
        for path in sorted((root / top).rglob("*")):
            if path.suffix not in (".h", ".cpp") or PART_OF_ANOTHER.search(path.stem):
                continue
            folder = path.parent.relative_to(root).as_posix()
            here = units.setdefault(folder, {})
            if path.suffix == ".h" or path.stem not in here:
                here[path.stem] = path
    return {folder: dict(sorted(units[folder].items())) for folder in sorted(units)}


def write_list(root):
    """The list as text, and the files that have no head."""
    lines = []
    without = []
    for folder, units in find_units(root).items():
        lines += ["", f"**{folder}**", ""]
        for unit, path in units.items():
            sentence = first_sentence(head_of(path))
            if not sentence:
                without.append(path.relative_to(root).as_posix())
            lines.append(f"- `{unit}`: {sentence}")
    return "\n".join(lines) + "\n\n", without


def main():
    page = ROOT / PAGE
    text = page.read_text(encoding="utf-8")
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(BEGIN) > text.index(END):
        print(f"{PAGE}: the two marker comments of the list of units are missing or stand in the wrong order")
        return 1
    units, without = write_list(ROOT)
    for path in without:
        print(f"{path}: no comment at its head; the list of units in {PAGE} needs its first sentence")
    start = text.index(BEGIN) + len(BEGIN)
    end = text.index(END)
    expected = "\n" + units
    if "--check" in sys.argv[1:]:
        if text[start:end] != expected:
            old = set(text[start:end].split("\n"))
            new = set(expected.split("\n"))
            for line in sorted(new - old):
                print(f"{PAGE}: missing: {line}")
            for line in sorted(old - new):
                print(f"{PAGE}: out of date: {line}")
            print(f"{PAGE}: the list of units is not what the heads of the files say: run python3 tools/list_units.py")
            return 1
    else:
        page.write_text(text[:start] + expected + text[end:], encoding="utf-8")
    print(f"list_units: {expected.count(chr(10) + '- ')} units, {len(without)} without a head")
    return 1 if without else 0


if __name__ == "__main__":
    sys.exit(main())
