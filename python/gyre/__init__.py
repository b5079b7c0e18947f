"""Gyre, a physics engine: rigid bodies of any shape, joints, ropes, cloths, solids, gases and liquids.

    import gyre

    world = gyre.World.create()
    world.add_body(type="fixed", shapes=gyre.Plane())
    crate = world.add_body(pose=(0, 5, 0), shapes=gyre.Box())
    for _ in range(120):
        world.step(1 / 60)
    print(world.pose(crate).position)   # the crate lies on the ground

Names and comments are those of the C++ interface. SI units, y up, quaternions are x y z w. docs/python.md is the guide.
"""

from ._api import *
from ._api import __all__ as _api_names
from ._batch import Action, Batch, Channel, Draw, Drawn, Reading, Space, VectorEnv
from ._library import library as _library
from ._runtime import GyreError, Id
from ._render import render
from ._scenes import Scene, load_scene, read_scene, scene_names
from . import _world as _  # gives World and others their constructors

__version__ = _library.gyre_version().decode()
__all__ = [*_api_names, "Action", "Batch", "Channel", "Draw", "Drawn", "GyreError", "Id", "Reading", "Scene", "Space", "VectorEnv", "load_scene", "read_scene", "render",
           "scene_names"]
