"""How Python values become those of the C interface, and back. The classes themselves are made by capi/generate.py: _api.py.

A struct is a ctypes structure with the layout of C whose members are properties: numbers, enums, NumPy arrays. A view is a NumPy array over
the memory of the engine; it keeps the object alive that owns the memory, but its content changes with the next change or step.
"""

import ctypes
import difflib
import enum

import numpy as np

from ._library import library


class GyreError(Exception):
    """A call that the engine refused. The call changed nothing. `code` is an ErrorCode as a number."""

    def __init__(self, message, code=0):
        super().__init__(message)
        self.code = code


def refused():
    return GyreError(library.gyre_last_error().decode("utf-8", "replace"), library.gyre_last_error_code())


class Id(int):
    """A whole number that names an object of a world; 0 is null. It never refers to another object once its own is gone."""

    __slots__ = ()

    def __repr__(self):
        return f"{type(self).__name__}({self & 0xffffffff}:{self >> 32 & 0xffff})" if self else f"{type(self).__name__}(null)"


class Enum(enum.IntEnum):
    """An enumeration. Every function that takes one also takes its name as a text."""

    @classmethod
    def of(cls, value):
        if isinstance(value, cls):
            return value
        if isinstance(value, str):
            try:
                return cls[value.upper()]
            except KeyError:
                raise ValueError(f"{cls.__name__} has no '{value}', only {', '.join(e.name.lower() for e in cls)}") from None
        return cls(value)

    def __str__(self):
        return self.name.lower()


class _Memory:
    """What NumPy asks for the address of a view, and what keeps the owner alive."""

    __slots__ = ("__array_interface__", "owner")

    def __init__(self, address, shape, typestr, owner, writable=False):
        self.__array_interface__ = {"version": 3, "data": (address, not writable), "shape": shape, "typestr": typestr}
        self.owner = owner


def view(address, count, dtype, columns, owner):
    """A NumPy array over memory of the engine."""
    shape = (count, columns) if columns else (count,)
    if not address or not count:
        empty = np.empty((0, columns) if columns else 0, dtype)
        return empty.view(np.recarray) if dtype.names else empty
    if dtype.names is None:
        return np.asarray(_Memory(address, shape, dtype.str, owner))
    return np.asarray(_Memory(address, (count * dtype.itemsize,), "|u1", owner)).view(dtype).view(np.recarray)


# ------------------------------------------------------------------------------------------------------- kinds of members


class Kind:
    """A C++ type: `ctype` its ctypes type, `dtype` and `columns` how NumPy sees a row of it."""

    dtype = None
    columns = 0

    def get(self, raw, owner):
        return raw

    def set(self, value, keep):
        return value

    def members(self, name):
        return [(name, self.ctype)]

    def read(self, struct, name, owner):
        return self.get(type(struct)._raw[name].__get__(struct), owner)

    def write(self, struct, name, value):
        type(struct)._raw[name].__set__(struct, self.set(value, struct._keep))


class Number(Kind):
    def __init__(self, ctype, dtype, convert):
        self.ctype, self.dtype, self.set_ = ctype, np.dtype(dtype), convert
        self.integer = convert is int
        if self.integer:
            bits = ctypes.sizeof(ctype) * 8
            signed = self.dtype.kind == "i"
            self.low, self.high = (-(1 << bits - 1), (1 << bits - 1) - 1) if signed else (0, (1 << bits) - 1)

    def set(self, value, keep=None):
        value = self.set_(value)
        if self.integer and not self.low <= value <= self.high:
            raise ValueError(f"found {value}, expected {self.low} to {self.high}")
        return value


F32 = Number(ctypes.c_float, "<f4", float)
F64 = Number(ctypes.c_double, "<f8", float)
I32 = Number(ctypes.c_int32, "<i4", int)
U8 = Number(ctypes.c_uint8, "u1", int)
U16 = Number(ctypes.c_uint16, "<u2", int)
U32 = Number(ctypes.c_uint32, "<u4", int)
U64 = Number(ctypes.c_uint64, "<u8", int)
SIZE = Number(ctypes.c_size_t, "<u8", int)
BOOL = Number(ctypes.c_bool, "?", bool)


