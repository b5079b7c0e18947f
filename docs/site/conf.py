"""Settings of Sphinx for the guide's site; tools/build_guide.sh runs it. docs/decisions/guide-site.md tells why these tools."""

from pathlib import Path

from pygments.lexers import JavascriptLexer

project = "Gyre"
author = "the authors of Gyre"
extensions = ["myst_parser", "sphinx.ext.mathjax"]
source_suffix = {".md": "markdown"}
root_doc = "index"
html_theme = "furo"
html_title = "Gyre"
html_static_path = [str(Path(__file__).resolve().parent.parent.parent / "build" / "guide-source" / "_static")]
html_css_files = ["style.css"]
html_copy_source = False
html_show_search_summary = False  # a page that is a file may not read the others
html_show_sphinx = False
html_show_copyright = False
templates_path = []
pygments_style = "friendly"
myst_enable_extensions = ["dollarmath", "html_image"]
myst_heading_anchors = 4
# Pages that the table of contents does not name are reached by links from those that it does.
suppress_warnings = ["toc.excluded", "myst.header", "misc.highlighting_failure", "toc.not_readable"]
# KaTeX in the place of MathJax: the script that the extension loads finds the same marks (tools/build_guide.sh makes it).
mathjax_path = "equations.js"


def without_orphans(app, docname, source):
    """Every page but the index may lie outside the table of contents."""
    if docname != "index":
        source[0] = "---\norphan: true\n---\n" + source[0] if not source[0].startswith("---") else source[0]


def setup(app):
    app.add_lexer("jsonc", JavascriptLexer)  # JSON with comments
    app.connect("source-read", without_orphans)
