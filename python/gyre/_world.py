"""What the classes of _api.py have besides the functions of C++: constructors, arrays of several answers, recordings."""

import ctypes

import numpy as np

from . import _api
from ._api import BodyColumns, Recorder, RecordOptions, Replay, Rollback, SoftVertices, World
from ._runtime import COUNT, DVEC3, POINTER, U32, VEC3, Rows, call, definition, done, room


def _steal(self, made):
    self.handle, self.owner, made.handle = made.handle, None, None


def _world_init(self, definition=None, **fields):
    """A new, empty world. Fields are those of WorldDef: gravity, threads, sleeping, ..."""
    _steal(self, World.create(definition, **fields))


def _rollback_init(self, capacity):
    """A ring of the last `capacity` states."""
    _steal(self, Rollback.create(capacity))


World.__init__ = _world_init
Rollback.__init__ = _rollback_init

_particles = call("gyre_world_liquid_particles", COUNT, POINTER, ctypes.c_uint64, POINTER, COUNT, POINTER, COUNT)
_surface = call("gyre_world_liquid_surface", _api.FluidSurfaceSize, POINTER, ctypes.c_uint64, POINTER, COUNT, POINTER, COUNT)
_sample = call("gyre_world_sample_velocity", None, POINTER, ctypes.c_uint64, POINTER, COUNT, POINTER, COUNT)


def liquid_particles(self, fluid):
    """The particles of a liquid: positions (m) and velocities (m/s)."""
    count = _particles(self.handle, int(fluid), None, 0, None, 0)
    positions, velocities = room(DVEC3, count), room(VEC3, count)
    _particles(self.handle, int(fluid), positions.ctypes.data, count, velocities.ctypes.data, count)
    return positions, velocities


def liquid_surface(self, fluid):
    """The surface of a liquid as triangles, counter-clockwise seen from outside: vertices (m), and three indices a triangle."""
    size = _surface(self.handle, int(fluid), None, 0, None, 0)
    vertices, indices = room(VEC3, size.vertices), room(U32, size.indices)
    _surface(self.handle, int(fluid), vertices.ctypes.data, len(vertices), indices.ctypes.data, len(indices))
    return vertices, indices.reshape(-1, 3)


def sample_velocity(self, fluid, points):
    """The velocity (m/s) of a fluid at many points."""
    kept, at, count = Rows(DVEC3).memory(points)
    out = room(VEC3, count)
    _sample(self.handle, int(fluid), at, count, out.ctypes.data, count)
    return out


def fluid_grid(self, fluid, field):
    """A field of cell centres as an array by z, y, x."""
    nx, ny, nz = self.fluid_info(fluid).cells
    return self.fluid_field(fluid, field).reshape(nz, ny, nx)


World.liquid_particles, World.liquid_surface, World.sample_velocity = liquid_particles, liquid_surface, sample_velocity
World.fluid_grid = fluid_grid

# ------------------------------------------------------------------------------------------------------- columns

BodyColumns.positions = property(lambda self: _column(self.poses, "position"), doc="m, 3 a body, in place")
BodyColumns.orientations = property(lambda self: _column(self.poses, "orientation"), doc="x y z w, 4 a body, in place")
SoftVertices.positions = property(lambda self: np.stack([self.x, self.y, self.z], 1), doc="m, 3 a vertex: a copy")
SoftVertices.velocities = property(lambda self: np.stack([self.vx, self.vy, self.vz], 1), doc="m/s, 3 a vertex: a copy")


def _column(rows, name):
    return np.asarray(rows.view(np.ndarray)[name]) if rows.dtype.names else np.empty((0, 3 if name == "position" else 4))


# ---------------------------------------------------------------------------------------------------- recordings

_Write = ctypes.CFUNCTYPE(ctypes.c_bool, POINTER, POINTER, COUNT)
_record = call("gyre_recorder_create", POINTER, POINTER, _Write, POINTER, POINTER)


def record(self, path=None, **options):
    """Records the world until the recorder is finished: to a file, or without a path to memory. Options are those of RecordOptions.

        with world.record("run.gyrec"):
            world.step(1 / 60)
    """
    chunks = []
    file = open(path, "wb") if path is not None else None

    def write(_, at, count):
        try:
            (file.write if file is not None else chunks.append)(ctypes.string_at(at, count))
            return True
        except OSError:
            return False

    function = _Write(write)
    try:
        handle = done(_record(self.handle, function, None, ctypes.byref(definition(RecordOptions, None, options))))
    except Exception:
        if file is not None:
            file.close()
        raise
    recorder = Recorder.from_handle(handle)
    recorder.world, recorder.function, recorder.file, recorder.chunks = self, function, file, chunks
    return recorder


_finish = Recorder.finish


def finish(self):
    """Writes the end. Returns the bytes of a recording in memory, True of one in a file; False if not everything could be written."""
    whole = _finish(self)
    if self.file is not None:
        self.file.close()
        return whole
    return b"".join(self.chunks) if whole else False


World.record, Recorder.finish = record, finish
Recorder.__enter__ = lambda self: self
Recorder.__exit__ = lambda self, *_: self.finish() and None


def _play(self, matches=True):
    """Plays the rest. True if every hash is the recorded one."""
    while True:
        going, same = self.step()
        if not going:
            return True
        if matches and not same:
            return False


Replay.play = _play