class EnumKind(Kind):
    ctype, dtype = ctypes.c_uint8, np.dtype("u1")

    def __init__(self, cls):
        self.cls = cls

    def get(self, raw, owner):
        return self.cls(raw)

    def set(self, value, keep=None):
        return int(self.cls.of(value))


class IdBits(ctypes.Structure):
    """An id as a member of a struct, where its alignment is that of its parts."""

    _fields_ = [("index", ctypes.c_uint32), ("generation", ctypes.c_uint16), ("world", ctypes.c_uint16)]


class IdKind(Kind):
    ctype, dtype = IdBits, np.dtype("<u8")

    def __init__(self, cls):
        self.cls = cls

    def get(self, raw, owner):
        return self.cls(raw.index | raw.generation << 32 | raw.world << 48)

    def set(self, value, keep=None):
        bits = 0 if value is None else int(value)
        return IdBits(bits & 0xffffffff, bits >> 32 & 0xffff, bits >> 48)


class Vector(Kind):
    """So many numbers in a row: a NumPy array of its own in Python."""

    def __init__(self, name, element, count, dtype):
        self.ctype = type(name, (ctypes.Structure,), {"_fields_": [(f"v{i}", element) for i in range(count)]})
        self.dtype, self.columns, self.name = np.dtype(dtype), count, name

    def get(self, raw, owner):
        return np.frombuffer(raw, self.dtype).copy()

    def set(self, value, keep=None):
        numbers = [float(v) for v in np.ravel(value)] if not isinstance(value, (tuple, list)) else value
        if len(numbers) != self.columns:
            raise ValueError(f"found {len(numbers)} numbers, expected {self.columns} ({self.name})")
        return self.ctype(*numbers)


VEC3 = Vector("Vec3", ctypes.c_float, 3, "<f4")
DVEC3 = Vector("DVec3", ctypes.c_double, 3, "<f8")
QUAT = Vector("Quat", ctypes.c_float, 4, "<f4")
SYM3 = Vector("Sym3", ctypes.c_float, 6, "<f4")
MAT3 = Vector("Mat3", ctypes.c_float, 9, "<f4")
MAT4 = Vector("Mat4", ctypes.c_float, 16, "<f4")


class StructKind(Kind):
    def __init__(self, cls):
        self.cls = self.ctype = cls

    @property
    def dtype(self):
        return self.cls._rows_dtype()

    def get(self, raw, owner):
        raw._owner = owner
        return raw

    def read(self, struct, name, owner):
        """A part lies in the memory of the whole, which keeps it, and so the arrays that are given to it."""
        part = struct._keep.get((name, "part"))
        if part is None:
            part = struct._keep[name, "part"] = type(struct)._raw[name].__get__(struct)
            part._owner = owner
        return part

    def set(self, value, keep=None):
        made = self.cls._of(value)
        if keep is not None:
            keep[id(made)] = made
        return made

    def write(self, struct, name, value):
        made = self.cls._of(value)
        type(struct)._raw[name].__set__(struct, made)
        struct._keep[name, "given"] = made


class Texts(Kind):
    """Characters inside a struct, or a pointer to them."""

    def __init__(self, size=0):
        self.ctype = ctypes.c_char * size if size else ctypes.c_char_p
        self.dtype = np.dtype(f"S{size}") if size else np.dtype("<u8")

    def get(self, raw, owner):
        return (raw or b"").decode("utf-8", "replace")


class Several(Kind):
    """A fixed number of values."""

    def __init__(self, kind, count):
        self.kind, self.count, self.ctype = kind, count, kind.ctype * count
        self.dtype = np.dtype((kind.dtype, (count, kind.columns) if kind.columns else (count,))) if kind.dtype is not None else None

    def get(self, raw, owner):
        return [self.kind.get(part, owner) for part in raw]

    def set(self, value, keep=None):
        if len(value) != self.count:
            raise ValueError(f"found {len(value)} values, expected {self.count}")
        return self.ctype(*[self.kind.set(part, keep) for part in value])


