"""Packs the engine, the module that is made from its headers, and the scenes into a wheel for every Python 3.

GYRE_BUILD may name a build folder that has the library already; without it, CMake builds one in build/wheel.
"""

import os
import re
import shutil
import subprocess
import sysconfig
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

ROOT = Path(__file__).resolve().parent.parent


def built():
    """The build folder, with the library in it."""
    named = os.environ.get("GYRE_BUILD")
    if named:
        return Path(named)
    folder = ROOT / "build" / "wheel"
    off = [f"-DGYRE_BUILD_{part}=OFF" for part in ("TESTS", "APPS", "EXAMPLES", "PORTABLE")]
    subprocess.run(["cmake", "-S", ROOT, "-B", folder, "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_UNITY_BUILD=ON", "-DGYRE_BUILD_C=ON", *off],
                   check=True)
    subprocess.run(["cmake", "--build", folder, "--parallel", "--target", "gyre_c"], check=True)
    return folder


class BuildWithEngine(build_py):
    def run(self):
        super().run()
        target, folder = Path(self.build_lib) / "gyre", built()
        for file in ("_api.py", "__init__.pyi"):
            shutil.copy(folder / "python" / "gyre" / file, target / file)
        library = next(path for path in sorted((folder / "lib").iterdir()) if path.name in ("libgyre.so", "libgyre.dylib"))
        shutil.copy(library.resolve(), target / library.name)
        for scene in (ROOT / "scenes").rglob("*"):
            if scene.is_file():
                place = target / "scenes" / scene.relative_to(ROOT / "scenes")
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(scene, place)


class WithLibrary(Distribution):
    def has_ext_modules(self):
        return True


class AnyPython(bdist_wheel):
    """The library knows nothing of Python, so the wheel is for a platform, and for every version."""

    def get_tag(self):
        return "py3", "none", re.sub(r"[-.]", "_", sysconfig.get_platform())


version = re.search(r"VERSION (\d+\.\d+\.\d+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8").split("project(")[1]).group(1)
setup(version=version, distclass=WithLibrary, cmdclass={"build_py": BuildWithEngine, "bdist_wheel": AnyPython})
