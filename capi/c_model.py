"""What of the C++ interface goes to C and to Python, how each type looks in C, and which C functions there are.

The headers are read by web/bindings, which makes the JavaScript package of the same list. Three kinds of structs come out:

- a mirror has the bytes of the C++ struct, so arrays of it need no copy;
- a definition is handed over by pointer and begins with its size, so that fields may be added to it;
- any other struct is converted field by field.
"""

import re
import sys
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "web" / "bindings"))

import headers  # noqa: E402
import model  # noqa: E402

BY_HAND = "by hand in capi/recorder.cpp"
LEFT_OUT = {key: why for key, why in model.LEFT_OUT.items() if key not in (
    "Recorder::finish", "Recorder::failed", "World::sample_velocity", "World::liquid_particles", "World::liquid_surface", "to_string",
    "Vec3", "DVec3", "Quat", "Sym3", "Mat3", "Mat4", "Pi", "PiDouble") and not key.endswith("_batch")}
LEFT_OUT["Recorder::Recorder"] = BY_HAND
LEFT_OUT["ByteSink"] = BY_HAND

# Structs that are handed over by value, or in arrays without gaps, though functions take them: their fields are settled.
VALUES = ("Pose", "Transform", "Ray", "MassProperties", "TrackColor", "EulerAngles")
VECTORS = {"Vec3": ("float", "x y z"), "DVec3": ("double", "x y z"), "Quat": ("float", "x y z w"),
           "Sym3": ("float", "xx yy zz xy xz yz"), "Mat3": ("GyreVec3", "x y z"), "Mat4": ("float", "elements[16]")}
NUMBERS = {"float": "float", "double": "double", "int": "int32_t", "int32_t": "int32_t", "uint32_t": "uint32_t", "uint16_t": "uint16_t",
           "uint8_t": "uint8_t", "size_t": "size_t", "uint64_t": "uint64_t", "bool": "bool"}


def snake(name):
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", name).lower()


@dataclass
class CParameter:
    """One parameter of the C++ function, and the one or two that it is in C."""
    role: str           # value, definition, shape, rows, text, fill, out, handle, geometry
    name: str
    kind: str           # C++ type; of rows and fill: of an element
    default: str = ""


@dataclass
class CFunction:
    name: str
    source: object      # headers.Function
    owner: str          # the class of the handle, or ''
    handle_first: bool  # the C++ function is a free one that takes the handle's object
    parameters: list = field(default_factory=list)
    answer: str = ""    # void, value, command, error, made, borrowed, maybe, definition, whole, text, rows, shape, bytes, geometry
    kind: str = ""      # C++ type of the answer; of rows: of an element
    alternative: str = ""  # of a variant: the struct that this C function takes


