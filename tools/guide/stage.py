#!/usr/bin/env python3
"""Prepares the sources of the guide's site in a folder: the pages of the repository, the generated reference, and links that work there.

    stage.py FOLDER OUTPUT STUBS

FOLDER gets what Sphinx reads: every Markdown page at its path in the repository. Links between pages stay. A link to any other file of the
repository becomes a link to a page with that file's text, in OUTPUT/source. A link whose text is a name in code, like
[`cook_hull`](../../src/geometry/hull/hull.cpp), leads to the line of that name. STUBS are the type stubs of the Python package.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound

import reference
import scene_reference
from lines import line_of

ROOT = Path(__file__).resolve().parent.parent.parent
# A fenced block, a link, or code in a line: whatever begins first. Only links are rewritten.
TOKEN = re.compile(r"^[ \t]*```.*?^[ \t]*```|(!?)\[((?:[^\[\]]|\[[^\[\]]*\])*)\]\(([^()\s]+)\)|(`+)[^`].*?\4", re.M | re.S)
PICTURES = (".png", ".gif", ".svg", ".webp", ".jpg")
LIVE = ROOT / "web" / "course" / "dist" / "live.js"
LARGEST = 400_000  # bytes of a file that is shown
# Differences between browsers without it, as far as Furo minds.
NORMALIZED = "html{line-height:1.15;-webkit-text-size-adjust:100%}body{margin:0}code,kbd,pre,samp{font-family:monospace,monospace;font-size:1em}"
KATEX = Path("/usr/share/javascript/katex")
RENDER = """;
addEventListener("DOMContentLoaded", () => {
  for (const element of document.querySelectorAll(".math")) {
    const [, mark, equation] = element.textContent.match(/^\\s*\\\\([([])([^]*)\\\\[)\\]]\\s*$/) ?? [];
    if (equation) katex.render(equation, element, {displayMode: mark === "[", throwOnError: false});
  }
});
"""

SOURCE_PAGE = """<!doctype html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width"><title>{title}</title>
<link rel="stylesheet" href="{up}_static/source.css"></head><body><p><a href="{up}index.html">Gyre</a> / <b>{title}</b></p>
{body}
<script>addEventListener("hashchange",mark);function mark(){{for(const e of document.querySelectorAll(".here"))e.classList.remove("here");
const a=document.getElementById(location.hash.slice(1));if(a)a.parentElement.classList.add("here")}}mark()</script></body></html>
"""


def is_page(path):
    """Pages of the site: all Markdown but that of packages' own folders."""
    relative = path.relative_to(ROOT)
    return path.suffix == ".md" and (relative.parts[0] in ("docs", "README.md", "CONTRIBUTING.md", "CHANGELOG.md")
                                     or str(relative) in ("web/gyre-physics/README.md", "web/viewer/README.md", "web/course/README.md"))


def pages():
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"], cwd=ROOT, capture_output=True, text=True, check=False)
    names = listed.stdout.split() if listed.returncode == 0 else [str(path.relative_to(ROOT)) for path in ROOT.rglob("*.md")]
    return sorted(ROOT / name for name in names if is_page(ROOT / name) and (ROOT / name).exists())


