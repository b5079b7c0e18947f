#!/usr/bin/env python3
"""Shows that each of the checks can fail: a small tree with one fault each, and the same tree without it."""

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOLS = Path(__file__).resolve().parent.parent.parent / "tools"


class Tree(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp(prefix="gyre-check-"))
        self.addCleanup(shutil.rmtree, self.root)
        shutil.copytree(TOOLS, self.root / "tools", ignore=shutil.ignore_patterns("__pycache__"))
        self.write("include/gyre/math.h", "#pragma once\n#include <cmath>\n")
        self.write("include/gyre/world.h", "#pragma once\n#include <gyre/math.h>\n")
        self.write("src/geometry/distance/gjk.h", "#pragma once\n#include <gyre/math.h>\n")
        self.write("src/solver/rows/row.cpp", '#include "geometry/distance/gjk.h"\n')
        self.write("src/world/world.cpp", '#include <gyre/world.h>\n#include "geometry/distance/gjk.h"\n')

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def run_check(self, name):
        done = subprocess.run([sys.executable, str(self.root / "tools" / f"check_{name}.py")], capture_output=True,
                              text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def assert_fails(self, name, expected):
        code, output = self.run_check(name)
        self.assertEqual(code, 1, output)
        self.assertIn(expected, output)

    def test_clean_tree_passes(self):
        for name in ("layers", "words", "size"):
            code, output = self.run_check(name)
            self.assertEqual(code, 0, output)

    def test_upward_include(self):
        self.write("src/geometry/distance/gjk.cpp", '#include "solver/rows/row.h"\n')
        self.write("src/solver/rows/row.h", "#pragma once\n")
        self.assert_fails("layers", "'geometry' must not know 'solver'")

    def test_siblings_do_not_meet(self):
        self.write("src/collision/broadphase/proxy.cpp", '#include "solver/rows/row.h"\n')
        self.write("src/solver/rows/row.h", "#pragma once\n")
        self.assert_fails("layers", "'collision' must not know 'solver'")

    def test_world_header_below_world(self):
        self.write("src/solver/rows/row.cpp", "#include <gyre/world.h>\n")
        self.assert_fails("layers", "may include this public header")

    def test_public_header_includes_internal(self):
        self.write("include/gyre/world.h", '#include "../../src/geometry/distance/gjk.h"\n')
        self.assert_fails("layers", "public headers include nothing but")

    def test_heavy_standard_header(self):
        self.write("src/geometry/distance/gjk.h", "#pragma once\n#include <functional>\n")
        self.assert_fails("layers", "too heavy")

    def test_example_reaches_inside(self):
        self.write("examples/hello.cpp", '#include "geometry/distance/gjk.h"\n')
        self.assert_fails("layers", "'examples' must not include 'src'")

    def test_cycle_in_one_folder(self):
        self.write("src/geometry/distance/gjk.h", '#pragma once\n#include "geometry/manifold/clip.h"\n')
        self.write("src/geometry/manifold/clip.h", '#pragma once\n#include "geometry/distance/gjk.h"\n')
        self.assert_fails("layers", "include cycle")

    def test_unknown_folder(self):
        self.write("src/misc/thing.cpp", "\n")
        self.assert_fails("layers", "not in the table")

    def test_upward_include_between_rooms(self):
        self.write("src/geometry/manifold/clip.h", "#pragma once\n")
        self.write("src/geometry/distance/gjk.cpp", '#include "geometry/manifold/clip.h"\n')
        self.assert_fails("layers", "'geometry/distance' must not know 'geometry/manifold'")

    def test_unknown_room(self):
        self.write("src/geometry/stray.cpp", "\n")
        self.assert_fails("layers", "its room is not in the table of rooms of 'geometry'")

    def test_full_room(self):
        for i in range(40):
            self.write(f"src/geometry/distance/unit_{i}.h", "#pragma once\n")
        self.assert_fails("layers", "41 files, more than 40")

    def test_words(self):
        for code in ("float f(float x) { return std::sin(x); }", "float f(float x) { return sinf(x); }",
                     "void f() { std::sort(a, b); }", "std::unordered_map<int, int> m;", "int x = rand();",
                     "auto y = _mm256_fmadd_ps(a, b, c);", "auto y = _mm_rsqrt_ps(a);", "float z = __builtin_fmaf(a, b, c);",
                     "auto y = vfmaq_f32(a, b, c);", "std::atomic<float> sum;", "// TODO: finish", "int x;  // FIXME"):
            with self.subTest(code=code):
                self.write("src/solver/rows/row.cpp", code + "\n")
                self.assert_fails("words", "row.cpp:1")

    def test_words_that_are_fine(self):
        for code in ("float f(float x) { return std::sqrt(x); }", "// std::sort would not do here",
                     'const char* s = "std::sin(x)";', "float f(float x) { return gyre::sin(x) + trig.exp(x); }",
                     "int x = operand();", "std::sort(a, b);  // word-ok: all keys differ",
                     "// word-ok: the keys are all different\nstd::sort(a, b);"):
            with self.subTest(code=code):
                self.write("src/solver/rows/row.cpp", code + "\n")
                code_out, output = self.run_check("words")
                self.assertEqual(code_out, 0, output)

    def test_old_names(self):
        for code in ("struct LinkageNode {};", "void hide_seams();", "struct Batch { int linkages; };", "constexpr int kMostSides = 4;",
                     "bool whirls = false;", "void f() { hurry(1); }", "int look_anew_count;", "enum class Kind { kLeast };"):
            with self.subTest(code=code):
                self.write("src/solver/row.cpp", code + "\n")
                self.assert_fails("words", "row.cpp:1")

    def test_old_name_of_a_file(self):
        self.write("src/solver/linkage_axes.h", "#pragma once\n")
        self.assert_fails("words", "linkage_axes.h: the name of the file has 'linkage': use articulation")

    def test_old_name_in_a_public_header(self):
        self.write("include/gyre/math.h", "#pragma once\nstruct BodyLook {};\n")
        self.assert_fails("words", "math.h:2: the name 'BodyLook' has 'body_look': use collision_body")

    def test_names_that_are_fine(self):
        for code in ("// a linkage of four bars", 'const char* s = "linkage";', "bool is_seamless;", "int most = kMax;", "void look();",
                     "struct Articulation {};", "int almost;", "int linkage;  // word-ok: the name of a scene"):
            with self.subTest(code=code):
                self.write("src/solver/row.cpp", code + "\n")
                code_out, output = self.run_check("words")
                self.assertEqual(code_out, 0, output)

    def test_test_namespaces(self):
        self.write("src/solver/row_test.cpp", "namespace gyre {\n}  // namespace gyre\n")
        self.assert_fails("words", "row_test.cpp: no namespace gyre::row_test")
        self.write("src/solver/row_test.cpp", "namespace gyre::row_test {\n}  // namespace gyre::row_test\n")
        code_out, output = self.run_check("words")
        self.assertEqual(code_out, 0, output)

    def test_size(self):
        self.write("src/solver/rows/row.cpp", "\n" * 601)
        self.assert_fails("size", "601 lines")

    def test_long_function_is_named(self):
        self.write("src/solver/rows/row.cpp", "void f(int a,\n       int b) {\n" + "  g();\n" * 90 + "}\n")
        code, output = self.run_check("size")
        self.assertEqual(code, 0, output)
        self.assertIn("row.cpp:1: a function of 93 lines", output)

    def write_decision(self, page, readme="| [joints](joints.md) | How soft? |\n"):
        self.write("docs/decisions/joints.md", page)
        self.write("docs/decisions/README.md", readme)

    def test_decisions(self):
        abstract = "".join(f"- **{label}:** it is one sentence.\n" for label in
                           ("Problem", "Rule", "Constants", "Figure", "Limit"))
        good = "# How soft?\n\n" + abstract + "\n## Why it matters\n"
        self.write_decision(good)
        code, output = self.run_check("docs")
        self.assertEqual(code, 0, output)
        for page, fault in ((good.replace("?", ""), "the title is no question"),
                            (good.replace("- **Figure:** it is one sentence.\n", ""), "five lines must follow"),
                            (good.replace("Figure", "Picture"), "line 6 must begin with '- **Figure:**'"),
                            (good.replace("sentence.\n\n", "sentence\n\n"), "line 7 must begin with '- **Limit:**'")):
            with self.subTest(fault=fault):
                self.write_decision(page)
                self.assert_fails("docs", fault)
        self.write_decision(good, "No list.\n")
        self.assert_fails("docs", "lists it 0 times")

    def run_list(self, name, *options):
        done = subprocess.run([sys.executable, str(self.root / "tools" / f"list_{name}.py"), *options], capture_output=True,
                              text=True, check=False)
        return done.returncode, done.stdout + done.stderr

    def list_units(self, *options):
        return self.run_list("units", *options)

    def write_constants(self):
        self.write("docs/tuning.md", "<!-- constants: written by tools/list_constants.py -->\n<!-- end of constants -->\n")
        self.write("src/rigid/sleep/island.h", "// Time until a body sleeps.\nconstexpr float kTimeToSleep = 0.5f;  // s\n\n"
                                               "// Shares of the speed of a fall.\nconstexpr int kRounds = 2;\n"
                                               "constexpr double kSlow = 0.1, kFast = 2.0 * kSlow;\n")

    def test_constants_are_listed(self):
        self.write_constants()
        code, output = self.run_list("constants", "--check")
        self.assertEqual(code, 1, output)
        self.assertIn("run python3 tools/list_constants.py", output)
        code, output = self.run_list("constants")
        self.assertEqual(code, 0, output)
        page = (self.root / "docs" / "tuning.md").read_text(encoding="utf-8")
        self.assertIn("| `kTimeToSleep` | `0.5` | Time until a body sleeps. s | island.h |", page)
        self.assertIn("| `kFast` | `2.0 * kSlow` | Shares of the speed of a fall. | island.h |", page)
        self.assertNotIn("kRounds", page)
        code, output = self.run_list("constants", "--check")
        self.assertEqual(code, 0, output)

    def test_constants_without_meaning_or_twice(self):
        self.write_constants()
        self.write("src/soft/store/soft.h", "#pragma once\n\nconstexpr float kStiff = 2.0f;\n")
        code, output = self.run_list("constants")
        self.assertEqual(code, 1, output)
        self.assertIn("src/soft/store/soft.h: kStiff has no comment", output)
        self.write("src/soft/store/soft.h", "constexpr float kTimeToSleep = 0.5f;  // s\n")
        code, output = self.run_list("constants")
        self.assertEqual(code, 1, output)
        self.assertIn("kTimeToSleep = 0.5 is defined in src/rigid/sleep/island.h too", output)

    def write_units(self):
        """A tree of two units in rooms, with a page that lists them."""
        self.write("docs/architecture.md", "Before.\n<!-- units: written by tools/list_units.py -->\n"
                                           "<!-- end of units -->\nAfter.\n")
        self.write("src/geometry/distance/gjk.h", "// Distance of two shapes (E. Gilbert). In: two shapes.\n\n#pragma once\n")
        self.write("src/geometry/distance/gjk.cpp", "// The source says something else.\n")
        self.write("src/geometry/distance/gjk_test.cpp", "int main() {}\n")
        self.write("src/solver/rows/row.cpp", "// Scalar rows.\n// They are few.\n")
        self.write("src/world/world.cpp", "// The world.\n")

    def test_units_are_listed(self):
        self.write_units()
        code, output = self.list_units()
        self.assertEqual(code, 0, output)
        page = (self.root / "docs" / "architecture.md").read_text(encoding="utf-8")
        self.assertIn("- `gjk`: Distance of two shapes (E. Gilbert).\n", page)
        self.assertIn("**src/solver/rows**\n\n- `row`: Scalar rows.\n", page)
        self.assertNotIn("gjk_test", page)
        self.assertTrue(page.startswith("Before.\n") and page.endswith("\nAfter.\n"), page)
        code, output = self.list_units("--check")
        self.assertEqual(code, 0, output)

    def test_units_out_of_date(self):
        self.write_units()
        self.list_units()
        for name, text in (("src/solver/rows/row.cpp", "// Rows of another kind.\n"),
                           ("src/solver/rows/friction_set.h", "// The friction disc.\n")):
            with self.subTest(name=name):
                self.write(name, text)
                code, output = self.list_units("--check")
                self.assertEqual(code, 1, output)
                self.assertIn("missing: - `", output)
                self.list_units()
        (self.root / "src/solver/rows/friction_set.h").unlink()
        code, output = self.list_units("--check")
        self.assertEqual(code, 1, output)
        self.assertIn("out of date: - `friction_set`", output)

    def test_unit_without_a_head(self):
        self.write_units()
        self.write("src/solver/rows/delassus.h", "#pragma once\n")
        code, output = self.list_units()
        self.assertEqual(code, 1, output)
        self.assertIn("src/solver/rows/delassus.h: no comment at its head", output)

    def test_page_without_markers(self):
        self.write_units()
        self.write("docs/architecture.md", "No list.\n")
        for options in ((), ("--check",)):
            code, output = self.list_units(*options)
            self.assertEqual(code, 1, output)
            self.assertIn("marker comments", output)


if __name__ == "__main__":
    unittest.main()
