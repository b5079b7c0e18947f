#!/usr/bin/env python3
"""Keeps docs/decisions in form: each page begins with its question and an abstract of five lines, and README.md lists it once.

docs/decisions/README.md says what the five lines hold.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LABELS = ("Problem", "Rule", "Constants", "Figure", "Limit")


def faults_of(text):
    lines = text.split("\n")
    if not re.match(r"# .+\?$", lines[0]):
        return ["the title is no question"]
    if len(lines) < 8 or lines[1] or lines[7]:
        return ["an abstract of five lines must follow the title"]
    return [f"line {i + 3} must begin with '- **{label}:**' and end with a full stop" for i, label in enumerate(LABELS)
            if not re.match(rf"- \*\*{label}:\*\* .+\.$", lines[i + 2])]


def main():
    folder = ROOT / "docs" / "decisions"
    listed = re.findall(r"^\| \[[^\]]+\]\(([^)]+)\) \|", (folder / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    pages = sorted(path for path in folder.glob("*.md") if path.name != "README.md")
    faults = []
    for page in pages:
        name = page.relative_to(ROOT)
        faults += [f"{name}: {fault}" for fault in faults_of(page.read_text(encoding="utf-8"))]
        if listed.count(page.name) != 1:
            faults.append(f"{name}: docs/decisions/README.md lists it {listed.count(page.name)} times, not once")
    for fault in faults:
        print(fault)
    print(f"check_docs: {len(pages)} pages, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
