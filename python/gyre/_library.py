"""Finds and opens libgyre.so, the engine behind this package."""

import ctypes
import os
from pathlib import Path

HERE = Path(os.path.abspath(__file__)).parent  # not resolved: in a build folder these files are links


def candidates():
    """Where the library may be: named by the environment, inside the package, in the build folder around it, where the system looks."""
    named = os.environ.get("GYRE_LIBRARY")
    if named:
        return [named]
    names = ("libgyre.so", "libgyre.dylib", "gyre.dll", "libgyre.so.0.1")
    folders = [HERE, HERE.parents[1] / "lib", *HERE.parents]
    found = [str(folder / name) for folder in folders for name in names if (folder / name).exists()]
    return found + ["libgyre.so.0.1", "libgyre.so"]


def open_library():
    reasons = []
    for name in candidates():
        try:
            return ctypes.CDLL(name)
        except OSError as error:
            reasons.append(str(error))
    raise ImportError("the engine's library was not found; set GYRE_LIBRARY to the path of libgyre.so\n  " + "\n  ".join(reasons))


library = open_library()
library.gyre_last_error.restype = ctypes.c_char_p
library.gyre_last_error_code.restype = ctypes.c_uint8
library.gyre_version.restype = ctypes.c_char_p
