#!/usr/bin/env python3
"""The text of the guide: its links, the code that it names, and its blocks of scenes, shell and Python.

    text_test.py --gyre PROGRAM [--python FOLDER]     FOLDER holds the Python package; without it, or without NumPy, those blocks are skipped

Blocks of C++ are the program guide_blocks (tests/guide/CMakeLists.txt). Needs no builder of the site.
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "tools" / "guide"))
import blocks  # noqa: E402
import lines  # noqa: E402
import scene_reference  # noqa: E402

OPTIONS = argparse.Namespace(gyre="", python="")
LINK = re.compile(r"\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^()\s]+)\)")
LINKED_PAGES = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "web/course/README.md")]
LINKED_PAGES += sorted((ROOT / "docs").rglob("*.md"))


def without_code(text):
    return re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)


def anchors_of(page):
    """The anchors of the headings of a page, as GitHub and MyST make them."""
    found = set()
    for heading in re.findall(r"^#+ (.+)$", without_code(page.read_text(encoding="utf-8")), re.M):
        plain = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
        found.add(re.sub(r"[^\w\- ]", "", plain).replace(" ", "-"))
    return found


def run(arguments, folder):
    return subprocess.run(arguments, cwd=folder, capture_output=True, text=True, timeout=120, check=False)


class Text(unittest.TestCase):
    def test_links_lead_somewhere(self):
        faults = []
        for page in LINKED_PAGES:
            base = ROOT if page.parent.name == "site" else page.parent
            for words, address in LINK.findall(without_code(page.read_text(encoding="utf-8"))):
                if re.match(r"[a-z]+:", address):
                    continue
                path, _, anchor = address.partition("#")
                target = (base / path).resolve() if path else page
                if target.is_relative_to(ROOT / "docs" / "reference"):
                    continue  # generated; the test of the site looks there
                if not target.exists():
                    faults.append(f"{page.name}: {address} does not exist")
                elif anchor and target.suffix == ".md" and anchor not in anchors_of(target):
                    faults.append(f"{page.name}: {address}: no such heading")
                elif (name := re.fullmatch(r"`([\w:]+)`", words)) and target.suffix in (".cpp", ".h"):
                    if not lines.line_of(target.read_text(encoding="utf-8"), name.group(1)):
                        faults.append(f"{page.name}: {path} has no {name.group(1)}")
        self.assertEqual(faults, [])

    def test_every_page_is_in_the_table_of_contents(self):
        index = (ROOT / "docs" / "site" / "index.md").read_text(encoding="utf-8")
        for page in blocks.pages():
            self.assertIn(str(page.relative_to(ROOT).with_suffix("")) + "\n", index)

    def test_every_member_of_a_scene_has_an_example(self):
        schema = scene_reference.Schema(ROOT / "scenes" / "scene.schema.json")
        self.assertEqual(scene_reference.missing(schema, scene_reference.harvest(schema)), [],
                         "add a scene with these members to docs/guide/scenes")

    def test_names_of_the_engine_exist(self):
        headers = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "include").rglob("*.h"))
        page = (ROOT / "docs" / "guide" / "other_engines.md").read_text(encoding="utf-8")
        faults = []
        for line in page.split("## What differs")[0].split("## Calls"):
            for row in re.findall(r"^\| (.+?) \|", line, re.M):
                faults += [name for name in re.findall(r"`(\w+)", row) if not re.search(rf"\b{name}\b", headers)]
        self.assertEqual(faults, [])


class Blocks(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.work = Path(self.folder.name)
        (self.work / "scenes").symlink_to(ROOT / "scenes")

    def test_example_scenes_open(self):
        for scene in sorted((ROOT / "docs" / "guide" / "scenes").glob("*.gyre.json")):
            result = run([OPTIONS.gyre, "simulate", scene, "--duration", "0.05"], self.work)
            self.assertEqual((result.returncode, result.stderr), (0, ""), scene.name)

    def test_shell_blocks_run(self):
        for page in blocks.pages():
            for _, text, before in blocks.blocks_of(page, "json"):
                if name := re.search(r"`([\w.]+\.gyre\.json)`", before):
                    (self.work / name.group(1)).write_text(text, encoding="utf-8")
            for line, text, _ in blocks.blocks_of(page, "sh"):
                for command in text.strip().split("\n"):
                    words = command.split("#")[0].split()
                    self.assertEqual(words[0], "gyre", f"{page.name}, line {line}")
                    result = run([OPTIONS.gyre, *words[1:]], self.work)
                    self.assertEqual(result.returncode, 0, f"{page.name}: {command}\n{result.stderr}")

    def test_python_blocks_run(self):
        environment = {**os.environ, "PYTHONPATH": OPTIONS.python, "GYRE_SCENES": str(ROOT / "scenes")}
        # The package has tests of its own, so one that does not load is not this test's concern.
        loads = subprocess.run([sys.executable, "-c", "import numpy, gyre"], env=environment, capture_output=True, check=False).returncode == 0
        if not OPTIONS.python or not loads:
            self.skipTest("no Python package, or no NumPy")
        for page in blocks.pages():
            texts = [text for _, text, _ in blocks.blocks_of(page, "python")]
            if texts:
                program = self.work / f"{page.stem}.py"
                program.write_text("\n".join(texts), encoding="utf-8")
                result = subprocess.run([sys.executable, program], cwd=self.work, env=environment, capture_output=True, text=True, timeout=120, check=False)
                self.assertEqual(result.returncode, 0, f"{page.name}\n{result.stderr}")

    def test_blocks_are_of_known_languages(self):
        known = {"cpp", "python", "json", "sh", "cmake"}
        for page in blocks.pages():
            for language in re.findall(r"^```(\w*)\n(?:.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S):
                self.assertIn(language, known, f"{page.name}: no test runs such a block")


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--gyre", default=str(ROOT / "build/release/bin/gyre"))
    parser.add_argument("--python", default="")
    OPTIONS, rest = parser.parse_known_args()
    unittest.main(argv=[sys.argv[0], *rest])
