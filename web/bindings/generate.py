#!/usr/bin/env python3
"""Makes the bindings for the web from the headers in include/gyre.

    generate.py --cpp FILE --typescript FILE    writes the two halves (untouched where nothing changed)
    generate.py --check                         only finds out whether every public function can be bound
"""

import argparse
import sys
from pathlib import Path

from emit_cpp import CppWriter
from emit_typescript import TypeScriptWriter
from headers import HeaderError
from model import ROOT, Model


def write(path, text):
    path = Path(path)
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--include", default=ROOT / "include", type=Path, help="where gyre/*.h lie")
    parser.add_argument("--cpp")
    parser.add_argument("--typescript")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    try:
        model = Model(options.include)
        cpp, version = CppWriter(model).write()
        typescript = TypeScriptWriter(model).write(version)
    except HeaderError as error:
        print(f"web bindings: {error}", file=sys.stderr)
        return 1
    if options.cpp:
        write(options.cpp, cpp)
    if options.typescript:
        write(options.typescript, typescript)
    if options.check:
        print(f"web bindings: {len(model.functions)} functions, {len(model.written_structs)} structs written, "
              f"{len(model.read_structs)} read, {len(model.column_structs)} as columns")
    return 0


if __name__ == "__main__":
    sys.exit(main())
