"""The program `gyre`, for pictures and for files of other programs."""

import os
import shutil
import subprocess
from pathlib import Path

from ._library import HERE
from ._runtime import GyreError


def program(purpose):
    """The gyre program: named by the environment, in the build folder around the package, beside the library, or on the path."""
    named = os.environ.get("GYRE_PROGRAM")
    for path in [Path(named)] if named else [folder / "bin" / "gyre" for folder in HERE.parents]:
        if path.is_file():
            return str(path)
    found = shutil.which("gyre")
    if found is None:
        raise GyreError(f"{purpose} needs the gyre program; set GYRE_PROGRAM to its path, or put it on the PATH")
    return found


def run_program(command):
    """Runs a command of gyre; its messages become the error."""
    ran = subprocess.run(command, capture_output=True, text=True, check=False)
    if ran.returncode != 0:
        raise GyreError(f"gyre {command[1]}: {ran.stderr.strip()}")
