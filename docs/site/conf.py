"""Settings of Sphinx for the guide's site; tools/build_guide.sh runs it. docs/decisions/guide-site.md tells why these tools."""

import re
from pathlib import Path

from pygments.lexers import JavascriptLexer
from sphinx.environment.adapters.toctree import TocTree

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


def quick_navigation(app, pagename, templatename, context, doctree):
    """Makes the table of contents beside the pages once, instead of anew for each: half of the time of a build."""
    if "toctree" not in context:
        return
    if not hasattr(app, "whole_tree"):
        tree = TocTree(app.env).get_toctree_for("index", app.builder, False, titles_only=True, includehidden=True, maxdepth=-1)
        app.whole_tree = app.builder.render_partial(tree)["fragment"]
    here = app.builder.get_target_uri(pagename)
    marked = re.sub(rf'<li class="(toctree-l\d)"><a class="reference internal" href="{re.escape(here)}">',
                    lambda match: f'<li class="{match[1]} current"><a class="current reference internal" href="{here}">', app.whole_tree)
    page = re.sub(r'href="(?!https?:|#)', 'href="' + "../" * pagename.count("/"), marked)
    context["toctree"] = lambda **kwargs: page


def setup(app):
    app.connect("html-page-context", quick_navigation, priority=400)  # before the theme asks for it
    app.add_lexer("jsonc", JavascriptLexer)  # JSON with comments
    app.connect("source-read", without_orphans)
