"""Writes the TypeScript half: enums, types of all structs, how they are written and read, and the classes."""

import re

from headers import HeaderError
from model import BITS, FLAT, LEFT_OUT, NUMBERS, TAKEN_BY_HAND, camel, pascal

HEAD = """// Made by web/bindings/generate.py from the headers in include/gyre; not to be edited. Names are those of C++ in camelCase, and so
// are the comments.
import { type Answer, Handle, type Runtime } from './runtime.js';
import type { Writer, Numbers, WritableNumbers, VectorInput, QuaternionInput, Bytes } from './stream.js';
import type { World } from './world.js';

"""
# Classes to which TypeScript adds by hand: the generated one is their base.
EXTENDED = ("World", "Recorder")
VECTOR_INPUT = {"Vec3": "VectorInput", "DVec3": "VectorInput", "Quat": "QuaternionInput"}
TUPLES = {"Vec3": "Vec3", "DVec3": "Vec3", "Quat": "Quat", "Sym3": "Sym3", "Mat3": "Mat3", "Mat4": "Mat4"}


def comment(text, indent=""):
    if not text:
        return ""
    lines = re.sub(r"\*/", "* /", text).split("\n")
    if len(lines) == 1:
        return f"{indent}/** {lines[0]} */\n"
    return f"{indent}/**\n" + "".join(f"{indent} * {line}".rstrip() + "\n" for line in lines) + f"{indent} */\n"


