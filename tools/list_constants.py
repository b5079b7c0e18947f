#!/usr/bin/env python3
"""Writes docs/tuning.md: every physical constant of the engine, with its value, unit and reason, folder by folder.

A constant stands beside the code that uses it. Its meaning is the comment on its line, or else the comment above the run of
constants that it belongs to. The page is made from both, so it cannot drift. Only constants of type float and double are listed:
whole numbers are sizes of tables and counts of lanes.

    python3 tools/list_constants.py            # writes the list anew
    python3 tools/list_constants.py --check    # fails if the page is out of date, a constant has no meaning, or two files define one twice
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("collision", "rigid", "solver", "dynamics", "soft", "fluid", "geometry", "world")
PAGE = "docs/tuning.md"
BEGIN = "<!-- constants: written by tools/list_constants.py -->"
END = "<!-- end of constants -->"

DEFINITION = re.compile(r"^\s*(?:inline |static )*constexpr (?:float|double) (k[A-Z]\w*)\s*=")
ANY_CONSTANT = re.compile(r"^\s*(?:inline |static )*constexpr [\w:]+ k[A-Z]\w*")
DECLARATOR = re.compile(r"\b(k[A-Z]\w*)\s*=\s*((?:[^,;({]|\([^()]*(?:\([^()]*\)[^()]*)*\))+)")
# Values that stand for "none" or for the ends of the number format.
SENTINEL = re.compile(r"huge_val|nan|numeric_limits|^FLT_|^DBL_")
NOT_OF_THE_ENGINE = re.compile(r"(_test|_test_kit|_oracle|_test_scenes)$")


def comment_of(line):
    """The comment of a line, with its column; None where there is none."""
    at = line.find("//")
    return (at, line[at + 2 :].strip()) if at >= 0 else None


def code_of(line):
    return line.split("//")[0].rstrip()


def meaning_of(lines, first, last):
    """The comment on the lines of a definition and on those that continue it; else the one above its run of constants."""
    texts = [comment_of(line)[1] for line in lines[first : last + 1] if comment_of(line)]
    if texts:
        following = last + 1
        while following < len(lines) and not code_of(lines[following]) and comment_of(lines[following]):
            if comment_of(lines[following])[0] < 8:
                break
            texts.append(comment_of(lines[following])[1])
            following += 1
    above = first - 1
    while above >= 0 and code_of(lines[above]) and (ANY_CONSTANT.match(lines[above]) or not code_of(lines[above]).endswith(("{", "}", ";"))):
        above -= 1
    block = []
    while above >= 0 and not code_of(lines[above]) and comment_of(lines[above]):
        block.insert(0, comment_of(lines[above])[1])
        above -= 1
    return " ".join((block if texts and len(" ".join(texts)) < 12 else []) + texts or block)


def constants_of(path):
    """(name, value, meaning) of each constant of a file, in their order."""
    lines = path.read_text(encoding="utf-8").splitlines()
    found = []
    for first, line in enumerate(lines):
        if not DEFINITION.match(line):
            continue
        last = first
        while not code_of(lines[last]).endswith(";") and last + 1 < len(lines):
            last += 1
        text = " ".join(code_of(lines[i]).strip() for i in range(first, last + 1))
        meaning = meaning_of(lines, first, last)
        for name, value in DECLARATOR.findall(text):
            if SENTINEL.search(value):
                continue
            value = re.sub(r"(?<=[\d.])f\b", "", value.strip())
            found.append((name, value, meaning))
    return found


def collect(root):
    """Folder -> list of (name, value, meaning, file)."""
    folders = {}
    for top in FOLDERS:
        for path in sorted((root / "src" / top).rglob("*")):
            if path.suffix not in (".h", ".cpp") or NOT_OF_THE_ENGINE.search(path.stem) or "testing" in path.parts:
                continue
            for name, value, meaning in constants_of(path):
                folder = path.parent.relative_to(root / "src").as_posix()
                folders.setdefault(folder, []).append((name, value, meaning, path.name))
    return folders


def faults_of(folders):
    """Constants without a meaning, and constants of one name and value in two files: the second should include the first."""
    faults = []
    homes = {}
    for folder, constants in folders.items():
        for name, value, meaning, file in constants:
            where = f"src/{folder}/{file}"
            if not meaning:
                faults.append(f"{where}: {name} has no comment that says its meaning and unit")
            other = homes.setdefault((name, value), where)
            if other != where:
                faults.append(f"{where}: {name} = {value} is defined in {other} too; include it from one place")
    return faults


def write_list(folders):
    lines = []
    for folder, constants in sorted(folders.items()):
        lines += ["", f"### {folder}", "", "| constant | value | meaning | file |", "|---|---|---|---|"]
        for name, value, meaning, file in constants:
            meaning = meaning.replace("|", "\\|").replace("<", "&lt;")
            lines.append(f"| `{name}` | `{value.replace('|', '')}` | {meaning} | {file} |")
    return "\n".join(lines) + "\n\n"


def main():
    page = ROOT / PAGE
    text = page.read_text(encoding="utf-8")
    if text.count(BEGIN) != 1 or text.count(END) != 1 or text.index(BEGIN) > text.index(END):
        print(f"{PAGE}: the two marker comments of the list of constants are missing or stand in the wrong order")
        return 1
    folders = collect(ROOT)
    faults = faults_of(folders)
    for fault in faults:
        print(fault)
    expected = "\n" + write_list(folders)
    start = text.index(BEGIN) + len(BEGIN)
    end = text.index(END)
    if "--check" in sys.argv[1:]:
        if text[start:end] != expected:
            print(f"{PAGE}: the list is not what the sources say: run python3 tools/list_constants.py")
            return 1
    else:
        page.write_text(text[:start] + expected + text[end:], encoding="utf-8")
    print(f"list_constants: {sum(len(c) for c in folders.values())} constants, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
