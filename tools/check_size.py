#!/usr/bin/env python3
"""Keeps files and functions at a size that a person can read: prints the ten largest files, fails over 600 lines, and names
functions over 80 lines (a warning: a kernel may be longer for a reason).
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FILE_LIMIT = 600
FUNCTION_LIMIT = 80
FOLDERS = ("include", "src", "scene", "formats", "apps", "kit", "capi")
ONLY_FILES = ("tests", "bench", "examples")  # where functions may be long: a table of cases, a program's main

NOT_A_FUNCTION = re.compile(r"^\s*(namespace|struct|class|enum|union|extern|static_assert|if|for|while|switch|else|do|return)\b")


def long_functions(lines):
    """(line, length) of each function over the limit, by indentation: the code is formatted, so a definition's closing
    brace stands in the column where its first line began."""
    found = []
    start = None
    for i, line in enumerate(lines):
        body = line.strip()
        indent = len(line) - len(line.lstrip())
        if start is None:
            if not (body.endswith("{") and ")" in body):
                continue
            # A signature may take several lines; its first is where the brackets balance.
            first = i
            open_brackets = line.count(")") - line.count("(")
            while open_brackets > 0 and first > 0 and i - first < 12:
                first -= 1
                open_brackets += lines[first].count(")") - lines[first].count("(")
            indent = len(lines[first]) - len(lines[first].lstrip())
            if indent <= 2 and not NOT_A_FUNCTION.match(lines[first]):
                start = (first, indent)
        elif body.startswith("}") and indent == start[1]:
            length = i - start[0] + 1
            if length > FUNCTION_LIMIT:
                found.append((start[0] + 1, length))
            start = None
    return found


def main():
    sizes = []
    long_ones = []
    for top in FOLDERS + ONLY_FILES:
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            lines = path.read_text(encoding="utf-8", errors="replace").split("\n")
            sizes.append((len(lines) - 1, path.relative_to(ROOT)))
            if top in FOLDERS and not path.name.endswith("_test.cpp"):
                long_ones += [(length, path.relative_to(ROOT), line) for line, length in long_functions(lines)]
    sizes.sort(key=lambda entry: (-entry[0], str(entry[1])))
    print(f"The ten largest of {len(sizes)} files ({sum(size for size, _ in sizes)} lines in all):")
    for size, path in sizes[:10]:
        print(f"{size:6d}  {path}")
    for length, path, line in sorted(long_ones, key=lambda entry: -entry[0]):
        print(f"warning: {path}:{line}: a function of {length} lines (aim: {FUNCTION_LIMIT})")
    too_large = [(size, path) for size, path in sizes if size > FILE_LIMIT]
    for size, path in too_large:
        print(f"{path}: {size} lines, {FILE_LIMIT} is the limit: split it")
    print(f"check_size: {len(sizes)} files, {len(too_large)} too large, {len(long_ones)} long functions")
    return 1 if too_large else 0


if __name__ == "__main__":
    sys.exit(main())