class Optional(Kind):
    def __init__(self, kind):
        self.kind = kind

    def members(self, name):
        return [(f"has_{name}", ctypes.c_bool), (name, self.kind.ctype)]

    def read(self, struct, name, owner):
        return self.kind.read(struct, name, owner) if type(struct)._raw[f"has_{name}"].__get__(struct) else None

    def write(self, struct, name, value):
        type(struct)._raw[f"has_{name}"].__set__(struct, value is not None)
        if value is not None:
            self.kind.write(struct, name, value)


class Text(Kind):
    """Characters and their number."""

    def members(self, name):
        return [(name, ctypes.c_char_p), (f"{name}_count", ctypes.c_size_t)]

    def read(self, struct, name, owner):
        count = type(struct)._raw[f"{name}_count"].__get__(struct)
        address = ctypes.c_void_p.from_address(ctypes.addressof(struct) + type(struct)._raw[name].offset).value
        return ctypes.string_at(address, count).decode("utf-8", "replace") if count else ""


class Rows(Kind):
    """An array: pointer and count. Given as anything that NumPy takes; read as a view, or as a list where C has no plain rows."""

    def __init__(self, kind):
        self.kind = kind

    def members(self, name):
        return [(name, ctypes.c_void_p), (f"{name}_count", ctypes.c_size_t)]

    def read(self, struct, name, owner):
        raw = type(struct)._raw
        return self.rows(raw[name].__get__(struct), raw[f"{name}_count"].__get__(struct), owner)

    def rows(self, address, count, owner):
        if isinstance(self.kind, (StructKind, ShapeKind)) and not self.kind.cls._plain:
            cls = self.kind.cls
            size = ctypes.sizeof(cls)
            return [self.kind.get(cls.from_address(address + i * size), owner) for i in range(count)]
        if isinstance(self.kind, Texts) and self.kind.ctype is ctypes.c_char_p:
            return [text.decode("utf-8", "replace") for text in (ctypes.c_char_p * count).from_address(address)]
        return view(address, count, self.kind.dtype, self.kind.columns, owner)

    def write(self, struct, name, value):
        memory, address, count = self.memory(value, struct._keep)
        struct._keep[name] = memory
        type(struct)._raw[name].__set__(struct, address)
        type(struct)._raw[f"{name}_count"].__set__(struct, count)

    def memory(self, value, keep=None):
        """(what to keep alive, address, count)"""
        kind = self.kind
        if value is None:
            return None, None, 0
        if isinstance(kind, StructKind) and not (isinstance(value, np.ndarray) and value.dtype == kind.dtype):
            if isinstance(value, (kind.cls, dict)) or not hasattr(value, "__len__"):
                value = [value]
            made = [kind.cls._of(part) for part in value]
            rows = (kind.cls * len(made))()
            for i, part in enumerate(made):
                ctypes.memmove(ctypes.byref(rows, i * ctypes.sizeof(kind.cls)), ctypes.byref(part), ctypes.sizeof(kind.cls))
            return (rows, made), ctypes.addressof(rows), len(made)
        rows = np.ascontiguousarray(value, kind.dtype)
        rows = rows.reshape(-1, kind.columns) if kind.columns else rows.ravel()
        return rows, rows.ctypes.data, len(rows)


# ------------------------------------------------------------------------------------------------------------- structs


