"""What of the C++ interface goes to the web, and how each C++ type is carried there.

Everything in the headers below is carried. What is not stands in LEFT_OUT with its reason; a type that nobody taught
this file is an error, so that a new function of the engine cannot be missed.
"""

import re
from pathlib import Path

import headers

ROOT = Path(__file__).resolve().parents[2]
HEADERS = ["math", "ids", "result", "geometry", "queries", "stepping", "defs", "joints", "coupling", "events", "soft", "fluid", "fields", "world", "replay", "debug", "articulation", "track"]
# Public headers that are not bound, and why.
NOT_BOUND = {"gyre": "includes the others",
             "replica": "one world over several processes; a page is one",
             "batch": "a page steps a world a worker; C has it by hand in capi/batch.cpp", "decomposition": "seconds of work on a mesh, done before a page is made; its hulls come as hulls",
             "bounds": "measures meshes before they are cooked; a page does not choose volumes",
             "memory": "a page has one memory, and the browser hands it out"}

LEFT_OUT = {
    "stop_at_error": "what C++ does where the value of an error is taken",
    "World::World": "made by create()",
    "World::add_body(BodyDef,ShapeDef)": "the form with several shapes takes one as well",
    "Geometry::Geometry": "made by the cook functions",
    "Geometry::data": "the inside of the engine",
    "Geometry::shared": "the inside of the engine",
    "WorldDef.host_tasks": "function pointers; a page has no thread pool to lend",
    "HostTasks": "see WorldDef.host_tasks",
    "Recorder::Recorder": "by hand in hosts.cpp, with memory as its sink",
    "Recorder::finish": "by hand in hosts.cpp, which also takes the bytes",
    "Recorder::failed": "memory as a sink does not fail; options out of range are an error at the start",
    "ByteSink": "by hand in hosts.cpp: the recorder's memory",
    "World::cast_ray_batch": "a batch fills a span that it is given; a page asks one by one",
    "World::cast_shape_batch": "see World::cast_ray_batch",
    "World::closest_point_batch": "see World::cast_ray_batch",
    "World::overlap_count_batch": "see World::cast_ray_batch",
    "World::penetration_batch": "see World::cast_ray_batch",
    "World::cast_ray_any_batch": "see World::cast_ray_batch",
    "World::cast_shape_any_batch": "see World::cast_ray_batch",
    "World::overlap_any_batch": "see World::cast_ray_batch",
    "World::closest_point_any_batch": "see World::cast_ray_batch",
    "World::cast_ray_all_batch": "see World::cast_ray_batch",
    "World::cast_shape_all_batch": "see World::cast_ray_batch",
    "World::overlap_all_batch": "see World::cast_ray_batch",
    "World::closest_point_all_batch": "see World::cast_ray_batch",
    "World::penetration_all_batch": "see World::cast_ray_batch",
    "World::set_problem_hook": "a function pointer; problems() has them",
    "ProblemHook": "see World::set_problem_hook",
    "World::sample_velocity": "by hand in fluid_host.cpp, which returns the array",
    "World::liquid_particles": "see World::sample_velocity",
    "World::liquid_surface": "see World::sample_velocity",
    "default_joint": "{ kind: ... } is one",
    "QueryFilter.accepts": "a function pointer; the layers of the filter are carried",
    "QueryFilter.accepts_soft": "see QueryFilter.accepts",
    "QueryFilter.user": "see QueryFilter.accepts",
    "BodyNames": "a function pointer; bodies of a scene are named by the scene",
    "to_string": "names of enumerators are part of the enums, see nameOf",
    "Vec3": "numbers in a row", "DVec3": "numbers in a row", "Quat": "numbers in a row", "Sym3": "numbers in a row",
    "Mat3": "numbers in a row", "Mat4": "numbers in a row",
    "Pi": "Math.PI", "PiDouble": "Math.PI",
}

# Two functions of one name need two names in TypeScript. By class, name and the type of the first parameter.
RENAMED = {
    "World::exists(BodyId)": "bodyExists",
    "World::exists(ShapeId)": "shapeExists",
    "World::exists(JointId)": "jointExists",
    "World::exists(FieldId)": "fieldExists",
    "World::exists(CouplingId)": "couplingExists",
    "World::exists(SoftId)": "softExists",
    "World::exists(FluidId)": "fluidExists",
    "World::user_data(ShapeId)": "shapeUserData",
    "World::set_user_data(ShapeId,uint64_t)": "setShapeUserData",
    "World::create(WorldDef)": "createWorld",
    "Replay::open(vector<byte>,WorldDef)": "openReplay",
    "PoseTrack::open(vector<byte>)": "openPoseTrack",
    "first_difference(span<byte>,WorldDef,WorldDef,int,float)": "firstDifference",
    "first_difference(span<byte>,WorldDef)": "firstDifferenceOfRecording",
}

# Values of fixed size that travel as numbers in a row: count and C++ element type.
FLAT = {"Vec3": (3, "float"), "DVec3": (3, "double"), "Quat": (4, "float"), "Sym3": (6, "float"), "Mat3": (9, "float"),
        "Mat4": (16, "float")}
