"""Writes the Python module over the C interface, and its type stubs."""

import keyword
import re

from c_model import VECTORS, snake
from emit_header import HeaderWriter

HEAD = '''"""The classes and functions of Gyre. Made by capi/generate.py from the C++ headers; not to be edited."""

import ctypes

import numpy as np

from ._runtime import (BOOL, COUNT, DVEC3, F32, F64, I32, MAT3, MAT4, POINTER, QUAT, SHAPE, SIZE, SYM3, U8, U16, U32, U64, VEC3, Definition, Enum,
                       EnumKind, Handle, Id, IdKind, Optional, Rows, Several, Struct, StructKind, Text, Texts, accepted, call, define,
                       definition, done, fill, refused, room, view)

'''
KINDS = {"float": "F32", "double": "F64", "int": "I32", "int32_t": "I32", "uint32_t": "U32", "uint16_t": "U16", "uint8_t": "U8",
         "uint64_t": "U64", "size_t": "SIZE", "bool": "BOOL", "byte": "U8"}
CTYPES = {"float": "ctypes.c_float", "double": "ctypes.c_double", "int": "ctypes.c_int32", "int32_t": "ctypes.c_int32",
          "uint32_t": "ctypes.c_uint32", "uint16_t": "ctypes.c_uint16", "uint8_t": "ctypes.c_uint8", "uint64_t": "ctypes.c_uint64",
          "size_t": "COUNT", "bool": "ctypes.c_bool"}
DTYPES = {"F32": "np.float32", "F64": "np.float64", "I32": "np.int32", "U32": "np.uint32", "U16": "np.uint16", "U8": "np.uint8",
          "U64": "np.uint64", "SIZE": "np.uint64", "BOOL": "np.bool_"}
SHAPES = ("Sphere", "Box", "Capsule", "Cylinder", "Cone", "Plane")
# The functions that fill several arrays are by hand, in python/gyre/__init__.py.
BY_HAND = ("liquid_particles", "liquid_surface", "sample_velocity")


def quoted(text, indent):
    text = text.replace("\\", "\\\\").replace('"""', "'''").strip()
    if not text:
        return ""
    lines = text.split("\n")
    if text.endswith('"'):
        lines[-1] += " "
    return f'{indent}"""' + f"\n{indent}".join(line.rstrip() for line in lines) + '"""\n'


def python_name(name):
    return name + "_" if keyword.iskeyword(name) else name