class Site:
    def __init__(self, folder, output):
        self.folder, self.output = folder, output
        self.shown = set()
        self.faults = []

    def source_link(self, page, target, name):
        """The address, seen from a page, of the page of a file's text."""
        depth = len(page.relative_to(ROOT).parts) - 1
        relative = target.relative_to(ROOT)
        self.shown.add(target)
        anchor = ""
        if name and target.is_file():
            line = line_of(target.read_text(encoding="utf-8", errors="replace"), name)
            if line == 0:
                self.faults.append(f"{page.relative_to(ROOT)}: {relative} has no {name}")
            anchor = f"#L-{line}"
        address = f"source/{relative}.html" if target.is_file() else f"source/{relative}/index.html"
        return "../" * depth + address + anchor

    def rewritten(self, page, text):
        def one(match):
            picture, words, address = match.group(1, 2, 3)
            if not address or re.match(r"[a-z]+:|#", address):
                return match.group(0)
            path, _, anchor = address.partition("#")
            target = (page.parent / path).resolve()
            if target.is_relative_to(ROOT / "docs" / "reference"):
                return match.group(0)  # generated
            if not target.is_relative_to(ROOT) or not target.exists():
                self.faults.append(f"{page.relative_to(ROOT)}: {address} does not exist")
                return match.group(0)
            if picture or target.suffix in PICTURES:
                place = self.folder / target.relative_to(ROOT)
                place.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(target, place)
                return match.group(0)
            if target.is_dir() and (target / "README.md").exists() and is_page(target / "README.md"):
                return f"[{words}]({path.rstrip('/')}/README.md{'#' + anchor if anchor else ''})"
            if target.is_file() and is_page(target):
                return match.group(0)
            code = re.fullmatch(r"`([\w:]+(?:\(\))?)`", words)
            name = code.group(1) if code and target.suffix in (".cpp", ".h", ".ts") else ""
            inside = re.sub(r"`([^`]*)`", r"<code>\1</code>", words)
            return f'<a class="gyre-file" href="{self.source_link(page, target, name)}">{inside}</a>'

        return TOKEN.sub(one, text)

    def live(self, page, text):
        """A live scene needs its script on the page, if that was built."""
        if not LIVE.exists():
            return text
        depth = len(page.relative_to(ROOT).parts) - 1
        script = f'<script defer src="{"../" * depth}_static/live.js"></script>'
        return re.sub(r'(<div data-lesson="\w+">.*?</div>)', rf"\1\n{script}", text, flags=re.S)

    def add(self, file, page=None):
        """A file as the page at its own path, or at another."""
        page = page or file
        text = self.live(page, self.rewritten(page, file.read_text(encoding="utf-8")))
        place = self.folder / page.relative_to(ROOT)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8")

    def show_sources(self):
        formatter = HtmlFormatter(linenos="inline", lineanchors="L", anchorlinenos=True)
        for path in sorted(self.shown):
            self.show(path, formatter)
        static = self.folder / "_static"
        static.mkdir(parents=True, exist_ok=True)
        (static / "source.css").write_text(
            "body{font:15px sans-serif;margin:1.5em}pre{line-height:1.45}a{color:#2f6bff;text-decoration:none}.linenos,.linenos a{color:#999}"
            ".here{background:#ffe9a8}@media(prefers-color-scheme:dark){body{background:#131416;color:#ddd}.here{background:#554a1c}}\n"
            + formatter.get_style_defs(".highlight"), encoding="utf-8")

    def show(self, path, formatter):
        relative = path.relative_to(ROOT)
        if path.is_dir():
            names = sorted(path.iterdir(), key=lambda one: (one.is_file(), one.name))
            tracked = [one for one in names if not one.name.startswith(".") and one.name not in ("node_modules", "dist", "build", "__pycache__")]
            for one in tracked:
                if one.is_file() and one not in self.shown:
                    self.show(one, formatter)
            rows = "".join(f'<li><a href="{one.name}.html">{one.name}</a></li>' if one.is_file() else f"<li>{one.name}/</li>" for one in tracked)
            place, body, up = self.output / "source" / relative / "index.html", f"<ul>{rows}</ul>", len(relative.parts) + 1
        else:
            data = path.read_bytes()
            text = data[:LARGEST].decode("utf-8", errors="replace") if b"\0" not in data[:4096] else f"({len(data)} bytes)"
            try:
                lexer = get_lexer_for_filename(path.name) if len(data) < LARGEST else TextLexer()
            except ClassNotFound:
                lexer = TextLexer()
            place, body, up = self.output / "source" / f"{relative}.html", highlight(text, lexer, formatter), len(relative.parts)
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(SOURCE_PAGE.format(title=relative, body=body, up="../" * up), encoding="utf-8")


