"""Writes the reference pages of the guide: the C++ interface from the public headers, the Python interface from its type stubs.

    write_cpp(include, folder)        a page for each header, and an index
    write_python(stubs, path)         one page
"""

import ast
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "web" / "bindings"))
import headers  # noqa: E402

# In the order in which a newcomer needs them.
FIRST = ["world", "defs", "geometry", "joints", "events", "queries", "soft", "fluid", "fields", "replay", "stepping", "math", "ids", "result"]


def opening_comment(text):
    """The comment at the head of a header, as paragraphs."""
    lines = []
    for line in text.split("\n"):
        if not line.startswith("//"):
            break
        lines.append(line)
    return headers.clean_comment(lines)


def prose(text):
    """A comment as Markdown: signs that Markdown would read as commands are put into code or escaped."""
    text = re.sub(r"(?m)^namespace [\w:]+$", "", text).strip()
    parts = re.split(r"(`[^`\n]*`)", text)
    text = "".join(part if part.startswith("`") else re.sub(r"([*_<>|\[\]])", r"\\\1", part) for part in parts)
    return re.sub(r"(?m)^(\s*)([-+#])", r"\1\\\2", text)


def summary(text):
    """The first sentence."""
    text = " ".join(text.split())
    return re.split(r"(?<=\.)\s", text, maxsplit=1)[0]


def code(text):
    """A declaration as it stands in the header, without its indentation."""
    lines = text.split("\n")
    depths = [len(line) - len(line.lstrip()) for line in lines[1:] if line.strip()]
    cut = min(depths, default=0) if lines[-1].strip() in ("};", "}") else 0
    return "```cpp\n" + "\n".join([lines[0]] + [line[cut:] for line in lines[1:]]).rstrip() + "\n```\n"


def name_of(declaration):
    plain = headers.without_comments(declaration)
    match = re.match(r"\s*(?:template\s*<[^{;]*?>\s*)?(enum class|struct|class)\s+(?:\[\[\w+\]\]\s*)?(\w+)", plain)
    if match:
        return match.group(1), match.group(2)
    if match := re.match(r"\s*using (\w+)", plain):
        return "using", match.group(1)
    if match := re.match(r"\s*(?:inline )?constexpr [\w:]+ (k\w+)\s*=", plain):
        return "constant", match.group(1)
    if headers.is_function(plain) and (match := re.search(r"(\w+)\s*\(", plain)):
        return "function", match.group(1)
    return "", ""


def function_code(declaration):
    """Without the body of what is computed in the header."""
    plain = headers.without_comments(declaration)
    if "{" in plain and "(" in plain.split("{")[0]:
        plain = re.sub(r"\)\s*(const)?\s*(noexcept)?\s*(:[^{]*)?\{.*", r") \1;", plain, flags=re.S).replace(") ;", ");")
    return " ".join(plain.split())


def class_page(name, body):
    """A heading for each public function, overloads together."""
    out, public, groups = [], body.startswith("struct"), {}
    for doc, declaration, after in headers.declarations(headers.inner_text(body)):
        if declaration.endswith(":"):
            public = declaration == "public:"
            continue
        kind, inner = name_of(declaration)
        if not public or kind != "function" or "operator" in declaration or "~" in declaration:
            continue
        group = groups.setdefault(inner, ([], []))
        group[0].append(function_code(declaration))
        group[1].extend(text for text in (doc, after) if text)
    for inner, (codes, docs) in groups.items():
        out.append(f"### {name}::{inner}\n\n```cpp\n" + "\n".join(codes) + "\n```\n\n" + prose("\n\n".join(docs)) + "\n")
    return out