class PythonWriter:
    def __init__(self, model):
        self.model = model
        self.header = HeaderWriter(model)
        self.defaults = model.with_default()
        self.classes = [name for name in self.header.handle_names()]

    # --------------------------------------------------------------------------------------------------- kinds

    def kind(self, kind):
        """The expression of a kind of _runtime."""
        m = self.model
        if kind in KINDS:
            return KINDS[kind]
        if kind in VECTORS:
            return kind.upper()
        if kind in m.ids:
            return f"IdKind({kind})"
        if kind in m.api.enums:
            return f"EnumKind({kind})"
        if kind == "AnyShape":
            return "SHAPE"
        if kind == "char*":
            return "Texts()"
        if kind == "string_view":
            return "Text()"
        if match := re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            count = self.count(match.group(2))
            return f"Texts({count})" if match.group(1) == "char" else f"Several({self.kind(match.group(1))}, {count})"
        outer, inner = m.inner(kind)
        if outer == "optional":
            return f"Optional({self.kind(inner)})"
        if outer in ("span", "vector"):
            return f"Rows({self.kind(inner)})"
        return f"StructKind({kind})"

    def count(self, text):
        return self.model.constant(text[1:]) if text.startswith("k") else int(text)

    def is_plain(self, name):
        """NumPy can show rows of it."""
        return self.model.is_mirror(name) and all(p.type != "char*" and (p.type not in self.model.structs or self.is_plain(p.type))
                                                  for p in self.model.fields(name))

    def ctype(self, kind):
        m = self.model
        if kind in CTYPES:
            return CTYPES[kind]
        if kind in VECTORS:
            return f"{kind.upper()}.ctype"
        if kind in m.ids:
            return "ctypes.c_uint64"
        if kind in m.api.enums:
            return "ctypes.c_uint8"
        return kind

    # --------------------------------------------------------------------------------------------------- module

    def write(self):
        m = self.model
        parts = [HEAD]
        names = []
        for enum in m.api.enums.values():
            parts.append(f"class {enum.name}(Enum):\n{quoted(enum.doc or enum.name, '    ')}\n"
                         + "".join(f"    {name.upper()} = {number}\n" for name, number, _ in enum.values) + "\n\n")
            names.append(enum.name)
        for name in m.ids:
            parts.append(f"class {name}(Id):\n    __slots__ = ()\n\n\n")
            names.append(name)
        for name in m.api.constants:
            parts.append(f"{snake(name).upper()} = {m.constant(name)}\n")
            names.append(snake(name).upper())
        parts.append("\n\n")
        for name in m.structs:
            parts.append(self.struct(name))
            names.append(name)
            if name == self.header.last_of_shapes():
                parts.append("SHAPE.classes = {" + ", ".join(f"int(ShapeKind.{shape.upper()}): {shape}" for shape in SHAPES) + "}\n\n\n")
        for name in self.classes:
            parts.append(self.group(name))
            names.append(name)
        parts.append("SHAPE.geometry = Geometry\n\n\n")
        for function in self.module_functions():
            parts.append(self.function(function, "") + "\n\n")
            names.append(python_name(self.script_name(function[0])))
        parts.append(f"__all__ = {sorted(set(names))!r}\n")
        return "".join(parts)

    def struct(self, name):
        m = self.model
        base = "Definition" if name in m.definitions else "Struct"
        fields = m.fields(name)
        lines = [f"class {name}({base}):\n{quoted(m.api.structs[name].doc or name, '    ')}\n\n"]
        c_name = snake(name) if name in m.definitions or name in self.defaults else ""
        lines.append(f"define({name}, {c_name!r}, {self.is_plain(name)}, {{\n")
        lines += [f"    {p.name!r}: {self.kind(p.type)},\n" for p in fields]
        lines.append("}, {\n")
        lines += [f"    {p.name!r}: {' '.join(p.doc.split())!r},\n" for p in fields if p.doc]
        return "".join(lines) + "})\n\n\n"

    def grouped(self):
        """Functions of C by the C++ function that they are of."""
        out = []
        for call in self.model.calls:
            if call.source.name == "to_string":
                continue
            if out and out[-1][0].source is call.source:
                out[-1].append(call)
            else:
                out.append([call])
        return out

    def module_functions(self):
        return [g for g in self.grouped() if not self.method_of(g[0])]

    @staticmethod
    def method_of(call):
        if call.source.name == call.source.owner or call.source.static:
            return call.source.owner
        return call.owner

    def group(self, name):
        lines = [f"class {name}(Handle):\n{quoted(self.model.api.classes[name].doc or name, '    ')}\n"
                 f"    _destroy = call('gyre_{snake(name)}_destroy', None, POINTER)\n\n"]
        for group in self.grouped():
            if self.method_of(group[0]) == name:
                lines.append(self.function(group, "    ") + "\n")
        return "".join(lines).rstrip() + "\n\n\n"

    def script_name(self, call):
        source = call.source
        if source.name == source.owner:
            return "create"
        if call.source.static:
            return source.name
        key = self.model.full_key(source)
        name = snake(self.model.renamed[key]) if key in self.model.renamed else source.name
        return name

    # ------------------------------------------------------------------------------------------------- functions

    def argument_types(self, call):
        out = ["POINTER"] if call.owner and call.source.name != call.owner else []
        for p in call.parameters:
            if p.role == "value":
                out.append(self.ctype(p.kind))
            elif p.role in ("definition", "shape", "handle", "geometry", "out"):
                out.append("POINTER")
            elif p.role in ("rows", "fill", "text"):
                out += ["POINTER" if p.role != "text" else "ctypes.c_char_p", "COUNT"]
        a = call.answer
        if a == "rows" or (a == "text" and call.kind == "string_view"):
            out.append("POINTER")
        if a in ("checked", "maybe", "definition", "shape"):
            out.append("POINTER")
        return out

    def result_type(self, call):
        a = call.answer
        if a in ("void", "definition"):
            return "None"
        if a == "error":
            return "ctypes.c_uint8"
        if a in ("checked", "maybe", "shape"):
            return "ctypes.c_bool"
        if a in ("made", "borrowed", "rows"):
            return "POINTER"
        if a == "text":
            return "ctypes.c_char_p" if call.kind == "char*" else "POINTER"
        return self.ctype(call.kind)

    def parameters(self, call):
        """(name, default or None) of what the caller gives."""
        out = []
        for p in call.parameters:
            if p.role in ("fill", "out", "table", "left"):
                continue
            default = None
            if p.default or (p.role == "definition" and not call.alternative):
                default = {"true": "True", "false": "False"}.get(p.default)
                if default is None:
                    number = re.fullmatch(r"-?[\d.]+(e-?\d+)?f?", p.default)
                    default = p.default.rstrip("f") if number else "()" if p.role == "rows" else "None"
            out.append((python_name(p.name), default, p))
        # Python wants parameters without a default first; where one follows, those before have none either.
        for i in range(len(out) - 2, -1, -1):
            if out[i][1] is not None and out[i + 1][1] is None:
                out[i] = (out[i][0], None, out[i][2])
        return out

    def keyword_definition(self, call):
        """The definition whose fields may be given as keyword arguments."""
        return next((p for p in call.parameters if p.role == "definition"), None)

    def function(self, group, indent):
        call = group[0]
        m = self.model
        name = python_name(self.script_name(call))
        own = self.method_of(call)
        made_here = call.source.static or call.source.name == call.source.owner
        given = self.parameters(call)
        words = self.keyword_definition(call)
        signature = [f"{n}={d}" if d is not None else n for n, d, _ in given]
        if words:
            first = next(i for i, (_, _, p) in enumerate(given) if p is words)
            if first == len(given) - 1 or given[first + 1][1] is not None:
                signature[first] = given[first][0] + "=None"
            signature.append("**fields")
        if own:
            signature.insert(0, "cls" if made_here else "self")
        body = indent + "    "
        lines = []
        binding = f"_{call.name}"
        for c in group:
            lines.append(f"{indent}_{c.name} = call({', '.join([repr(c.name), self.result_type(c), *self.argument_types(c)])})\n")
        if own and made_here:
            lines.append(f"{indent}@classmethod\n")
        lines.append(f"{indent}def {name}({', '.join(signature)}):\n")
        lines.append(quoted(call.source.doc, body))
        if call.source.name in BY_HAND:
            return ""
        prefix = "" if not own else "cls." if made_here else "self."
        arguments = ["self.handle"] if call.owner and not made_here else []
        if call.alternative:
            p = next(q for q in call.parameters if q.role == "definition")
            lines.append(f"{body}function = {{" + ", ".join(f"{c.alternative}: {prefix}_{c.name}" for c in group) + f"}}.get(type({p.name}))\n"
                         f"{body}if function is None:\n{body}    raise TypeError(f\"found {{type({p.name}).__name__}}, expected one of "
                         f"{', '.join(c.alternative for c in group)}\")\n{body}if fields:\n"
                         f"{body}    {p.name} = definition(type({p.name}), {p.name}, fields)\n")
            target = "function"
        else:
            target = prefix + binding
        fills = [p for p in call.parameters if p.role == "fill"]
        outs = [p for p in call.parameters if p.role == "out"]
        for p in call.parameters:
            n = python_name(p.name)
            if p.role == "value":
                arguments.append(self.value(p.kind, n))
            elif p.role == "definition":
                if not call.alternative:
                    fields = ", fields" if p is words else ""
                    lines.append(f"{body}{n} = definition({p.kind}, {n}{fields})\n")
                arguments.append(f"ctypes.byref({n})")
            elif p.role == "shape":
                lines.append(f"{body}{n}_in = SHAPE.set({n})\n")
                arguments.append(f"ctypes.byref({n}_in)")
            elif p.role in ("handle", "geometry"):
                arguments.append(f"{n}.handle")
            elif p.role == "rows":
                lines.append(f"{body}{n}_rows, {n}_at, {n}_count = {self.rows(p.kind, n)}\n")
                arguments += [f"{n}_at", f"{n}_count"]
            elif p.role == "text":
                lines.append(f"{body}{n} = {n}.encode()\n")
                arguments += [n, f"len({n})"]
            elif p.role == "out":
                lines.append(f"{body}{p.name} = {self.ctype(p.kind)}()\n")
                arguments.append(f"ctypes.byref({p.name})")
            elif p.role == "fill" and self.is_count_of_rows(call):
                arguments += ["at", "count"]
            elif p.role == "fill":
                count = self.room_of(call, p)
                lines.append(f"{body}{n} = room({self.kind(p.kind)}, {count})\n")
                arguments += [f"{n}.ctypes.data", f"len({n})"]
        lines.append(self.answer(call, target, arguments, body, fills, outs))
        return "".join(line for line in lines if line)

    @staticmethod
    def is_count_of_rows(call):
        return call.answer == "value" and call.kind == "size_t"

    @staticmethod
    def room_of(call, p):
        first = next(q for q in call.parameters if q.role == "rows")
        return f"{first.name}_count * most" if p.name == "out" and call.name.endswith("_all_batch") else f"{first.name}_count"

    def rows(self, kind, name):
        if kind == "byte":
            return f"Rows(U8).memory(np.frombuffer({name}, np.uint8))"
        return f"Rows({self.kind(kind)}).memory({name})"

    def value(self, kind, name):
        m = self.model
        if kind in m.ids:
            return f"0 if {name} is None else int({name})"
        if kind in m.api.enums:
            return f"{kind}.of({name})"
        if kind in VECTORS:
            return f"{kind.upper()}.set({name})"
        if kind in m.structs:
            return f"{kind}._of({name})"
        if kind in ("float", "double"):
            return name
        return f"bool({name})" if kind == "bool" else f"{KINDS[kind]}.set({name})"

    def answer(self, call, target, arguments, body, fills, outs):
        m = self.model
        a, kind = call.answer, call.kind
        if fills and self.is_count_of_rows(call):
            return f"{body}return fill(lambda at, count: {target}({', '.join(arguments)}), {self.kind(fills[0].kind)})\n"
        text = f"{target}({', '.join(arguments)})"
        owner = "self" if call.owner else "None"
        if a == "void":
            return f"{body}{text}\n"
        if a == "error":
            after = f"{body}return {', '.join(self.shown(p) for p in fills)}\n" if fills else ""
            return f"{body}accepted({text})\n{after}"
        if a == "made":
            return f"{body}return {kind}.from_handle(done({text}))\n"
        if a == "borrowed":
            return f"{body}return {kind}.from_handle({text}, self)\n"
        if a == "command":
            return f"{body}done({text})\n" if kind == "bool" else f"{body}return {kind}(done({text}))\n"
        if a == "value":
            value = self.out_value(kind, text)
            if outs:
                return f"{body}answer = {value}\n{body}return answer, " + ", ".join(f"{p.name}.value" for p in outs) + "\n"
            return f"{body}return {value}\n"
        if a in ("checked", "maybe"):
            lines = f"{body}result = {kind}()\n"
            text = f"{target}({', '.join([*arguments, 'ctypes.byref(result)'])})"
            return lines + (f"{body}done({text})\n{body}return result\n" if a == "checked" else f"{body}return result if {text} else None\n")
        if a == "definition":
            text = f"{target}({', '.join([*arguments, 'ctypes.byref(result)'])})"
            return f"{body}result = {kind}()\n{body}{text}\n{body}return result._owned()\n"
        if a == "shape":
            text = f"{target}({', '.join([*arguments, 'ctypes.byref(result)'])})"
            return f"{body}result = SHAPE.ctype()\n{body}return SHAPE.get(result, None) if {text} else None\n"
        if a == "whole":
            owned = any(p.type.startswith("vector<") for p in m.fields(kind)) or any(p.role == "table" for p in call.parameters)
            if owned:
                return f"{body}return {text}._owned()\n"
            return f"{body}result = {text}\n{body}result._owner = {owner if call.owner else call.parameters[0].name}\n{body}return result\n"
        if a == "text":
            if kind == "char*":
                return f"{body}return {text}.decode()\n"
            text = f"{target}({', '.join([*arguments, 'ctypes.byref(count)'])})"
            return f"{body}count = COUNT()\n{body}return ctypes.string_at({text}, count.value).decode('utf-8', 'replace')\n"
        if a == "rows":
            text = f"{target}({', '.join([*arguments, 'ctypes.byref(count)'])})"
            lines = f"{body}count = COUNT()\n{body}at = {text}\n"
            if kind == "byte":
                return lines + f"{body}return ctypes.string_at(at, count.value)\n"
            value = f"Rows({self.kind(kind)}).rows(at, count.value, {owner})"
            if call.source.result.startswith("vector") or call.source.result == "void":
                value = f"np.array({value})"
            return lines + f"{body}return {value}\n"
        raise ValueError(a)

    @staticmethod
    def shown(p):
        return f"{p.name}.view(np.recarray) if {p.name}.dtype.names else {p.name}"

    def out_value(self, kind, text):
        m = self.model
        if kind in m.ids or kind in m.api.enums:
            return f"{kind}({text})"
        if kind in VECTORS:
            return f"{kind.upper()}.get({text}, None)"
        return text