def main():
    folder, output, stubs = (Path(argument).resolve() for argument in sys.argv[1:4])
    # Files that did not change keep their times, so that Sphinx does not read them again.
    fresh = folder.with_name(folder.name + ".new")
    shutil.rmtree(fresh, ignore_errors=True)
    site = Site(fresh, output)
    for page in pages():
        if page.relative_to(ROOT).parts[:2] != ("docs", "site"):
            site.add(page)
    site.add(ROOT / "docs" / "site" / "index.md", ROOT / "index.md")
    generated = ROOT / "docs" / "reference"  # where the generated pages would lie in the repository
    work = fresh / "docs" / "reference"
    work.mkdir(parents=True)
    reference.write_cpp(ROOT / "include", work / "cpp")
    scene_reference.write(work / "scene.md")
    if stubs.exists():
        reference.write_python(stubs, work / "python.md")
    else:
        (work / "python.md").write_text("# Python reference\n\nThis site was built without the Python package.\n", encoding="utf-8")
    for page in sorted(work.rglob("*.md")):
        text = page.read_text(encoding="utf-8")
        as_if = generated / page.relative_to(work)
        page.write_text(site.rewritten(as_if, text) if page.name != "index.md" else text, encoding="utf-8")
    site.show_sources()
    static_files(fresh / "_static")
    take_over(fresh, folder)
    for fault in site.faults:
        print(fault, file=sys.stderr)
    return 1 if site.faults else 0


def static_files(static):
    style = (ROOT / "docs" / "site" / "style.css").read_text(encoding="utf-8")
    if KATEX.exists():
        # KaTeX, with its fonts, draws the equations: without network, at once.
        style = '@import "katex.min.css";\n' + style
        shutil.copyfile(KATEX / "katex.min.css", static / "katex.min.css")
        shutil.copytree(KATEX / "fonts", static / "fonts", symlinks=False)
        (static / "equations.js").write_text((KATEX / "katex.min.js").read_text(encoding="utf-8") + RENDER, encoding="utf-8")
    (static / "style.css").write_text(style, encoding="utf-8")
    theme_files(static)
    if LIVE.exists():
        shutil.copyfile(LIVE, static / "live.js")


def theme_files(static):
    """Debian's Furo loads one of its scripts as a module and one of its styles from the server: both made whole, for pages that are files."""
    try:
        import furo
    except ImportError:
        return
    theme = Path(furo.__file__).parent / "theme" / "furo" / "static"
    script = (theme / "scripts" / "furo.js").read_text(encoding="utf-8")
    if script.startswith("import Gumshoe"):
        (static / "scripts").mkdir()
        gumshoe = (theme / "scripts" / "gumshoe-patched.js").read_text(encoding="utf-8")
        (static / "scripts" / "furo.js").write_text(gumshoe + "\n;" + script.split("\n", 1)[1], encoding="utf-8")
    look = (theme / "styles" / "furo.css").read_text(encoding="utf-8")
    (static / "styles").mkdir()
    (static / "styles" / "furo.css").write_text(re.sub(r"@import url\(/[^)]*\);", NORMALIZED, look), encoding="utf-8")


def take_over(fresh, folder):
    """Moves what changed to the folder of the last time, and removes what is no more there."""
    kept = {path.relative_to(fresh) for path in fresh.rglob("*") if path.is_file()}
    for path in sorted(folder.rglob("*")) if folder.exists() else []:
        if path.is_file() and path.relative_to(folder) not in kept:
            path.unlink()
    for name in sorted(kept):
        place = folder / name
        if place.exists() and place.read_bytes() == (fresh / name).read_bytes():
            continue
        place.parent.mkdir(parents=True, exist_ok=True)
        os.replace(fresh / name, place)
    shutil.rmtree(fresh)


if __name__ == "__main__":
    sys.exit(main())