class CModel(model.Model):
    excluded, renamed = LEFT_OUT, dict(model.RENAMED)
    taken_by_hand = ("RecordOptions",)

    def __init__(self, include):
        super().__init__(include)
        self.structs = self.closure()
        self.definitions = self.find_definitions()
        self.calls = [call for function in self.functions for call in self.c_functions(function)]
        names = [call.name for call in self.calls]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise headers.HeaderError(f"two C functions would be {', '.join(twice)}: give one a name in RENAMED")

    def is_filled(self, function, parameter):
        return parameter.writable or super().is_filled(function, parameter)

    def refuse_equal_names(self):
        pass  # C's names are other ones: see __init__

    # -------------------------------------------------------------------------------------------------- structs

    def element(self, kind):
        """The type inside an array or an optional value."""
        if match := re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            return match.group(1)
        inner = self.inner(kind)[1]
        return inner if inner is not None else kind

    def closure(self):
        """All structs that go to C, each after those that are parts of it."""
        out = []

        def add(name):
            if name in out or name not in self.api.structs or name in VECTORS:
                return
            for part in self.fields(name):
                add(self.element(self.element(part.type)))
            out.append(name)

        for alias in [*self.read_variants, *self.written_variants]:
            for part in self.variant_parts(alias):
                add(part)
        for name in [*self.written_structs, *self.read_structs, *self.column_structs]:
            add(name)
        return out

    def find_definitions(self):
        """Structs that some function takes by reference or in a span."""
        found = {"RecordOptions"}
        for function in self.functions:
            for parameter in self.parameters(function):
                kind = self.array_of(parameter.type) or parameter.type
                if kind in self.api.aliases and kind != "AnyShape" and kind not in self.ids:
                    found.update(self.variant_parts(kind))
                elif kind in self.structs and kind not in VALUES:
                    found.add(kind)
        return found

    def is_plain(self, kind):
        """C has the bytes of C++."""
        if match := re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            return match.group(1) == "char" or self.is_plain(match.group(1))
        return (kind in NUMBERS or kind == "char*" or kind in VECTORS or kind in self.ids or kind in self.api.enums
                or kind in self.structs and self.is_mirror(kind))

    def is_mirror(self, struct):
        return struct not in self.definitions and all(self.is_plain(part.type) for part in self.fields(struct)) and \
            len(self.fields(struct)) == len(self.api.structs[struct].fields)

    def with_default(self):
        """Structs that are no definitions and that a program fills in: C has a function that returns each with its defaults."""
        found = set()

        def add(name):
            if name in found or name not in self.structs:
                return
            found.add(name)
            for part in self.fields(name):
                add(self.element(self.element(part.type)))

        for name in [*self.written_structs, *self.variant_parts("AnyShape")]:
            add(name)
        return [name for name in self.structs if name in found and name not in self.definitions]

    # ------------------------------------------------------------------------------------------------- functions

    def c_name(self, function):
        if function.name == "to_string":
            return f"gyre_{snake(function.parameters[0].type)}_name"
        if function.name == function.owner:
            return f"gyre_{snake(function.owner)}_create"
        if function.static:
            return f"gyre_{snake(function.owner)}_{function.name}"
        key = self.full_key(function)
        name = snake(self.renamed[key]) if key in self.renamed else function.name
        owner = self.self_class(function)
        return f"gyre_{snake(owner)}_{name}" if owner and function.owner else f"gyre_{name}"

    def c_functions(self, function):
        owner = self.self_class(function)
        call = CFunction(self.c_name(function), function, owner, bool(owner) and not function.owner)
        variants = [p for p in self.parameters(function) if p.type in self.api.aliases and p.type not in self.ids and p.type != "AnyShape"]
        call.answer, call.kind = self.answer_of(function)
        for parameter in function.parameters[1 if call.handle_first else 0:]:
            if parameter in variants:
                call.parameters.append(CParameter("definition", parameter.name, parameter.type))
                continue
            role, kind = self.role_of(function, parameter)
            if role == "table":
                array = self.array_of(parameter.type)
                call.answer, call.kind = ("rows" if array else "whole"), (array or parameter.type)
            call.parameters.append(CParameter(role, parameter.name, kind, parameter.default))
        if not variants:
            return [call]
        calls = []
        for part in self.variant_parts(variants[0].type):
            parameters = [CParameter("definition", p.name, part) if p.kind == variants[0].type else p for p in call.parameters]
            name = re.sub(r"_joint$", "", call.name) + f"_{snake(part.removesuffix('Def'))}_joint"
            calls.append(CFunction(name, function, owner, call.handle_first, parameters, call.answer, call.kind, part))
        return calls

    def role_of(self, function, parameter):
        kind = parameter.type
        element = self.array_of(kind)
        if parameter.writable:
            return "fill", element
        if super().is_filled(function, parameter):
            return "table", kind
        if parameter.by_pointer:
            return "out", kind
        if kind == "vector<byte>" or element is not None:
            return "rows", element
        if kind == "string_view":
            return "text", kind
        if kind == "AnyShape":
            return "shape", kind
        if kind == "Geometry":
            return "geometry", kind
        if kind in self.api.classes:
            return "handle", kind
        if kind in self.definitions:
            return "definition", kind
        if self.is_plain(kind):
            return "value", kind
        if kind in self.excluded and parameter.default:
            return "left", kind
        raise headers.HeaderError(f"{self.key(function)}: C has no way to take '{kind}'")

    def answer_of(self, function):
        result = function.result
        outer, inner = self.inner(result)
        if function.name == function.owner:
            return "made", function.owner
        if result == "void":
            return "void", ""
        if result == "Error":
            return "error", ""
        if outer == "Result":
            return ("made" if inner in self.api.classes else "checked"), inner
        if outer == "optional":
            return "maybe", inner
        if function.nullable:
            return ("shape" if result == "AnyShape" else "maybe"), result
        if outer in ("span", "vector"):
            return "rows", inner
        if result in ("string_view", "char*"):
            return "text", result
        if result == "Geometry":
            return "geometry", result
        if result in self.api.classes:
            return "borrowed", result
        if result in self.definitions:
            return "definition", result
        if self.is_plain(result):
            command = function.owner == "World" and not function.const and (result == "bool" or result in self.ids)
            return ("command" if command else "value"), result
        if result in self.structs:
            return "whole", result
        raise headers.HeaderError(f"{self.key(function)}: C has no way to return '{result}'")

    # ---------------------------------------------------------------------------------------------------- C types

    def c_type(self, kind):
        if kind in NUMBERS:
            return NUMBERS[kind]
        if kind == "byte":
            return "uint8_t"
        if kind in ("char*", "char"):
            return "const char*" if kind == "char*" else "char"
        if kind == "Geometry":
            return "GyreGeometry*"
        if kind in self.api.aliases or kind in VECTORS or kind in self.api.enums or kind in self.api.structs or kind in self.api.classes:
            return "Gyre" + kind
        raise headers.HeaderError(f"C has no type for '{kind}'")

    def c_fields(self, struct):
        """(C type, name with brackets, doc) of each member."""
        out = [("uint32_t", "size", "of this struct in bytes; gyre_..._init() sets it")] if struct in self.definitions else []
        for part in self.fields(struct):
            out += self.c_members(part)
        return out

    def c_members(self, part):
        kind = part.type
        outer, inner = self.inner(kind)
        if match := re.fullmatch(r"([\w:]+)\[(\w+)\]", kind):
            count = match.group(2)
            return [(self.c_type(match.group(1)), f"{part.name}[{self.constant(count[1:]) if count.startswith('k') else count}]", part.doc)]
        if outer == "optional":
            return [("bool", f"has_{part.name}", "false: the next member is not given"), (self.c_type(inner), part.name, part.doc)]
        if outer in ("span", "vector"):
            return [(f"const {self.c_type(inner)}*".replace("const const char*", "const char* const"), part.name, part.doc), ("size_t", f"{part.name}_count", "")]
        if kind == "string_view":
            return [("const char*", part.name, part.doc), ("size_t", f"{part.name}_count", "bytes")]
        return [(self.c_type(kind), part.name, part.doc)]