class TypeScriptWriter:
    def __init__(self, model):
        self.model = model
        self.both = set(model.read_structs) & set(model.written_structs)

    def write(self, version):
        m = self.model
        parts = [HEAD, f"/** @internal */\nexport const bindingsVersion = {version};\n\n", self.values(), self.ids()]
        for enum in m.api.enums.values():
            parts.append(self.enum(enum))
        parts += [self.written_type(name) for name in m.written_structs]
        parts += [self.read_type(name) for name in m.read_structs]
        parts += [self.columns_type(name) for name in m.column_structs if name != "Pose"]
        for name in m.written_variants:
            parts.append(self.shape_variant(name) if "Geometry" in m.variant_parts(name) else self.kind_variant(name))
        parts += [self.writer(name) for name in m.written_structs]
        parts += [self.reader(name) for name in m.read_structs]
        parts += [self.columns_reader(name) for name in m.column_structs if name != "Pose"]
        for name, group in m.api.classes.items():
            if name not in LEFT_OUT:
                parts.append(self.group(name, group))
        parts.append(self.module())
        return "".join(parts)

    # ----------------------------------------------------------------------------------------- enums, constants

    @staticmethod
    def values():
        return "".join(f"export type {name} = [{', '.join(['number'] * count)}];\n"
                       for name, (count, _) in FLAT.items() if name != "DVec3") + "\n"

    def ids(self):
        lines = []
        for name in self.model.ids:
            lines.append(f"/** A whole number; 0 is null. It never refers to another object once its own is gone. */\n"
                         f"export type {name} = number;\n")
        for name, (_, doc) in self.model.api.constants.items():
            if name not in LEFT_OUT:
                lines.append(comment(doc) + f"export const k{name} = {self.model.constant(name)};\n")
        return "".join(lines) + "\n"

    @staticmethod
    def enum(enum):
        lines = [comment(enum.doc), f"export const {enum.name} = {{\n"]
        for name, number, doc in enum.values:
            lines.append(comment(doc, "  ") + f"  {camel(name)}: {number},\n")
        lines.append("} as const;\n")
        lines.append(f"export type {enum.name} = (typeof {enum.name})[keyof typeof {enum.name}];\n\n")
        return "".join(lines)

    # ------------------------------------------------------------------------------------------------- types

    def input_name(self, struct):
        return struct + "Input" if struct in self.both else struct

    def input_type(self, kind):
        m = self.model
        if kind in NUMBERS:
            return "number"
        if kind == "bool":
            return "boolean"
        if kind == "uint64_t":
            return "bigint | number"
        if kind in VECTOR_INPUT:
            return VECTOR_INPUT[kind]
        if kind in FLAT:
            return "Numbers"
        if kind == "Geometry" or kind in m.ids or kind in m.api.enums or kind in m.api.classes:
            return kind
        if kind in m.api.aliases:
            return kind + "Input" if kind in m.read_variants else kind
        if kind == "string_view" or kind == "char*":
            return "string"
        element = m.array_of(kind)
        if element == "byte":
            return "Bytes"
        if element is not None:
            return f"{self.input_type(element)} | readonly {self.input_type(element)}[]" if m.is_struct(element) else self.rows_type(element)
        outer, inner = m.inner(kind)
        if outer == "optional":
            return self.input_type(inner)
        if match := re.fullmatch(r"(\w+)\[(\w+)\]", kind):
            return f"readonly {self.input_type(match.group(1))}[]"
        return self.input_name(kind)

    @staticmethod
    def rows_type(element):
        return f"Numbers | readonly {VECTOR_INPUT[element]}[]" if element in VECTOR_INPUT else "Numbers"

    def output_type(self, kind, name=""):
        m = self.model
        if kind in NUMBERS:
            return "number"
        if kind == "bool":
            return "boolean"
        if kind == "uint64_t":
            return "bigint" if name in BITS else "number"
        if kind in TUPLES:
            return TUPLES[kind]
        if kind in ("char*", "string_view") or kind.startswith("char["):
            return "string"
        if kind == "Geometry" or kind in m.ids or kind in m.api.enums or kind in m.api.classes or kind in m.api.aliases:
            return kind
        element = m.array_of(kind)
        if element == "byte":
            return "Uint8Array"
        if element is not None:
            if m.is_struct(element):
                return self.columns_name(element) if m.columnable(element) else f"{element}[]"
            return m.column_type(element, name)[0].replace("text", "string[]")
        outer, inner = m.inner(kind)
        if outer == "optional":
            return f"{self.output_type(inner, name)} | undefined"
        if match := re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            return f"{self.output_type(match.group(1), name)}[]"
        return kind

    @staticmethod
    def columns_name(struct):
        return struct + "Columns"

    def written_type(self, name):
        lines = [comment(self.model.api.structs[name].doc), f"export interface {self.input_name(name)} {{\n"]
        for part in self.model.fields(name):
            lines.append(comment(part.doc, "  ") + f"  {camel(part.name)}?: {self.input_type(part.type)} | null | undefined;\n")
        return "".join(lines) + "}\n\n"

    def read_type(self, name):
        lines = [comment(self.model.api.structs[name].doc), f"export interface {name} {{\n"]
        for part in self.model.fields(name):
            if self.model.array_of(part.type) == "Pose":
                lines.append(comment(part.doc, "  ") + "  /** 3 a row, m */\n  positions: Float64Array;\n"
                             "  /** 4 a row: x y z w */\n  orientations: Float32Array;\n")
                continue
            lines.append(comment(part.doc, "  ") + f"  {camel(part.name)}: {self.output_type(part.type, part.name)};\n")
        return "".join(lines) + "}\n\n"

    def columns_type(self, name):
        lines = [comment(self.model.api.structs[name].doc + "\nAs parallel arrays: a row has one element of each, or as many as are said."),
                 f"export interface {self.columns_name(name)} {{\n  /** How many rows there are. */\n  count: number;\n"]
        for field, _, kind, doc in self.model.leaves(name):
            array, width, _ = self.model.column_type(kind, field)
            words = "; ".join(t for t in (f"{width} a row" if width > 1 else "", doc) if t)
            lines.append(comment(words, "  ") + f"  {field}: {'string[]' if array == 'text' else array};\n")
        return "".join(lines) + "}\n\n"

    def kind_variant(self, name):
        """A value of several structs, of which an enum has one value each, in the same order: `kind` tells which it is."""
        m = self.model
        parts = m.variant_parts(name)
        enum = next((e for e in m.api.enums.values()
                     if [pascal(value) for value, _, _ in e.values] == [re.sub("Def$", "", part) for part in parts]), None)
        if enum is None or name in m.read_variants:
            raise HeaderError(f"{name}: no way is known to carry this variant: an enum must have a value for each of its structs, "
                              "and it must only be written")
        kinds = [f"{enum.name}.{camel(value)}" for value, _, _ in enum.values]
        lines = [comment(f"{m.api.alias_docs[name]}\n`kind` says which."), f"export type {name} =\n"]
        lines += [f"  | ({{ kind: typeof {kind} }} & {self.input_name(part)})\n" for kind, part in zip(kinds, parts)]
        lines[-1] = lines[-1].rstrip() + ";\n"
        lines.append(f"\nfunction write{name}(w: Writer, value: {name}): void {{\n"
                     f"  const given = w.object(value, '{name}');\n  switch (given.kind) {{\n")
        for i, (kind, part) in enumerate(zip(kinds, parts)):
            lines.append(f"    case {kind}:\n      w.number({i}, 'kind');\n      return write{part}(w, given);\n")
        lines.append(f"    default:\n      throw w.wrong('{name}.kind', (given as {{ kind: unknown }}).kind, 'one of {enum.name}');\n"
                     "  }\n}\n\n")
        return "".join(lines)

    def shape_variant(self, name):
        m = self.model
        parts = m.variant_parts(name)
        simple = [part for part in parts if part != "Geometry"]
        kind = self.kind_of
        lines = [f"/** Any shape, as it is read: what kind it is, and its measures. */\nexport type {name} =\n"]
        for part in simple:
            lines.append(f"  | ({{ kind: typeof ShapeKind.{kind(part)} }} & {part})\n")
        others = " | ".join(f"typeof ShapeKind.{camel(value)}" for value, _, _ in m.api.enums["ShapeKind"].values
                            if camel(value) not in [kind(part) for part in simple])
        lines.append(f"  | {{ kind: {others}; geometry: Geometry }};\n")
        lines.append(f"/** Any shape, as it is given: made by {', '.join(kind(p) + '()' for p in simple)}, or cooked. */\n"
                     f"export type {name}Input =\n")
        for part in simple:
            lines.append(f"  | ({{ kind: typeof ShapeKind.{kind(part)} }} & {self.input_name(part)})\n")
        lines.append(f"  | {{ kind: {others}; geometry: Geometry }}\n  | Geometry;\n\n")
        for part in simple:
            lines.append(comment(m.api.structs[part].doc) + f"export function {kind(part)}(measures: {self.input_name(part)} = {{}}) {{\n"
                         f"  return {{ kind: ShapeKind.{kind(part)}, ...measures }} as const;\n}}\n")
        lines.append(f"\nfunction write{name}(w: Writer, value: {name}Input): void {{\n"
                     "  const shape = value instanceof Handle ? { kind: ShapeKind.hull, geometry: value } : w.object(value, 'shape');\n"
                     "  switch (shape.kind) {\n")
        for part in simple:
            lines.append(f"    case ShapeKind.{kind(part)}:\n      w.number({parts.index(part)}, 'kind');\n"
                         f"      return write{part}(w, shape);\n")
        for value in [v for v in others.replace("typeof ", "").split(" | ")]:
            lines.append(f"    case {value}:\n")
        lines.append(f"      w.number({parts.index('Geometry')}, 'kind');\n      return w.handle(shape.geometry, 'shape.geometry');\n"
                     "    default:\n      throw w.wrong('shape.kind', (shape as { kind: unknown }).kind, 'one of ShapeKind');\n  }\n}\n\n")
        lines.append(f"function read{name}(r: Answer): {name} {{\n  switch (r.number()) {{\n")
        for part in simple:
            lines.append(f"    case {parts.index(part)}:\n      return {{ kind: ShapeKind.{kind(part)}, ...read{part}(r) }};\n")
        lines.append("    default: {\n      const geometry = new Geometry(r.runtime, r.number());\n"
                     f"      return {{ kind: r.number(), geometry }} as {name};\n    }}\n  }}\n}}\n\n")
        return "".join(lines)

    def kind_of(self, struct):
        """The enumerator of ShapeKind that goes with a struct."""
        for value, _, _ in self.model.api.enums["ShapeKind"].values:
            if pascal(value) == struct:
                return camel(value)
        raise ValueError(f"no ShapeKind for {struct}")

    # ------------------------------------------------------------------------------------- writing and reading

    def put(self, kind, place, where):
        m = self.model
        if kind in ("float", "double"):
            return f"w.number({place}, '{where}')"
        if kind in NUMBERS:
            low, high = NUMBERS[kind]
            return f"w.integer({place}, {low}, {high}, '{where}')"
        if kind == "bool":
            return f"w.boolean({place}, '{where}')"
        if kind == "uint64_t":
            return f"w.long({place}, '{where}')"
        if kind in m.ids:
            return f"w.id({place}, '{where}')"
        if kind in m.api.enums:
            return f"w.choice({place}, {kind}, '{where}')"
        if kind in FLAT:
            return f"w.vector({place}, {FLAT[kind][0]}, '{where}')"
        if kind in m.api.classes:
            return f"w.handle({place}, '{where}')"
        if kind in ("string_view", "char*"):
            return f"w.text({place}, '{where}')"
        element = m.array_of(kind)
        if element == "byte":
            return f"w.bytes({place}, '{where}')"
        if element is not None:
            if m.is_struct(element):
                return f"w.structs({place}, write{element}, '{where}')"
            return f"w.list({place}, {FLAT.get(element, (1,))[0]}, '{where}')"
        outer, inner = m.inner(kind)
        if outer == "optional":
            return self.put(inner, place, where)
        if match := re.fullmatch(r"(\w+)\[(\d+)\]", kind):
            return f"w.fixed({place}, {match.group(2)}, (part) => {self.put(match.group(1), 'part', where)}, '{where}')"
        return f"write{kind}(w, {place})"

    def take(self, kind, name=""):
        m = self.model
        if kind in NUMBERS or kind in m.ids:
            return "r.number()"
        if kind in m.api.enums:
            return f"r.number() as {kind}"
        if kind == "bool":
            return "r.boolean()"
        if kind == "uint64_t":
            return "r.bits()" if name in BITS else "r.count()"
        if kind in FLAT:
            return f"r.vector({FLAT[kind][0]}) as {TUPLES[kind]}"
        if kind in ("char*", "string_view") or kind.startswith("char["):
            return "r.text()"
        if kind == "Geometry":
            return "new Geometry(r.runtime, r.number())"
        element = m.array_of(kind)
        if element == "byte":
            return "r.bytes()"
        if element is not None:
            if m.is_struct(element):
                return f"read{element}Columns(r)" if m.columnable(element) else f"r.list(read{element})"
            array, width, _ = m.column_type(element, name)
            return f"r.array({array}, {width})"
        outer, inner = m.inner(kind)
        if outer == "optional":
            return f"(r.boolean() ? {self.take(inner, name)} : undefined)"
        if match := re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            return f"r.fixed({self.size(match.group(2))}, () => {self.take(match.group(1), name)})"
        return f"read{kind}(r)"

    def size(self, text):
        return text if text.isdigit() else self.model.constant(text[1:])

    def writer(self, name):
        fields = self.model.fields(name)
        keys = ", ".join(f"'{camel(part.name)}'" for part in fields)
        extra = ", 'kind'" if self.model.is_in_variant(name) else ""
        lines = [f"const keysOf{name} = new Set([{keys}{extra}]);\n",
                 f"{'/** @internal */ export ' if name in TAKEN_BY_HAND else ''}function write{name}"
                 f"(w: Writer, value: {self.input_name(name)}): void {{\n",
                 f"  const bits = w.open(value, keysOf{name}, '{name}');\n"]
        for i, part in enumerate(fields):
            place = f"value.{camel(part.name)}"
            lines.append(f"  if ({place} != null) {{\n    w.mark(bits, {i});\n"
                         f"    {self.put(part.type, place, f'{name}.{camel(part.name)}')};\n  }}\n")
        return "".join(lines) + "}\n"

    def reader(self, name):
        lines = [f"function read{name}(r: Answer): {name} {{\n"]
        results = []
        for part in self.model.fields(name):
            if self.model.array_of(part.type) == "Pose":
                lines.append("  const rows = r.number();\n  const positions = r.column(Float64Array, 3, rows);\n"
                             "  const orientations = r.column(Float32Array, 4, rows);\n")
                results += ["positions", "orientations"]
                continue
            lines.append(f"  const {camel(part.name)} = {self.take(part.type, part.name)};\n")
            results.append(camel(part.name))
        return "".join(lines) + f"  return {{ {', '.join(results)} }};\n}}\n"

    def columns_reader(self, name):
        lines = [f"function read{name}Columns(r: Answer): {self.columns_name(name)} {{\n  const count = r.number();\n"]
        for field, _, kind, _ in self.model.leaves(name):
            array, width, _ = self.model.column_type(kind, field)
            if array == "text":
                lines.append(f"  const {field} = r.texts(count);\n")
            else:
                lines.append(f"  const {field} = r.column({array}, {width}, count);\n")
        names = ", ".join(["count"] + [field for field, _, _, _ in self.model.leaves(name)])
        return "".join(lines) + f"  return {{ {names} }};\n}}\n"

    # ----------------------------------------------------------------------------------------------- functions

    def group(self, name, group):
        base = name + "Base" if name in EXTENDED else name
        lines = ["\n", comment(group.doc), f"export class {base} extends Handle {{\n"]
        for function in self.model.functions:
            if self.model.self_class(function) == name:
                for parameter in function.parameters:
                    if self.model.is_out(parameter):
                        lines.append(f"  /** What the last {camel(function.name)}() told besides its result. */\n"
                                     f"  {camel(parameter.name)} = {'false' if parameter.type == 'bool' else '0'};\n")
        for function in self.model.functions:
            if self.model.self_class(function) == name:
                lines.append(self.function(function, "this.runtime", "this.pointer"))
        return "".join(lines) + "}\n"

    def module(self):
        lines = ["\n/** Everything that is no method of a class. */\nexport abstract class GyreBase {\n",
                 "  constructor(readonly runtime: Runtime) {}\n"]
        for function in self.model.functions:
            if self.model.self_class(function) == "":
                lines.append(self.function(function, "this.runtime", "0"))
        return "".join(lines) + "}\n"

    def result_type(self, function):
        m = self.model
        for parameter in function.parameters:
            if m.is_fill(function, parameter) or m.is_filled(function, parameter):
                return self.output_type(parameter.type, parameter.name)
        result = function.result
        if result in ("void", "Error"):
            return "void"
        if result.startswith("Result<"):
            return self.output_type(m.inner(result)[1], function.name)
        if self.is_command(function):
            return "void" if result == "bool" else result
        return self.output_type(result, function.name) + (" | null" if function.nullable else "")

    def is_command(self, function):
        """Changes the world: false or a null id is an error with the world's words."""
        return function.owner == "World" and not function.const and not function.static and (
            function.result == "bool" or function.result in self.model.ids)

    def function(self, function, runtime, pointer):
        m = self.model
        name = m.script_name(function)
        given = m.parameters(function)
        typed = [f"{camel(p.name)}{'?' if p.default else ''}: {self.input_type(p.type)}" for p in given]
        result = self.result_type(function)
        flat = function.result in FLAT and not function.nullable
        doc = comment(function.doc, "  ")
        lines = [doc]
        if flat:
            lines.append(f"  {name}({', '.join(typed)}): {result};\n{doc}"
                         f"  {name}<T extends WritableNumbers>({', '.join([t.replace('?:', ': undefined |') for t in typed] + ['out: T'])}): T;\n")
            typed.append("out?: WritableNumbers")
        lines.append(f"  {name}({', '.join(typed)}): {result if not flat else 'WritableNumbers'} {{\n")
        uses_reader = result != "void" or any(m.is_out(p) for p in function.parameters)
        lines.append(f"    {'const w = ' if given else ''}{runtime}.begin();\n")
        for parameter in given:
            where = f"{name}: {camel(parameter.name)}"
            place = camel(parameter.name)
            put = self.put(parameter.type, place, where)
            if parameter.default:
                lines.append(f"    if (w.given({place})) {put};\n")
            else:
                lines.append(f"    {put};\n")
        call = f"{runtime}.call('{m.export_name(function)}', {pointer})"
        lines.append(f"    const r = {call};\n" if uses_reader else f"    {call};\n")
        lines += self.answer(function, result, flat, runtime)
        return "".join(lines) + "  }\n"

    def answer(self, function, result, flat, runtime):
        m = self.model
        if result == "void" and not any(m.is_out(p) for p in function.parameters):
            return []
        # Without an owner the columns are gone at the next call of the function.
        kept = "" if m.self_class(function) else "r.copies = true;\n    "
        for parameter in function.parameters:
            if m.is_fill(function, parameter) or m.is_filled(function, parameter):
                return [f"    {kept}return {self.take(parameter.type, parameter.name)};\n"]
        if flat:
            return [f"    return r.vector({FLAT[function.result][0]}, out);\n"]
        kind = function.result
        if kind.startswith("Result<"):
            kind = m.inner(kind)[1]
        if kind == function.owner and function.name == function.owner:
            return [f"    return new {kind}({runtime}, r.number());\n"]
        if kind == "World":
            owner = ", this" if not function.static and function.owner else ""
            return [f"    return {runtime}.world(r.number(){owner});\n"]
        if kind in m.api.classes:
            return [f"    return new {kind}({runtime}, r.number());\n"]
        if function.nullable:
            return [f"    return r.boolean() ? {self.take(kind, function.name)} : null;\n"]
        outs = [p for p in function.parameters if m.is_out(p)]
        if outs:
            lines = [f"    const result = {self.take(kind, function.name)};\n"]
            lines += [f"    this.{camel(p.name)} = {self.take(p.type, p.name)};\n" for p in outs]
            return lines + ["    return result;\n"]
        return [f"    {kept}return {self.take(kind, function.name)};\n"]