class Struct(ctypes.Structure):
    """The base of all structs. Fields are given by name (in a value, also in their order) and are properties."""

    _kinds, _raw = {}, {}
    _plain = True  # NumPy can show rows of it
    _owner = None  # of the memory that views show

    def __init__(self, *values, **fields):
        super().__init__()
        self._start()
        if len(values) > len(self._kinds):
            raise TypeError(f"{type(self).__name__} has {len(self._kinds)} fields, found {len(values)} values")
        fields.update(zip(self._kinds, values))
        for name, value in fields.items():
            if name not in self._kinds:
                near = difflib.get_close_matches(name, self._kinds, 1)
                raise TypeError(f"{type(self).__name__} has no field '{name}'" + (f", perhaps '{near[0]}'" if near else
                                f", only {', '.join(self._kinds)}"))
            setattr(self, name, value)

    def _start(self):
        default = getattr(type(self), "_default", None)
        if default is not None:
            ctypes.memmove(ctypes.byref(self), default, ctypes.sizeof(self))

    @property
    def _keep(self):
        """Arrays that members point to."""
        kept = self.__dict__.get("_kept")
        if kept is None:
            kept = self.__dict__["_kept"] = {}
        return kept

    @classmethod
    def _of(cls, value):
        """A struct from what a caller may give for it."""
        if isinstance(value, cls):
            return value
        if value is None:
            return cls()
        if isinstance(value, dict):
            return cls(**value)
        return cls.from_other(value)

    @classmethod
    def from_other(cls, value):
        first = next(iter(cls._kinds.values()))
        if first.columns and np.ndim(value) == 1 and len(value) == first.columns:
            return cls(**{next(iter(cls._kinds)): value})  # a pose from a position
        for name, kind in cls._kinds.items():
            if kind is SHAPE and SHAPE.is_shape(value):
                return cls(**{name: value})  # a definition of a shape from its geometry
        if isinstance(value, (tuple, list)):
            return cls(**dict(zip(cls._kinds, value)))
        raise TypeError(f"found {type(value).__name__}, expected {cls.__name__} or a dict of its fields")

    @classmethod
    def _rows_dtype(cls):
        if "_dtype" not in cls.__dict__:
            kinds = cls._kinds
            cls._dtype = np.dtype({"names": list(kinds), "formats": [_format(kind) for kind in kinds.values()],
                                   "offsets": [cls._raw[name].offset for name in kinds], "itemsize": ctypes.sizeof(cls)})
        return cls._dtype

    def _owned(self):
        """Copies the arrays that belong to somebody else, so that this struct is good for ever."""
        for name, kind in self._kinds.items():
            if isinstance(kind, Rows):
                rows = kind.read(self, name, None)
                kind.write(self, name, [row._owned() for row in rows] if isinstance(rows, list) and rows and isinstance(rows[0], Struct)
                           else np.array(rows) if isinstance(rows, np.ndarray) else rows)
            elif isinstance(kind, (StructKind, Optional)):
                part = kind.read(self, name, None)
                if isinstance(part, Struct) and not type(part)._plain:
                    part._owned()
                    self._keep[name] = part
        return self

    def __repr__(self):
        return f"{type(self).__name__}({', '.join(f'{name}={getattr(self, name)!r}' for name in self._kinds)})"

    def __eq__(self, other):
        return type(other) is type(self) and all(np.array_equal(getattr(self, n), getattr(other, n)) for n in self._kinds)

    __hash__ = None


def _format(kind):
    return (kind.dtype, (kind.columns,)) if kind.columns else kind.dtype


class Definition(Struct):
    """A struct with a default for every field. Fields are given by name only."""

    _plain = False

    def __init__(self, *values, **fields):
        if values:
            raise TypeError(f"the fields of {type(self).__name__} are given by name: {', '.join(list(self._kinds)[:6])}, ...")
        super().__init__(**fields)


def define(cls, c_name, plain, kinds, docs):
    """Gives a class its members. `kinds` by name, in the order of C."""
    members = [("size", ctypes.c_uint32)] if c_name and issubclass(cls, Definition) else []
    for name, kind in kinds.items():
        members += kind.members(name)
    cls._fields_ = members
    cls._raw = {name: cls.__dict__[name] for name, _ in members}
    cls._kinds, cls._plain = kinds, plain
    for name, kind in kinds.items():
        setattr(cls, name, property(lambda self, n=name, k=kind: k.read(self, n, self._owner),
                                    lambda self, value, n=name, k=kind: _set(self, n, k, value), doc=docs.get(name)))
    if c_name and issubclass(cls, Definition):
        init = getattr(library, f"gyre_{c_name}_init")
        init.argtypes, init.restype = [ctypes.c_void_p, ctypes.c_size_t], None
        cls._default = (ctypes.c_char * ctypes.sizeof(cls))()
        init(cls._default, ctypes.sizeof(cls))
    elif c_name:
        make = getattr(library, f"gyre_{c_name}_default")
        make.argtypes, make.restype = [], cls
        cls._default = bytes(make())


