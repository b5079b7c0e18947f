#!/usr/bin/env python3
"""The generator of web/bindings: it reads the real headers right, binds what is added, and refuses what it does not know."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
GENERATE = ROOT / "web" / "bindings" / "generate.py"


class Generator(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        shutil.copytree(ROOT / "include", self.folder / "include")
        self.world = self.folder / "include" / "gyre" / "world.h"

    def tearDown(self):
        shutil.rmtree(self.folder)

    def add(self, declaration):
        text = self.world.read_text(encoding="utf-8")
        mark = "  bool step(float seconds);\n"
        self.assertIn(mark, text)
        self.world.write_text(text.replace(mark, mark + declaration + "\n"), encoding="utf-8")

    def run_generator(self):
        done = subprocess.run(
            [sys.executable, str(GENERATE), "--include", str(self.folder / "include"), "--check", "--cpp", str(self.folder / "out.cpp"),
             "--typescript", str(self.folder / "out.ts")], capture_output=True, text=True, check=False)
        self.typescript = (self.folder / "out.ts").read_text(encoding="utf-8") if done.returncode == 0 else ""
        self.cpp = (self.folder / "out.cpp").read_text(encoding="utf-8") if done.returncode == 0 else ""
        return done

    def test_the_headers_as_they_are(self):
        done = self.run_generator()
        self.assertEqual(done.returncode, 0, done.stderr)
        for line in ("setVelocity(body: BodyId, linear: VectorInput, angular: VectorInput): void {", "hash(): bigint {",
                     "export const JointKind = {", "linearVelocity(body: BodyId): Vec3;", "  contacts(): ContactPointColumns {"):
            self.assertIn(line, self.typescript)
        self.assertIn("static_assert(int(JointKind::distance) == 4);", self.cpp)

    def test_each_kind_of_joint_has_its_own_fields(self):
        self.assertEqual(self.run_generator().returncode, 0)
        for line in ("  | ({ kind: typeof JointKind.hinge } & HingeDef)", "addJoint(joint: JointDef): JointId {",
                     "    case JointKind.rackAndPinion:\n      w.number(9, 'kind');\n      return writeRackAndPinionDef(w, given);",
                     "const keysOfBallDef = new Set(['a', 'b', 'anchor', 'friction', 'breakForce', 'breakTorque', 'collideConnected', 'kind']);",
                     "const keysOfMotor = new Set(['targetVelocity', "):
            self.assertIn(line, self.typescript)
        self.assertIn("    case 1:\n      get(call, out.emplace<HingeDef>());", self.cpp)

    def test_a_variant_needs_a_kind_for_each_of_its_structs(self):
        joints = self.folder / "include" / "gyre" / "joints.h"
        text = joints.read_text(encoding="utf-8")
        mark = "using JointDef = std::variant<BallDef, "
        self.assertIn(mark, text)
        joints.write_text(text.replace(mark, mark + "Motor, "), encoding="utf-8")
        done = self.run_generator()
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("JointDef", done.stderr)

    def test_a_new_function_is_bound_with_its_comment(self):
        self.add("  // Blows at the body, in N.\n  bool blow_at(BodyId body, Vec3 wind, float strength = 1.0f);")
        self.assertEqual(self.run_generator().returncode, 0)
        self.assertIn("blowAt(body: BodyId, wind: VectorInput, strength?: number): void {", self.typescript)
        self.assertIn("Blows at the body, in N.", self.typescript)
        self.assertIn("float strength = 1.0f;", self.cpp)

    def test_an_unknown_type_is_named(self):
        self.add("  bool call_me(std::function<void()> back);")
        done = self.run_generator()
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("World::call_me", done.stderr)
        self.assertIn("function<void()>", done.stderr)

    def test_a_new_header_is_not_overlooked(self):
        (self.folder / "include" / "gyre" / "weather.h").write_text("#pragma once\nnamespace gyre {\nvoid rain();\n}\n", encoding="utf-8")
        done = self.run_generator()
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("weather", done.stderr)

    def test_overloads_need_names(self):
        self.add("  bool step(float seconds, int times);")
        done = self.run_generator()
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("World::step", done.stderr)


if __name__ == "__main__":
    unittest.main()
