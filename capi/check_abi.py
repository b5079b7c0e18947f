#!/usr/bin/env python3
"""Compares the binary interface of libgyre.so with capi/abi.txt: sizes and offsets of all structs, and the exported symbols.

    check_abi.py --layout PROGRAM --library FILE

A difference means that programs compiled with an earlier header may not run with this library. update_abi.sh writes the file anew, on
purpose: a change of a definition (a struct with `size`) at its end, and a new function, keep old programs running; any other change needs
a new minor version in CMakeLists.txt, which is in the name of the library (libgyre.so.0.1).
"""

import argparse
import difflib
import subprocess
import sys
from pathlib import Path

WRITTEN = Path(__file__).with_name("abi.txt")


def exported(library):
    text = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    return sorted(line.split()[-1].split("@")[0] for line in text.splitlines() if line)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--layout", required=True)
    parser.add_argument("--library", required=True)
    options = parser.parse_args()
    layout = subprocess.run([options.layout], check=True, capture_output=True, text=True).stdout
    found = layout + "".join(f"{name}\n" for name in exported(options.library))
    written = WRITTEN.read_text(encoding="utf-8") if WRITTEN.exists() else ""
    if written == found:
        print(f"check_abi: {len(found.splitlines())} lines as in abi.txt")
        return 0
    sys.stdout.writelines(difflib.unified_diff(written.splitlines(True), found.splitlines(True), "capi/abi.txt", "this build", n=1))
    print("check_abi: the binary interface is another one. Where that is meant: capi/update_abi.sh")
    return 1


if __name__ == "__main__":
    sys.exit(main())
