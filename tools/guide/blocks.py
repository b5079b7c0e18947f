#!/usr/bin/env python3
"""Blocks of code in the pages of the guide and the course.

    blocks.py cpp FILE     writes the C++ blocks of all pages as one program, which runs the main() of each page

A page's blocks of one language are one program, in the order of the page. C++ blocks lie in a namespace of the page.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.M | re.S)


def pages():
    return sorted((ROOT / "docs" / "guide").glob("*.md")) + sorted((ROOT / "docs" / "course").glob("*.md"))


def blocks_of(page, language):
    """(line, text, the paragraph before) of every block of a language."""
    text = page.read_text(encoding="utf-8")
    found = []
    for match in BLOCK.finditer(text):
        if match.group(1) == language:
            before = text[:match.start()].rstrip().rsplit("\n\n", 1)[-1]
            found.append((text.count("\n", 0, match.start()) + 2, match.group(2), before))
    return found


def cpp_program():
    includes, parts, mains = [], [], []
    for page in pages():
        blocks = blocks_of(page, "cpp")
        if not blocks:
            continue
        space = "page_" + page.stem
        parts.append(f"namespace {space} {{")
        for line, text, _ in blocks:
            kept = []
            for one in text.split("\n"):
                if one.startswith("#include"):
                    includes.append(one)
                    kept.append("")
                else:
                    kept.append(re.sub(r"^int main\(\)", "int run_page()", one))
            parts.append(f'#line {line} "{page.relative_to(ROOT)}"\n' + "\n".join(kept))
            if re.search(r"^int main\(\)", text, re.M):
                mains.append((space, page.name))
        parts.append(f"}}  // namespace {space}")
    calls = "\n".join(f'  failed += report("{name}", {space}::run_page());' for space, name in mains)
    return ("// Made by tools/guide/blocks.py from the pages of the guide.\n" + "\n".join(dict.fromkeys(includes)) + "\n#include <cstdio>\n\n" +
            "\n".join(parts) + '\n#line 1 "blocks"\nstatic int report(const char* page, int result) {\n'
            '  std::printf("%s: %s\\n", page, result == 0 ? "passed" : "FAILED");\n  return result != 0;\n}\n\nint main() {\n  int failed = 0;\n' +
            calls + "\n  return failed;\n}\n")


def main():
    if len(sys.argv) != 3 or sys.argv[1] != "cpp":
        print(__doc__, file=sys.stderr)
        return 2
    path, text = Path(sys.argv[2]), cpp_program()
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
