"""Writes the C++ half of the C interface: conversions of structs, and one exported function for each function of the header."""

import re

from c_model import VECTORS, snake
from emit_header import HeaderWriter

HEAD = """// Made by capi/generate.py from the headers in include/gyre; not to be edited.
#include "capi/convert.h"

#include <cmath>

namespace gyre {

using namespace c;
"""


class SourceWriter:
    def __init__(self, model):
        self.model = model
        self.header = HeaderWriter(model)

    def write(self):
        m = self.model
        parts = [HEAD, self.checks()]
        converted = [name for name in m.structs if not m.is_mirror(name)]
        taken = [name for name in converted if name in self.reachable(m.written_structs) or name in m.definitions]
        for name in taken:
            parts.append(f"void take(const Gyre{name}& in, {self.cpp(name)}& out);\n")
        for name in converted:
            parts.append(f"void give(const {self.cpp(name)}& in, Gyre{name}& out, Arena& arena);\n")
        parts.append("\n")
        parts += [self.take(name) for name in taken]
        parts += [self.give(name) for name in converted]
        parts.append("}  // namespace gyre\n\nusing namespace gyre;\nusing namespace gyre::c;\n\nextern \"C\" {\n\n")
        parts += [self.init(name) for name in m.structs if name in m.definitions]
        parts += [self.default(name) for name in m.with_default()]
        parts += [self.destroy(name) for name in self.header.handle_names()]
        parts += [self.function(call) for call in m.calls]
        parts.append('}  // extern "C"\n')
        return "".join(parts)

    def reachable(self, names):
        found = set()

        def add(name):
            if name in found or name not in self.model.structs:
                return
            found.add(name)
            for part in self.model.fields(name):
                add(self.model.element(self.model.element(part.type)))

        for name in names:
            add(name)
        return found

    def cpp(self, name):
        return self.model.api.structs[name].cpp or name

    def checks(self):
        m = self.model
        lines = ["\n"]
        for name in VECTORS:
            lines.append(f"static_assert(sizeof(Gyre{name}) == sizeof({name}) && alignof(Gyre{name}) == alignof({name}));\n")
        for name in m.ids:
            lines.append(f"static_assert(sizeof(Gyre{name}) == sizeof({name}) && alignof(Gyre{name}) == alignof({name}));\n")
        for enum in m.api.enums.values():
            low = "GYRE_" + snake(enum.name).upper()
            lines.append(f"static_assert(sizeof({enum.name}) == sizeof(Gyre{enum.name}));\n")
            lines += [f"static_assert(int({enum.name}::{name}) == {low}_{name.upper()});\n" for name, _, _ in enum.values]
        for name in m.structs:
            if not m.is_mirror(name):
                continue
            cpp = self.cpp(name)
            lines.append(f"static_assert(sizeof(Gyre{name}) == sizeof({cpp}) && alignof(Gyre{name}) == alignof({cpp}));\n")
            lines += [f"static_assert(offsetof(Gyre{name}, {p.name}) == offsetof({cpp}, {p.name}));\n" for p in m.fields(name)]
        return "".join(lines) + "\n"

    # ------------------------------------------------------------------------------------------------- structs

    def take(self, name):
        m = self.model
        lines = [f"void take(const Gyre{name}& in, {self.cpp(name)}& out) {{\n"]
        for part in m.fields(name):
            f, kind = part.name, part.type
            outer, inner = m.inner(kind)
            if m.is_plain(kind):
                lines.append(f"  copy(in.{f}, out.{f});\n")
            elif outer == "optional":
                fill = f"copy(in.{f}, out.{f}.emplace())" if m.is_plain(inner) else f"take(in.{f}, out.{f}.emplace())"
                lines.append(f"  if (in.has_{f}) {fill};\n")
            elif outer == "span":
                lines.append(f"  out.{f} = view<const {inner if inner in m.api.structs or inner in VECTORS else self.cpp_type(inner)}>(in.{f}, in.{f}_count);\n")
            elif outer == "vector" and m.is_plain(inner):
                cpp = self.cpp_type(inner)
                lines.append(f"  {{\n    const auto rows = view<const {cpp}>(in.{f}, in.{f}_count);\n    out.{f}.assign(rows.begin(), rows.end());\n  }}\n")
            elif outer == "vector" and inner in m.definitions:
                lines.append(f"  take_definitions(in.{f}, in.{f}_count, out.{f}, \"Gyre{inner}\");\n")
            elif outer == "vector":
                lines.append(f"  take_rows(in.{f}, in.{f}_count, out.{f});\n")
            else:
                lines.append(f"  take(in.{f}, out.{f});\n")
        return "".join(lines) + "}\n"

    @staticmethod
    def cpp_type(kind):
        return re.sub(r"\b(u?int\d+_t|size_t|byte)\b", r"std::\1", kind)

    def give(self, name):
        m = self.model
        lines = [f"void give(const {self.cpp(name)}& in, Gyre{name}& out, [[maybe_unused]] Arena& arena) {{\n"]
        if name in m.definitions:
            lines.append("  out.size = sizeof out;\n")
        for part in m.fields(name):
            f, kind = part.name, part.type
            outer, inner = m.inner(kind)
            array = re.fullmatch(r"([\w:]+)\[(\w+)\]", kind)
            if m.is_plain(kind):
                lines.append(f"  copy(in.{f}, out.{f});\n")
            elif outer == "optional":
                fill = f"copy(*in.{f}, out.{f})" if m.is_plain(inner) else f"give(*in.{f}, out.{f}, arena)"
                lines.append(f"  out.has_{f} = in.{f}.has_value();\n  if (in.{f}) {fill};\n")
                if inner in m.structs:
                    lines.append(f"  else copy({inner}{{}}, out.{f});\n" if m.is_plain(inner) else f"  else give({inner}{{}}, out.{f}, arena);\n")
            elif outer in ("span", "vector"):
                if m.is_plain(inner):
                    lines.append(f"  out.{f} = reinterpret_cast<const {m.c_type(inner)}*>(in.{f}.data());\n".replace("const const char*", "const char* const"))
                else:
                    lines.append(f"  out.{f} = give_rows<{m.c_type(inner)}>(std::span<const {inner}>(in.{f}), arena);\n")
                lines.append(f"  out.{f}_count = in.{f}.size();\n")
            elif kind == "string_view":
                lines.append(f"  out.{f} = in.{f}.data();\n  out.{f}_count = in.{f}.size();\n")
            elif array:
                lines.append(f"  for (std::size_t i = 0; i < std::size(in.{f}); ++i) give(in.{f}[i], out.{f}[i], arena);\n")
            else:
                lines.append(f"  give(in.{f}, out.{f}, arena);\n")
        return "".join(lines) + "}\n"

    def init(self, name):
        return (f"void gyre_{snake(name)}_init(Gyre{name}* out, size_t size) noexcept {{\n"
                f"  init_definition<{name}>(out, size);\n}}\n")

    def default(self, name):
        value = f"same<Gyre{name}>({self.cpp(name)}{{}})" if self.model.is_mirror(name) else f"default_of<{self.cpp(name)}, Gyre{name}>()"
        return f"Gyre{name} gyre_{snake(name)}_default(void) noexcept {{ return {value}; }}\n"

    @staticmethod
    def destroy(name):
        return f"void gyre_{snake(name)}_destroy(Gyre{name}* {snake(name)}) noexcept {{ delete {snake(name)}; }}\n"

    # ------------------------------------------------------------------------------------------------- functions

    def function(self, call):
        m = self.model
        lines = [self.header.signature(call).replace("GYRE_C_NOEXCEPT", "noexcept") + " {\n"]
        self.nothing = {"void": "return;", "definition": "return;", "error": f"return gyre_last_error_code();"}.get(call.answer, "return {};")
        handles = [snake(call.owner)] if call.owner and call.source.name != call.owner else []
        handles += [p.name for p in call.parameters if p.role in ("handle", "geometry")]
        for name in handles:
            lines.append(f"  if ({name} == nullptr || {name}->value == nullptr) {{\n    refuse_null(\"{call.name}\");\n    {self.nothing}\n  }}\n")
        arguments = []
        for p in call.parameters:
            lines.append(self.before(call, p))
            arguments.append(self.argument(p))
        if handles and call.owner and call.source.name != call.owner:
            own = f"*{snake(call.owner)}->value"
            if call.handle_first:
                arguments.insert(0, own)
            target = f"gyre::{call.source.name}" if call.handle_first else f"({own}).{call.source.name}"
        elif call.source.static:
            target = f"{call.source.owner}::{call.source.name}"
        elif call.source.owner:
            target = call.source.owner
        else:
            target = f"gyre::{call.source.name}"
        arguments = [a for a in arguments if a]
        lines.append(self.answer(call, f"{target}({', '.join(arguments)})"))
        return "".join(lines) + "}\n\n"

    def before(self, call, p):
        m = self.model
        if p.role == "definition":
            start = f" = {p.default}" if p.default and p.default != "{}" else "{}"
            return (f"  {p.kind} {p.name}_in{start};\n  if (!take_definition({p.name}, {p.name}_in, \"Gyre{p.kind}\")) {self.nothing}\n")
        if p.role == "shape":
            return f"  AnyShape {p.name}_in;\n  if ({p.name} != nullptr) take(*{p.name}, {p.name}_in);\n"
        if p.role == "rows" and p.kind in m.definitions:
            return (f"  std::vector<{p.kind}> {p.name}_in;\n"
                    f"  if (!take_definitions({p.name}, {p.name}_count, {p.name}_in, \"Gyre{p.kind}\")) {self.nothing}\n")
        if p.role == "rows" and not m.is_plain(p.kind) and p.kind != "byte":
            return f"  std::vector<{p.kind}> {p.name}_in;\n  take_rows({p.name}, {p.name}_count, {p.name}_in);\n"
        return ""

    def argument(self, p):
        m = self.model
        if p.role in ("definition", "shape"):
            return p.name + "_in"
        if p.role in ("rows", "fill"):
            if p.role == "rows" and p.kind != "byte" and not m.is_plain(p.kind):
                return p.name + "_in"
            const = "const " if p.role == "rows" else ""
            return f"view<{const}{self.cpp_type(p.kind)}>({p.name}, {p.name}_count)"
        if p.role == "text":
            return f"std::string_view({p.name}, {p.name} != nullptr ? {p.name}_count : 0)"
        if p.role == "geometry":
            return f"*{p.name}->value"
        if p.role == "handle":
            return f"*{p.name}->value"
        if p.role == "value" and (p.kind in m.ids or p.kind in VECTORS or p.kind in m.api.enums or p.kind in m.structs):
            return f"same<{p.kind}>({p.name})"
        if p.role == "table":
            return "kept.value"
        if p.role == "left":
            return ""
        return p.name

    def answer(self, call, text):
        m = self.model
        kind = m.c_type(call.kind) if call.kind and call.kind != "string_view" else ""
        a = call.answer
        table = any(p.role == "table" for p in call.parameters)
        if a == "void":
            return f"  {text};\n"
        if a == "error":
            return f"  return checked({text});\n"
        if a == "made":
            if call.source.name == call.source.owner:
                return f"  return new Gyre{call.kind}({text});\n"
            if any(p.role == "rows" and p.kind == "byte" for p in call.parameters) and "vector<byte>" in [q.type for q in call.source.parameters]:
                text = re.sub(r"view<const std::byte>\((\w+), (\w+)\)", r"std::vector<std::byte>(view<const std::byte>(\1, \2).begin(), view<const std::byte>(\1, \2).end())", text)
            return f"  return made<Gyre{call.kind}>({text});\n"
        if a == "borrowed":
            return f"  return borrowed(*{snake(call.owner)});\n"
        if a == "command":
            return f"  return command<{kind}>(*{snake(call.owner)}->value, {text});\n"
        if a == "value":
            return f"  return same<{kind}>({text});\n"
        if a == "checked":
            return (f"  const auto answer = {text};\n  if (!answer) {{\n    refuse(answer.error());\n    return false;\n  }}\n"
                    f"  if (result != nullptr) copy(*answer, *result);\n  return true;\n")
        if a == "maybe":
            found = "answer.has_value()" if not call.source.nullable else "answer != nullptr"
            return f"  const auto answer = {text};\n  if ({found} && result != nullptr) copy(*answer, *result);\n  return {found};\n"
        if a == "shape":
            return ("  const AnyShape* const answer = " + text + ";\n  Arena arena;\n"
                    "  if (answer != nullptr && result != nullptr) give(*answer, *result, arena);\n  return answer != nullptr;\n")
        if a == "text" and call.kind == "char*":
            return f"  return {text};\n"
        if a == "text":
            return f"  const std::string_view answer = {text};\n  set_count(count, answer.size());\n  return answer.data();\n"
        cpp = self.cpp(call.kind) if call.kind in m.structs else self.cpp_type(call.kind)
        if a == "definition":
            return (f"  static thread_local Kept<{cpp}, {kind}> kept;\n  kept.value = {text};\n  kept.arena.clear();\n"
                    "  give_definition(kept.value, result, kept.arena);\n")
        if a == "whole":
            fill = f"{text};" if table else f"kept.value = {text};"
            return (f"  static thread_local Kept<{cpp}, {kind}> kept;\n  {fill}\n  kept.arena.clear();\n"
                    "  give(kept.value, kept.out, kept.arena);\n  return kept.out;\n")
        if a == "rows":
            if table:
                return (f"  static thread_local Kept<std::vector<{cpp}>, int> kept;\n  kept.value.clear();\n  {text};\n"
                        f"  set_count(count, kept.value.size());\n  return reinterpret_cast<const {kind}*>(kept.value.data());\n")
            holder = "std::vector" if call.source.result.startswith("vector") else "std::span"
            const = "" if holder == "std::vector" else "const "
            keep = "static thread_local " if holder == "std::vector" or not self.plain_rows(call.kind) else ""
            lines = f"  {keep}Kept<{holder}<{const}{cpp}>, int> kept;\n  kept.value = {text};\n  set_count(count, kept.value.size());\n"
            if self.plain_rows(call.kind):
                return lines + f"  return reinterpret_cast<const {kind}*>(kept.value.data());\n"
            return lines + f"  kept.arena.clear();\n  return give_rows<{kind}>(std::span<const {cpp}>(kept.value), kept.arena);\n"
        raise ValueError(a)

    def plain_rows(self, kind):
        return kind == "byte" or self.model.is_plain(kind)
