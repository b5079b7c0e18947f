#!/usr/bin/env python3
"""Line coverage of include/, src/, scene/ and apps/, from a build with the preset `coverage` whose tests have run:

    cmake --preset coverage && cmake --build --preset coverage && ctest --preset coverage
    tools/coverage.py [--lines] [BUILD FOLDER]

Prints a line per folder and the ten files with the most lines that no test reached; --lines prints those lines too.
"""

import argparse
import json
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDERS = ("include", "src", "scene", "apps")


def read_counts(build):
    """{file: {line: times run}} over all objects; a line counts as run when any object ran it."""
    counts = defaultdict(lambda: defaultdict(int))
    notes = sorted(build.rglob("*.gcda"))
    if not notes:
        sys.exit(f"coverage: no .gcda files under {build}; have its tests run?")
    with tempfile.TemporaryDirectory() as scratch:
        for note in notes:
            done = subprocess.run(["gcov", "--json-format", "--stdout", str(note)], cwd=scratch, capture_output=True,
                                  text=True, check=False)
            for text in done.stdout.splitlines():
                if not text.startswith("{"):
                    continue
                for entry in json.loads(text)["files"]:
                    path = (build / entry["file"]).resolve()
                    if ROOT not in path.parents:
                        continue
                    relative = path.relative_to(ROOT)
                    if relative.parts[0] not in FOLDERS or relative.name.endswith("_test.cpp"):
                        continue
                    for line in entry["lines"]:
                        counts[relative][line["line_number"]] += line["count"]
    return counts


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", nargs="?", default=str(ROOT / "build" / "coverage"))
    parser.add_argument("--lines", action="store_true", help="print the line numbers that no test reached")
    options = parser.parse_args()

    counts = read_counts(Path(options.build).resolve())
    folders = defaultdict(lambda: [0, 0])
    for path, lines in counts.items():
        folder = "/".join(path.parts[:2]) if path.parts[0] != "scene" else "scene"
        folders[folder][0] += sum(1 for count in lines.values() if count > 0)
        folders[folder][1] += len(lines)
    for folder in sorted(folders):
        hit, total = folders[folder]
        print(f"{100.0 * hit / total:6.1f} %  {hit:6d} of {total:6d}  {folder}")
    hit = sum(entry[0] for entry in folders.values())
    total = sum(entry[1] for entry in folders.values())
    print(f"{100.0 * hit / total:6.1f} %  {hit:6d} of {total:6d}  all")

    missed = [(path, [n for n, count in sorted(lines.items()) if count == 0]) for path, lines in counts.items()]
    missed.sort(key=lambda entry: (-len(entry[1]), entry[0]))
    print("\nMost lines that no test reached:")
    for path, lines in missed[:10]:
        if lines:
            print(f"{len(lines):6d}  {path}" + (": " + ", ".join(map(str, lines)) if options.lines else ""))
    return 0


if __name__ == "__main__":
    sys.exit(main())