NUMBERS = {"float": None, "double": None, "int": (-2**31, 2**31 - 1), "int32_t": (-2**31, 2**31 - 1),
           "uint32_t": (0, 2**32 - 1), "uint16_t": (0, 65535), "uint8_t": (0, 255), "size_t": (0, 2**32 - 1)}
ARRAYS = {"float": "Float32Array", "double": "Float64Array", "int": "Int32Array", "int32_t": "Int32Array",
          "uint32_t": "Uint32Array", "uint16_t": "Uint16Array", "uint8_t": "Uint8Array", "bool": "Uint8Array"}
# Structs that functions by hand take.
TAKEN_BY_HAND = ("Stepping", "RecordOptions")
# 64-bit numbers that are bits rather than counts: bigint in TypeScript. The others are numbers, the largest is Infinity.
BITS = ("hash", "content_hash", "user_data")


def camel(name):
    parts = name.split("_")
    return parts[0] + "".join(part[:1].upper() + part[1:] for part in parts[1:])


def pascal(name):
    text = camel(name)
    return text[:1].upper() + text[1:]


class Model:
    # Another language may leave out and rename others: capi/c_model.py.
    excluded, renamed, taken_by_hand = LEFT_OUT, RENAMED, TAKEN_BY_HAND

    def __init__(self, include):
        self.files = [name for name in HEADERS if (include / "gyre" / f"{name}.h").exists()]
        self.api = headers.read_headers([include / "gyre" / f"{name}.h" for name in self.files])
        unknown = {path.stem for path in (include / "gyre").glob("*.h")} - set(HEADERS) - set(NOT_BOUND)
        if unknown:
            raise headers.HeaderError(f"new public headers, not bound: {', '.join(sorted(unknown))}: add them to HEADERS")
        self.ids = tuple(name for name, value in self.api.aliases.items() if value.startswith("Id<"))
        self.read_structs, self.written_structs = [], []
        self.read_variants, self.written_variants = [], []
        self.column_structs = []
        self.functions = [f for f in self.all_functions() if not self.left_out(f)]
        for function in self.functions:
            self.use(function)
        for name in self.taken_by_hand:
            self.walk(name, self.written_structs, "TAKEN_BY_HAND")
        self.refuse_equal_names()

    # ------------------------------------------------------------------------------------------------ choosing

    def all_functions(self):
        for group in self.api.classes.values():
            yield from group.constructors
            yield from group.functions
        yield from self.api.functions

    def refuse_equal_names(self):
        seen = {}
        for function in self.functions:
            place = (self.self_class(function), self.script_name(function))
            if place in seen:
                raise headers.HeaderError(f"{self.full_key(function)} and {self.full_key(seen[place])} would both be "
                                          f"{place[1]}() in TypeScript: give one a name in RENAMED")
            seen[place] = function

    @staticmethod
    def key(function):
        return (f"{function.owner}::" if function.owner else "") + function.name

    def full_key(self, function):
        return f"{self.key(function)}({','.join(p.type for p in function.parameters)})"

    def left_out(self, function):
        return any(key in self.excluded for key in (self.key(function), self.full_key(function), function.owner))

    def script_name(self, function):
        key = self.full_key(function)
        if key in self.renamed:
            return self.renamed[key]
        if function.owner and function.name == function.owner:
            return "create" + function.owner
        return camel(function.name)

    def export_name(self, function):
        same = [f for f in self.functions if self.key(f) == self.key(function)]
        name = f"{function.owner or 'gyre'}_{function.name}"
        return name if len(same) == 1 else f"{name}_{same.index(function)}"

    def self_class(self, function):
        """The class in TypeScript that gets the function as a method; '' for the module itself."""
        if function.owner:
            made_here = function.static or function.name == function.owner
            return "" if made_here else function.owner
        first = function.parameters[0] if function.parameters else None
        return first.type if first is not None and first.type in self.api.classes and first.type in ("World", "Replay") else ""

    def parameters(self, function):
        """Those that the caller gives."""
        skip = 1 if not function.owner and self.self_class(function) else 0
        return [p for p in function.parameters[skip:] if not self.is_out(p) and not self.is_fill(function, p)
                and not self.is_filled(function, p) and not (p.type in self.excluded and p.type not in FLAT and p.default)]

    def is_filled(self, function, parameter):
        """A table or an array that the function fills."""
        kind = parameter.type
        return parameter.by_mutable_reference and (self.is_struct(kind) or self.array_of(kind) is not None)

    @staticmethod
    def is_out(parameter):
        return parameter.by_pointer

    @staticmethod
    def is_fill(function, parameter):
        return function.result == "size_t" and parameter.name == "out" and parameter.type.startswith("span<")

    # ---------------------------------------------------------------------------------------- walking the types

    @staticmethod
    def inner(kind):
        match = re.fullmatch(r"(\w+)<(.*)>", kind)
        return (match.group(1), match.group(2)) if match else (None, None)

    def array_of(self, kind):
        """The element type of a span or vector, else None."""
        outer, inner = self.inner(kind)
        return inner if outer in ("span", "vector") else None

    def is_struct(self, kind):
        return kind in self.api.structs and kind not in FLAT

    def variants(self):
        return [name for name, value in self.api.aliases.items() if value.startswith("variant<")]

    def variant_parts(self, name):
        return headers.split_commas(self.inner(self.api.aliases[name])[1])

    def is_in_variant(self, struct):
        return any(struct in self.variant_parts(name) for name in self.variants())

    def use(self, function):
        where = self.key(function)
        for parameter in self.parameters(function):
            self.walk(parameter.type, self.written_structs, where)
        for parameter in function.parameters:
            if self.is_fill(function, parameter) or self.is_filled(function, parameter):
                self.walk(parameter.type, self.read_structs, where)
        if function.result != "void" and not any(self.is_fill(function, p) for p in function.parameters):
            self.walk(function.result, self.read_structs, where)

    def walk(self, kind, into, where):
        array = re.fullmatch(r"([\w:]+)\[(\w+)\]", kind)
        outer, inner = self.inner(kind)
        if self.is_value(kind) or kind in ("Error", "Geometry") or kind in self.api.classes:
            return
        if array:
            self.walk(array.group(1), into, where)
        elif kind in self.api.aliases:
            for part in self.variant_parts(kind):
                self.walk(part, into, where)
            seen = self.read_variants if into is self.read_structs else self.written_variants
            if kind not in seen:
                seen.append(kind)
        elif outer in ("span", "vector"):
            if inner == "byte" or self.is_value(inner):
                return
            if into is self.read_structs and self.is_struct(inner) and self.columnable(inner):
                if inner not in self.column_structs:
                    self.column_structs.append(inner)
            else:
                self.walk(inner, into, where)
        elif outer in ("optional", "Result"):
            self.walk(inner, into, where)
        elif kind in self.api.structs:
            if kind in into:
                return
            for part in self.fields(kind):
                self.walk(part.type, into, f"{kind}.{part.name}")
            into.append(kind)
        else:
            raise headers.HeaderError(f"{where}: no way is known to carry the type '{kind}'")

    def is_value(self, kind):
        """One number, one row of numbers, or a text."""
        return (kind in NUMBERS or kind in FLAT or kind in self.ids or kind in self.api.enums
                or kind in ("bool", "uint64_t", "char*", "string_view") or re.fullmatch(r"char\[\w+\]", kind) is not None)

    def columnable(self, struct):
        return all(self.is_value(f.type) or re.fullmatch(r"(float|double|bool|u?int\d*_t|int)\[\d+\]", f.type)
                   or (self.is_struct(f.type) and self.columnable(f.type)) for f in self.fields(struct))

    def fields(self, struct):
        return [f for f in self.api.structs[struct].fields if f"{struct}.{f.name}" not in self.excluded]

    def leaves(self, struct, prefix="", path=""):
        """(name in TypeScript, C++ path, type, doc) of every column of an array of structs."""
        out = []
        for part in self.fields(struct):
            name = camel(part.name) if not prefix or prefix == "pose" else prefix + pascal(part.name)
            if self.is_struct(part.type):
                out += self.leaves(part.type, name, f"{path}{part.name}.")
            else:
                out.append((name, path + part.name, part.type, part.doc))
        return out

    def column_type(self, kind, name):
        """(array type in TypeScript or 'text', numbers a row, whether C++ memory has just this form)"""
        if kind in FLAT:
            return ARRAYS[FLAT[kind][1]], FLAT[kind][0], True
        if kind in self.ids:
            return "Float64Array", 1, False
        if kind in ARRAYS:
            return ARRAYS[kind], 1, True
        if kind == "uint64_t":
            return ("BigUint64Array", 1, True) if name in BITS else ("Float64Array", 1, False)
        if kind in self.api.enums:
            return "Uint8Array", 1, True
        if kind in ("char*", "string_view") or re.fullmatch(r"char\[\w+\]", kind):
            return "text", 1, False
        if match := re.fullmatch(r"(\w+)\[(\d+)\]", kind):
            array, width, plain = self.column_type(match.group(1), name)
            return array, width * int(match.group(2)), plain
        raise headers.HeaderError(f"{name}: no way is known to carry the type '{kind}' in arrays")

    def constant(self, name):
        """The number behind a constant."""
        literal = self.api.constants[name][0]
        text = re.sub(r"\bk([A-Z]\w*)", lambda m: str(self.constant(m.group(1))), literal)
        text = re.sub(r"\b(0x[0-9a-fA-F]+|\d[\d.']*)(?:u|f|ull|l)?\b", lambda m: m.group(1).replace("'", ""), text)
        if not re.fullmatch(r"[\w\s()<>|&+*/.-]+", text):
            raise headers.HeaderError(f"k{name} = {literal}: not understood")
        return eval(text, {"__builtins__": {}})  # digits and operators only
