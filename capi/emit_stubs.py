"""Writes the type stubs of the Python module: python/gyre/__init__.pyi, for editors and type checkers."""

import re

from c_model import ROOT, VECTORS, snake
from emit_python import BY_HAND, DTYPES, KINDS, PythonWriter, python_name, quoted

HEAD = '''# Made by capi/generate.py from the C++ headers; not to be edited. The end is python/gyre/by_hand.pyi.
import enum
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

class Id(int): ...

'''


class StubWriter(PythonWriter):
    def write(self):
        m = self.model
        parts = [HEAD]
        for enum in m.api.enums.values():
            parts.append(f"class {enum.name}(enum.IntEnum):\n{quoted(enum.doc, '    ')}"
                         + "".join(f"    {name.upper()} = {number}{'  # ' + ' '.join(doc.split()) if doc else ''}\n" for name, number, doc in enum.values)
                         + "    @classmethod\n    def of(cls, value: Any) -> " + enum.name + ": ...\n\n")
        parts += [f"class {name}(Id): ...\n" for name in m.ids]
        parts += [f"{snake(name).upper()}: {'float' if isinstance(m.constant(name), float) else 'int'}\n" for name in m.api.constants]
        shapes = " | ".join([p for p in m.variant_parts("AnyShape")])
        joints = " | ".join(m.variant_parts("JointDef"))
        parts.append(f"\nAnyShape = {shapes}\nJointDef = {joints}\n\n")
        parts += [self.struct_stub(name) for name in m.structs]
        by_hand = (ROOT / "python" / "gyre" / "by_hand.pyi").read_text(encoding="utf-8")
        for name in self.classes:
            own = re.search(rf"^# class {name}\n(.*?)(?=^# )", by_hand, re.MULTILINE | re.DOTALL)
            parts.append(f"class {name}:\n{quoted(m.api.classes[name].doc, '    ')}{own.group(1) if own else ''}"
                         + "".join(self.function_stub(group, "    ", name) for group in self.grouped() if self.method_of(group[0]) == name)
                         + "\n")
        parts += [self.function_stub(group, "", "") for group in self.module_functions()]
        parts.append("\n" + by_hand[by_hand.index("# module\n"):])
        return "".join(parts)

    # ------------------------------------------------------------------------------------------------------- types

    @staticmethod
    def number(kind):
        """Python's type of a number; None for other kinds."""
        if kind in ("float", "double"):
            return "float"
        if kind == "bool":
            return "bool"
        return "int" if kind in KINDS else None

    def given(self, kind):
        m = self.model
        if number := self.number(kind):
            return number
        if kind in VECTORS:
            return "ArrayLike"
        if kind in m.ids:
            return f"{kind} | int | None"
        if kind in m.api.enums:
            return f"{kind} | str"
        if kind == "AnyShape":
            return "AnyShape"
        if kind in ("char*", "string_view"):
            return "str"
        if re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            return "Sequence[Any]"
        outer, inner = m.inner(kind)
        if outer == "optional":
            return f"{self.given(inner)} | None"
        if outer in ("span", "vector"):
            return "ArrayLike | Sequence[Any]" if inner in m.structs else "ArrayLike"
        return f"{kind} | ArrayLike | dict[str, Any]"

    def taken(self, kind):
        m = self.model
        if number := self.number(kind):
            return number
        if kind in VECTORS:
            return f"NDArray[np.float{64 if kind == 'DVec3' else 32}]"
        if kind in ("char*", "string_view") or kind.startswith("char["):
            return "str"
        if match := re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            return f"list[{self.taken(match.group(1))}]"
        outer, inner = m.inner(kind)
        if outer == "optional":
            return f"{self.taken(inner)} | None"
        if outer in ("span", "vector"):
            return self.rows_stub(inner)
        return kind

    def rows_stub(self, inner):
        m = self.model
        if inner in KINDS:
            return f"NDArray[{DTYPES[KINDS[inner]]}]"
        if inner in VECTORS:
            return f"NDArray[np.float{64 if inner == 'DVec3' else 32}]"
        if inner in m.ids:
            return "NDArray[np.uint64]"
        if inner in m.api.enums:
            return "NDArray[np.uint8]"
        return "np.recarray[Any, Any]" if inner in m.structs and self.is_plain(inner) else f"list[{self.taken(inner)}]"

    def struct_stub(self, name):
        m = self.model
        fields = m.fields(name)
        lines = [f"class {name}:\n{quoted(m.api.structs[name].doc, '    ')}"]
        star = "*, " if name in m.definitions else ""
        arguments = ", ".join(f"{p.name}: {self.given(p.type)} = ..." for p in fields)
        lines.append(f"    def __init__(self, {star}{arguments}) -> None: ...\n")
        for p in fields:
            lines.append(f"    {p.name}: {self.taken(p.type)}{'  # ' + ' '.join(p.doc.split()) if p.doc else ''}\n")
        if name in ("BodyColumns", "SoftVertices"):
            first, second = ("positions", "orientations") if name == "BodyColumns" else ("positions", "velocities")
            lines.append(f"    {first}: NDArray[np.float64]\n    {second}: NDArray[np.float32]\n")
        return "".join(lines) + "\n"

    # --------------------------------------------------------------------------------------------------- functions

    def function_stub(self, group, indent, owner):
        call = group[0]
        if call.source.name in BY_HAND:
            return ""
        made_here = call.source.static or call.source.name == call.source.owner
        parameters = ["cls" if made_here else "self"] if owner else []
        words = self.keyword_definition(call)
        given = self.parameters(call)
        for i, (name, default, p) in enumerate(given):
            if p is words and (i == len(given) - 1 or given[i + 1][1] is not None):
                default = "None"
            kind = "JointDef" if call.alternative and p.role == "definition" else p.kind
            kind = {"rows": "bytes" if p.kind == "byte" else self.given(f"span<{p.kind}>"), "text": "str", "shape": "AnyShape",
                    "handle": p.kind, "geometry": "Geometry"}.get(p.role) or (kind if kind == "JointDef" else self.given(kind))
            if p.role == "rows" and p.kind in self.model.definitions:
                kind += " | AnyShape" if p.kind == "ShapeDef" else ""
            none = " | None" if default == "None" and "None" not in kind else ""
            parameters.append(f"{name}: {kind}{none}" + (f" = {default}" if default is not None else ""))
        if words:
            parameters.append("**fields: Any")
        decorator = f"{indent}@classmethod\n" if owner and made_here else ""
        doc = quoted(call.source.doc, indent + "    ")
        end = f":\n{doc}{indent}    ...\n" if doc else ": ...\n"
        return f"{decorator}{indent}def {python_name(self.script_name(call))}({', '.join(parameters)}) -> {self.result_stub(call)}{end}"

    def result_stub(self, call):
        fills = [p for p in call.parameters if p.role == "fill"]
        a, kind = call.answer, call.kind
        if fills and self.is_count_of_rows(call):
            return self.rows_stub(fills[0].kind)
        if a in ("void",) or (a == "error" and not fills) or (a == "command" and kind == "bool"):
            return "None"
        if a == "error":
            rows = [self.rows_stub(p.kind) for p in fills]
            return rows[0] if len(rows) == 1 else f"tuple[{', '.join(rows)}]"
        if a == "maybe":
            return f"{kind} | None"
        if a == "shape":
            return "AnyShape | None"
        if a == "rows":
            return "bytes" if kind == "byte" else self.rows_stub(kind)
        if a == "value" and any(p.role == "out" for p in call.parameters):
            return "tuple[bool, bool]"
        return "str" if a == "text" else self.taken(kind)
