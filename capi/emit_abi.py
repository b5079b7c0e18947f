"""Writes what the test of the binary interface needs: the list of exported symbols, and a C program that prints every layout."""

import re


def function_names(header):
    return sorted(set(re.findall(r"^GYRE_C_API [^;(]*?\b(gyre_\w+)\(", header, re.MULTILINE)))


def symbols(header):
    """The version script of the linker: C's functions, and nothing else."""
    return "{\n  global:\n" + "".join(f"    {name};\n" for name in function_names(header)) + "  local: *;\n};\n"


def abi_program(model):
    lines = ["/* Made by capi/generate.py; not to be edited. Prints the size of each struct and the offset of each member. */\n"
             "#include <gyre/c/gyre.h>\n\n#include <stdio.h>\n\nint main(void) {\n"]
    names = [*model.ids, *model.structs, "AnyShape", "Channel"]
    for name in names:
        lines.append(f'  printf("Gyre{name} %zu\\n", sizeof(Gyre{name}));\n')
        if name in model.structs:
            for _, member, _ in model.c_fields(name):
                member = member.split("[")[0]
                lines.append(f'  printf("  {member} %zu\\n", offsetof(Gyre{name}, {member}));\n')
    lines.append('  printf("GyreAnyShape.as %zu\\n", offsetof(GyreAnyShape, as));\n  return 0;\n}\n')
    return "".join(lines)
