"""Writes the C++ half: one exported function for each function of the engine, and how each struct is read and written."""

import re
import zlib


HEAD = """// Made by web/bindings/generate.py from the headers in include/gyre; not to be edited.
//
// One exported function for each function of the engine. Arguments come from the call buffer, results go to the
// answer buffer, both rows of doubles (see stream.h); the TypeScript half is made from the same list.
#include "web/bindings/hosts.h"

HEADERS

#include <emscripten.h>

#include <variant>

"""


class CppWriter:
    def __init__(self, model):
        self.model = model

    def write(self):
        """The text, and the number of this version of it."""
        m = self.model
        parts = [HEAD.replace("HEADERS", "\n".join(f"#include <gyre/{name}.h>" for name in m.files))]
        parts.append("namespace gyre::web {\n")
        parts.append(self.checks())
        for name in m.written_variants:
            parts.append(f"void get(Call& call, {name}& out);\n")
        for name in m.read_variants:
            parts.append(f"void put(Answer& answer, const {name}& value);\n")
        for name in m.written_structs:
            parts.append(f"void get(Call& call, {self.qualified(name)}& out);\n")
        for name in m.column_structs:
            parts.append(f"void put_rows(Answer& answer, std::span<const {self.qualified(name)}> rows);\n")
        for name in m.read_structs:
            parts.append(f"void put(Answer& answer, const {self.qualified(name)}& value);\n")
        parts.append("\n")
        parts += [self.getter(name) for name in m.written_structs]
        parts += [self.rows(name) for name in m.column_structs]
        parts += [self.putter(name) for name in m.read_structs]
        parts += [self.variant_getter(name) for name in m.written_variants]
        parts += [self.variant_putter(name) for name in m.read_variants]
        parts.append("}  // namespace gyre::web\n\n")
        parts.append('using namespace gyre;\nusing namespace gyre::web;\n\nextern "C" {\n\n')
        for index, function in enumerate(m.functions):
            parts.append(self.function(function, index))
        version = self.version("".join(parts))
        parts.append(f"// Equal to the number in the TypeScript half, or the two do not belong together.\n"
                     f"EMSCRIPTEN_KEEPALIVE int gyre_bindings_version() {{ return {version}; }}\n\n")
        parts.append('}  // extern "C"\n')
        return "".join(parts), version

    @staticmethod
    def version(text):
        return zlib.crc32(text.encode()) >> 1

    def variant_getter(self, name):
        kinds = self.model.variant_parts(name)
        lines = [f"void get(Call& call, {name}& out) {{\n  switch (int(call.next())) {{\n"]
        for i, kind in enumerate(kinds):
            lines.append(f"    {f'case {i}' if i + 1 < len(kinds) else 'default'}:\n      get(call, out.emplace<{kind}>());\n"
                         "      break;\n")
        return "".join(lines) + "  }\n}\n\n"

    @staticmethod
    def variant_putter(name):
        return (f"void put(Answer& answer, const {name}& value) {{\n  answer.number(double(value.index()));\n"
                "  std::visit([&](const auto& part) { put(answer, part); }, value);\n}\n\n")

    def qualified(self, name):
        return self.model.api.structs[name].cpp

    def checks(self):
        lines = ["// The numbers that the TypeScript half was given.\n"]
        for enum in self.model.api.enums.values():
            for name, number, _ in enum.values:
                lines.append(f"static_assert(int({enum.name}::{name}) == {number});\n")
        for name in self.model.api.constants:
            if name not in ("Pi", "PiDouble"):
                lines.append(f"static_assert(double(k{name}) == {self.model.constant(name)});\n")
        return "".join(lines) + "\n"

    # ------------------------------------------------------------------------------------------------- structs

    def getter(self, name):
        lines = [f"void get(Call& call, {self.qualified(name)}& out) {{\n", "  const Given given(call);\n"]
        for i, part in enumerate(self.model.fields(name)):
            lines.append(f"  if (given[{i}]) {self.get(part.type, f'out.{part.name}', part.name)};\n")
        return "".join(lines) + "}\n\n"

    @staticmethod
    def get(kind, place, name):
        del name
        if kind == "uint64_t":
            return f"get_long(call, {place})"
        if kind.startswith("optional<"):
            return f"get_optional(call, {place})"
        return f"get(call, {place})"

    def put(self, kind, place, name):
        if kind == "uint64_t":
            return f"put_long(answer, {place})"
        element = self.model.array_of(kind)
        if element is not None:
            return self.put_array(element, place, name)
        if match := re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            if match.group(1) == "char":
                return f"put_text(answer, {place})"
            return f"for (const auto& part : {place}) put(answer, part)"
        if kind in ("char*", "string_view"):
            return f"put_text(answer, {place})"
        return f"put(answer, {place})"

    def put_array(self, element, place, name):
        m = self.model
        if element == "byte":
            return f"put_bytes(answer, {place})"
        if m.is_struct(element):
            if m.columnable(element):
                return f"put_rows(answer, std::span<const {element}>({place}))"
            return f"put_list(answer, std::span<const {element}>({place}), [&](const {element}& part) {{ put(answer, part); }})"
        return f"put_array(answer, std::span({place}))"

    def rows(self, name):
        lines = [f"void put_rows(Answer& answer, std::span<const {name}> rows) {{\n", "  answer.number(double(rows.size()));\n"]
        for _, path, kind, _ in self.model.leaves(name):
            if kind in ("char*", "string_view") or kind.startswith("char["):
                lines.append(f"  for (const {name}& row : rows) put_text(answer, row.{path});\n")
            else:
                lines.append(f"  put_column(answer, rows, [](const {name}& row) -> const auto& {{ return row.{path}; }});\n")
        return "".join(lines) + "}\n\n"

    def putter(self, name):
        lines = [f"void put(Answer& answer, const {self.qualified(name)}& value) {{\n"]
        for part in self.model.fields(name):
            lines.append(f"  {self.put(part.type, f'value.{part.name}', part.name)};\n")
        return "".join(lines) + "}\n\n"

    # ----------------------------------------------------------------------------------------------- functions

    def function(self, function, index):
        m = self.model
        owner = m.self_class(function)
        lines = [f"EMSCRIPTEN_KEEPALIVE int {m.export_name(function)}(Host* host) {{\n", "  Call call(host);\n", f"  Answer answer(host, {index + 1});\n"]
        if owner:
            lines.append(f"  {owner}& self = object<{owner}>(host);\n")
        given = m.parameters(function)
        arguments, filled, outs = [], [], []
        for position, parameter in enumerate(function.parameters):
            if parameter in given:
                lines += self.take(parameter)
                arguments.append(self.passed(parameter))
            elif position == 0 and owner and not function.owner:
                arguments.append("self")
            elif m.is_out(parameter):
                lines.append(f"  {parameter.type} {parameter.name}{{}};\n")
                outs.append(parameter)
                arguments.append(f"&{parameter.name}")
            elif m.is_filled(function, parameter):
                # A table keeps its memory from call to call.
                kind = self.cpp_type(parameter.type)
                lines.append(f"  {kind}& {parameter.name} = answer.kept<{kind}>();\n")
                if m.array_of(parameter.type) is not None:
                    lines.append(f"  {parameter.name}.clear();\n")
                filled.append(parameter)
                arguments.append(parameter.name)
            elif m.is_fill(function, parameter):
                return "".join(lines) + self.fill(function, parameter, arguments, owner)
        lines.append(self.call_and_answer(function, owner, arguments, filled, outs))
        return "".join(lines) + "}\n\n"

    @staticmethod
    def cpp_type(kind):
        return re.sub(r"\b(vector|span|optional|string_view)\b", r"std::\1", re.sub(r"span<(?!const)", "span<const ", kind)).replace(
            "<byte>", "<std::byte>").replace("const byte", "const std::byte")

    def take(self, parameter):
        kind, name = parameter.type, parameter.name
        if kind in self.model.api.classes and kind != "Geometry":
            return [f"  {kind}& {name} = call.object<{kind}>();\n"]
        cpp = re.sub(r"\b(u?int\d+_t|size_t)\b", r"std::\1", self.cpp_type(kind))
        start = f"  {cpp} {name} = {parameter.default};\n" if parameter.default else f"  {cpp} {name}{{}};\n"
        get = self.get(kind, name, name)
        if kind == "WorldDef":
            return [*([start, f"  if (call.given()) {get};\n"] if parameter.default else [start, f"  {get};\n"]),
                    f"  limit_threads({name});\n"]
        return [start, f"  if (call.given()) {get};\n" if parameter.default else f"  {get};\n"]

    @staticmethod
    def passed(parameter):
        return f"std::move({parameter.name})" if parameter.type == "vector<byte>" else parameter.name

    def fill(self, function, parameter, arguments, owner):
        element = self.model.array_of(parameter.type)
        target = "self." if owner and function.owner else ""
        before = "".join(f"{a}, " for a in arguments)
        return (f"  std::vector<{element}>& rows = answer.kept<std::vector<{element}>>();\n"
                f"  rows.resize({target}{function.name}({before}{{}}));\n"
                f"  {target}{function.name}({before}rows);\n"
                f"  {self.put_array(element, 'rows', parameter.name)};\n"
                "  return answer.done();\n}\n\n")

    def call_and_answer(self, function, owner, arguments, filled, outs):
        m = self.model
        if function.name == function.owner:
            return f"  return answer.made<{function.owner}>({function.owner}({', '.join(arguments)}));\n"
        if function.static:
            target = f"{function.owner}::"
        elif function.owner:
            target = "self."
        else:
            target = "gyre::"
        call = f"{target}{function.name}({', '.join(arguments)})"
        after = "".join(f"  {self.put(p.type, p.name, p.name)};\n" for p in [*outs, *filled])
        result = function.result
        if result == "void":
            return f"  {call};\n{after}  return answer.done();\n"
        if result == "Error":
            return f"  return answer.checked({call});\n"
        if result.startswith("Result<"):
            inner = m.inner(result)[1]
            if inner in m.api.classes:
                return f"  return answer.made_or_refused<{inner}>({call});\n"
            value, start = ("value", f"  const {inner}& value = answer.keep(*std::move(result));\n") if m.is_struct(inner) else ("*result", "")
            return f"  auto result = {call};\n  if (!result) return answer.checked(result.error());\n{start}" \
                   f"  {self.put(inner, value, '')};\n  return answer.done();\n"
        if owner == "World" and function.owner and not function.const and (result == "bool" or result in m.ids):
            return f"  return answer.command(self, {call});\n"
        if result in m.api.classes and result != "Geometry":
            return f"  answer.borrowed({call});\n  return answer.done();\n"
        if function.nullable:
            return f"  const auto* result = {call};\n  answer.number(result != nullptr);\n" \
                   f"  if (result != nullptr) {self.put(result, '*result', '')};\n  return answer.done();\n"
        if m.array_of(result) == "byte":
            return f"  answer.bytes({call});\n  return answer.done();\n"
        # Texts and arrays of a struct are read after the call.
        kept = f"answer.keep({call})" if m.is_struct(result) else call
        return f"  const auto& result = {kept};\n  {self.put(result, 'result', function.name)};\n{after}  return answer.done();\n"