def _set(struct, name, kind, value):
    try:
        kind.write(struct, name, value)
    except (TypeError, ValueError) as error:
        raise type(error)(f"{type(struct).__name__}.{name}: {error}") from None


# -------------------------------------------------------------------------------------------------------------- shapes


class _Measures(ctypes.Union):
    _fields_ = [("room", ctypes.c_char * 16), ("geometry", ctypes.c_void_p)]


class AnyShape(ctypes.Structure):
    """A shape of any kind, as C has it."""

    _fields_ = [("kind", ctypes.c_uint8), ("measures", _Measures)]
    _plain = False


class ShapeKind(Kind):
    """Sphere, Box and so on, or a Geometry. `classes` by the number of their kind, and the class of cooked geometry: _api.py sets both."""

    ctype = cls = AnyShape
    classes, geometry = {}, None

    def get(self, raw, owner):
        if raw.kind in self.classes:
            cls = self.classes[raw.kind]
            return cls.from_buffer_copy(ctypes.string_at(ctypes.addressof(raw.measures), ctypes.sizeof(cls)))
        return self.geometry.from_handle(raw.measures.geometry)

    def set(self, value, keep=None):
        out = AnyShape()
        if isinstance(value, self.geometry):
            out.kind, out.measures.geometry = int(value.kind()), value.handle
            if keep is not None:
                keep["geometry"] = value
            return out
        for number, cls in self.classes.items():
            if isinstance(value, cls):
                out.kind = number
                ctypes.memmove(ctypes.byref(out.measures), ctypes.byref(value), ctypes.sizeof(cls))
                return out
        raise TypeError(f"found {type(value).__name__}, expected a shape: {', '.join(c.__name__ for c in self.classes.values())}, Geometry")

    def is_shape(self, value):
        return isinstance(value, (self.geometry, *self.classes.values()))


SHAPE = ShapeKind()


# ------------------------------------------------------------------------------------------------------------- handles


class Handle:
    """An object of the engine. The engine frees it when nothing in Python refers to it any more."""

    _destroy = None

    def __init__(self, *_, **__):
        raise TypeError(f"{type(self).__name__} is made by a function of the package")

    @classmethod
    def from_handle(cls, handle, owner=None):
        if not handle:
            return None
        self = object.__new__(cls)
        self.handle, self.owner = handle, owner
        return self

    def __del__(self):
        handle = getattr(self, "handle", None)
        if handle and self.owner is None and self._destroy is not None:
            self._destroy(handle)
        self.handle = None


def call(name, result, *arguments):
    """The function of the library, with its types."""
    function = getattr(library, name)
    function.argtypes, function.restype = list(arguments), result
    return function


POINTER, COUNT = ctypes.c_void_p, ctypes.c_size_t


def done(value):
    """The result of a command, which is false where it was refused."""
    if not value:
        raise refused()
    return value


def accepted(code):
    if code:
        raise refused()


def definition(cls, value, fields=None):
    """A definition from an object, a dict, or keyword arguments."""
    if fields:
        return cls(**fields) if value is None else cls(**{**({n: getattr(value, n) for n in cls._kinds} if isinstance(value, cls) else value), **fields})
    return cls._of(value)


def fill(function, kind):
    """Asks how many rows there are, then for all of them."""
    count = function(None, 0)
    rows = np.empty((count, kind.columns) if kind.columns else count, kind.dtype)
    if count:
        function(rows.ctypes.data, count)
    return rows.view(np.recarray) if rows.dtype.names else rows


def room(kind, count):
    """Rows for a function to fill."""
    return np.zeros((count, kind.columns) if kind.columns else count, kind.dtype)
