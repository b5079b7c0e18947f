"""Scene files: bodies, joints and fluids with names, in a world."""

import ctypes
import os
import tempfile
from pathlib import Path

from ._api import BodyId, FluidId, JointId, SoftId, World
from ._library import HERE
from ._program import program, run_program
from ._runtime import COUNT, POINTER, Handle, call, done


def _folders():
    named = os.environ.get("GYRE_SCENES")
    folders = [Path(named)] if named else []
    return folders + [folder / "share" / "gyre" / "scenes" for folder in HERE.parents] + [HERE / "scenes"]


def scene_names():
    """The names of the scenes that come with Gyre, for load_scene()."""
    for folder in _folders():
        if folder.is_dir():
            return sorted(str(path.relative_to(folder)).removesuffix(".gyre.json") for path in folder.rglob("*.gyre.json"))
    return []


def scene_path(name):
    """The file of a scene, from its path or the name of one that comes with Gyre."""
    path = Path(name)
    if path.exists():
        return path
    for folder in _folders():
        for found in (folder / path, folder / f"{name}.gyre.json"):
            if found.is_file():
                return found
    raise FileNotFoundError(f"there is no scene '{name}': neither a file, nor one of gyre.scene_names()")


class Scene(Handle):
    """A scene in its world: `world`, names of bodies and joints, and `step()`, which applies the timed forces of the file."""

    _destroy = call("gyre_scene_destroy", None, POINTER)
    _load = call("gyre_scene_load", POINTER, ctypes.c_char_p, ctypes.c_int32, ctypes.c_int32)
    _read = call("gyre_scene_read", POINTER, ctypes.c_char_p, COUNT, ctypes.c_int32, ctypes.c_int32)
    _world = call("gyre_scene_world", POINTER, POINTER)
    _name = call("gyre_scene_name", ctypes.c_char_p, POINTER)
    _time_step = call("gyre_scene_time_step", ctypes.c_double, POINTER)
    _step = call("gyre_scene_step", ctypes.c_bool, POINTER)
    _write = call("gyre_scene_write", ctypes.c_char_p, POINTER, POINTER)

    @property
    def world(self):
        """The world; it lives as long as the scene."""
        return World.from_handle(self._world(self.handle), self)

    @property
    def name(self):
        return self._name(self.handle).decode()

    @property
    def time_step(self):
        """s, of one step"""
        return self._time_step(self.handle)

    def step(self):
        """Applies the forces of this moment and steps the world by the time step of the scene."""
        done(self._step(self.handle))

    def run(self, seconds):
        """Steps for so many seconds."""
        for _ in range(round(seconds / self.time_step)):
            self.step()

    def _named(self, what, cls):
        count = COUNT()
        at = call(f"gyre_scene_{what}s" if what != "body" else "gyre_scene_bodies", POINTER, POINTER, POINTER)(self.handle, ctypes.byref(count))
        name = call(f"gyre_scene_{what}_name", ctypes.c_char_p, POINTER, COUNT)
        ids = (ctypes.c_uint64 * count.value).from_address(at) if count.value else []
        found = {}
        for i, number in enumerate(ids):
            found.setdefault(name(self.handle, i).decode() or i, cls(number))
        return found

    @property
    def bodies(self):
        """Ids by name; of those without a name by their place in the file."""
        return self._named("body", BodyId)

    @property
    def joints(self):
        return self._named("joint", JointId)

    @property
    def softs(self):
        """Ropes, cloths and soft bodies."""
        return self._named("soft", SoftId)

    @property
    def fluids(self):
        """Gases and liquids."""
        return self._named("fluid", FluidId)

    def write(self):
        """The scene as it stands now, as the text of a scene file."""
        return self._write(self.handle, None).decode()


def load_scene(name, threads=1, simd_width=0, **options):
    """Loads a scene file, or one of the scenes that come with Gyre by its name: load_scene("newtons_cradle").

    A robot (.urdf, .xml, .mjcf) or glTF file (.gltf, .glb) is converted by the program `gyre`. Options are then those of `gyre convert`,
    with underscores: load_scene("robot.urdf", base="free", package=["arms=/robots/arms"], keep_fixed=True).
    """
    path = scene_path(name)
    if Path(path).suffix.lower() not in (".urdf", ".xml", ".mjcf", ".gltf", ".glb"):
        if options:
            raise TypeError(f"load_scene() takes {', '.join(options)} of robots and glTF files only")
        return Scene.from_handle(done(Scene._load(os.fsencode(path), threads, simd_width)))
    with tempfile.TemporaryDirectory() as folder:
        converted = os.path.join(folder, "converted.gyre.json")
        command = [program("load_scene() of a robot or glTF file"), "convert", str(path), converted]
        for option, value in options.items():
            word = "--" + option.replace("_", "-")
            if value is True:
                command.append(word)
            elif value is not False:
                for each in [value] if isinstance(value, str) else value:
                    command += [word, str(each)]
        run_program(command)
        return Scene.from_handle(done(Scene._load(os.fsencode(converted), threads, simd_width)))


def read_scene(text, threads=1, simd_width=0):
    """The same for the text of a scene file."""
    data = text.encode() if isinstance(text, str) else bytes(text)
    return Scene.from_handle(done(Scene._read(data, len(data), threads, simd_width)))
