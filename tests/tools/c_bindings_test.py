#!/usr/bin/env python3
"""The generator of capi: it binds what is added to the headers, in C and in Python, and refuses what it does not know."""

import ast
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


class Generator(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        shutil.copytree(ROOT / "include", self.folder / "include")

    def tearDown(self):
        shutil.rmtree(self.folder)

    def add(self, header, mark, text):
        path = self.folder / "include" / "gyre" / header
        old = path.read_text(encoding="utf-8")
        self.assertIn(mark, old)
        path.write_text(old.replace(mark, mark + text, 1), encoding="utf-8")

    def run_generator(self):
        outputs = {name: self.folder / name for name in ("header", "source", "python", "stubs", "symbols")}
        done = subprocess.run([sys.executable, str(ROOT / "capi" / "generate.py"), "--include", str(self.folder / "include"),
                               *[part for name, path in outputs.items() for part in (f"--{name}", str(path))]],
                              capture_output=True, text=True, check=False)
        if done.returncode == 0:
            self.texts = {name: path.read_text(encoding="utf-8") for name, path in outputs.items()}
            for name in ("python", "stubs"):
                ast.parse(self.texts[name])
        return done

    def test_what_is_added_goes_everywhere(self):
        self.add("world.h", "  bool step(float seconds);\n", "  // Waves a hand.\n  bool wave(BodyId body, const Material& material, float strength = 2.0f);\n")
        self.add("defs.h", "  float gravity_scale = 1.0f;\n", "  std::optional<Vec3> wind{};  // m/s, felt\n")
        done = self.run_generator()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("/* Waves a hand. */\nGYRE_C_API bool gyre_world_wave(GyreWorld* world, GyreBodyId body, const GyreMaterial* material, "
                      "float strength) GYRE_C_NOEXCEPT;", self.texts["header"])
        self.assertIn("  bool has_wind;", self.texts["header"])
        self.assertIn("gyre_world_wave;", self.texts["symbols"])
        self.assertIn("if (in.has_wind) copy(in.wind, out.wind.emplace());", self.texts["source"])
        self.assertIn("take_definition(material, material_in, \"GyreMaterial\")", self.texts["source"])
        self.assertIn("def wave(self, body, material=None, strength=2.0, **fields):", self.texts["python"])
        self.assertIn("'wind': Optional(VEC3)", self.texts["python"])
        self.assertIn("def wave(self, body: BodyId | int | None, material: ", self.texts["stubs"])

    def test_an_unknown_type_is_refused_by_name(self):
        self.add("world.h", "  bool step(float seconds);\n", "  bool puzzle(std::complex<float> value);\n")
        done = self.run_generator()
        self.assertEqual(done.returncode, 1)
        self.assertIn("complex<float>", done.stderr)

    def test_two_functions_of_one_name_are_refused(self):
        self.add("world.h", "  bool step(float seconds);\n", "  bool step(int seconds);\n")
        done = self.run_generator()
        self.assertEqual(done.returncode, 1)
        self.assertIn("gyre_world_step", done.stderr)


if __name__ == "__main__":
    unittest.main()