def cpp_page(header, path):
    text = path.read_text(encoding="utf-8")
    out = [f"# gyre/{header}.h\n", prose(opening_comment(text)) + "\n", f"[The header](../../../include/gyre/{header}.h)\n"]
    functions = {}
    for doc, body, after in headers.declarations(text):
        kind, name = name_of(body)
        words = "\n\n".join(part for part in (doc, after) if part)
        if re.match(r"\s*(struct|class) \w+;", body) or not name or "operator" in headers.without_comments(body).split("{")[0]:
            continue
        if kind == "function":
            group = functions.setdefault(name, len(out))
            if group == len(out):
                out.append([name, [], []])
            out[group][1].append(function_code(body))
            out[group][2].extend([words] if words else [])
            continue
        out.append(f"## {name}\n\n{prose(words)}\n")
        is_class = kind == "class" or (kind == "struct" and re.search(r"^ public:", body, re.M))
        if is_class:
            out.extend(class_page(name, body))
        else:
            out.append(code(body))
    return "\n".join(part if isinstance(part, str) else
                     f"## {part[0]}\n\n```cpp\n" + "\n".join(part[1]) + "\n```\n\n" + prose("\n\n".join(part[2])) + "\n" for part in out)


def write_cpp(include, folder):
    folder.mkdir(parents=True, exist_ok=True)
    there = {str(path.relative_to(include / "gyre").with_suffix("")): path for path in sorted((include / "gyre").rglob("*.h"))}
    order = [name for name in FIRST if name in there] + [name for name in there if name not in FIRST and name != "gyre"]
    rows = []
    for name in order:
        page = name.replace("/", "_")
        (folder / f"{page}.md").write_text(cpp_page(name, there[name]), encoding="utf-8")
        rows.append(f"| [gyre/{name}.h]({page}.md) | {prose(summary(opening_comment(there[name].read_text(encoding='utf-8'))))} |")
    listing = "\n".join(name.replace("/", "_") for name in order)
    brought = re.findall(r"#include <gyre/([\w/]+)\.h>", (include / "gyre" / "gyre.h").read_text(encoding="utf-8"))
    alone = ", ".join(f"`{name}.h`" for name in order if name not in brought)
    (folder / "index.md").write_text(
        f"# C++ reference\n\n`#include <gyre/gyre.h>` brings all of these headers but {alone}. The text of each page is that of the header.\n\n"
        "| header | holds |\n|---|---|\n" + "\n".join(rows) + f"\n\n```{{toctree}}\n:hidden:\n:maxdepth: 1\n\n{listing}\n```\n", encoding="utf-8")
    return order


def write_python(stubs, path):
    text = stubs.read_text(encoding="utf-8")
    lines = text.split("\n")
    out = ["# Python reference\n",
           "The names of the package `gyre`, from its type stubs. [The guide to Python](../python.md) tells how they are used.\n"]

    def shown(node):
        begin = min([node.lineno, *(one.lineno for one in node.decorator_list)])
        doc = ast.get_docstring(node) or ""
        return "\n".join(lines[begin - 1:node.end_lineno]), doc

    def without_docstring(text):
        return re.sub(r'\n?\s*""".*?"""', "", text, flags=re.S)

    for node in ast.parse(text).body:
        if not isinstance(node, (ast.ClassDef, ast.FunctionDef)) or node.name.startswith("_"):
            continue
        block, doc = shown(node)
        out.append(f"## {node.name}\n\n" + (prose(doc) + "\n" if doc else ""))
        methods = [one for one in getattr(node, "body", []) if isinstance(one, ast.FunctionDef)]
        if isinstance(node, ast.ClassDef) and len(methods) > 8:
            for method in methods:
                if method.name.startswith("__") and method.name != "__init__":
                    continue
                inner, words = shown(method)
                dedented = "\n".join(line[4:] for line in without_docstring(inner).split("\n"))
                out.append(f"### {node.name}.{method.name}\n\n```python\n{dedented}\n```\n\n{prose(words)}\n")
        else:
            out.append("```python\n" + without_docstring(block) + "\n```\n")
    path.write_text("\n".join(out), encoding="utf-8")
