#!/usr/bin/env python3
"""Makes the C interface, and the Python module over it, from the headers in include/gyre.

    generate.py --header FILE --source FILE --symbols FILE   writes the C header, its implementation and the linker's list of symbols
    generate.py --abi-program FILE                           writes a C program that prints sizes and offsets of all structs
    generate.py --python FILE --stubs FILE                   writes the Python module and its type stubs
    generate.py --check                                      only finds out whether every public function can be bound

Files in which nothing changed are left untouched.
"""

import argparse
import sys
from pathlib import Path

from c_model import ROOT, CModel
from emit_abi import abi_program, symbols
from emit_header import HeaderWriter
from emit_python import PythonWriter
from emit_source import SourceWriter
from emit_stubs import StubWriter
from headers import HeaderError

OUTPUTS = ("header", "source", "symbols", "abi-program", "python", "stubs")


def write(path, text):
    path = Path(path)
    if path.exists() and path.read_text(encoding="utf-8") == text:
        return
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--include", default=ROOT / "include", type=Path, help="where gyre/*.h lie")
    for name in OUTPUTS:
        parser.add_argument(f"--{name}")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    try:
        model = CModel(options.include)
        texts = {"header": HeaderWriter(model).write()}
        texts["source"] = SourceWriter(model).write()
        texts["symbols"] = symbols(texts["header"])
        texts["abi-program"] = abi_program(model)
        texts["python"] = PythonWriter(model).write()
        texts["stubs"] = StubWriter(model).write()
    except HeaderError as error:
        print(f"C bindings: {error}", file=sys.stderr)
        return 1
    for name in OUTPUTS:
        path = getattr(options, name.replace("-", "_"))
        if path:
            write(path, texts[name])
    if options.check:
        print(f"C bindings: {len(model.calls)} functions, {len(model.structs)} structs, "
              f"{sum(model.is_mirror(name) for name in model.structs)} of them without conversion")
    return 0


if __name__ == "__main__":
    sys.exit(main())
