#!/usr/bin/env python3
"""Fails on an include that points upward between the folders, on a cycle, and on a standard header that public headers
or any headers must not include.

The table below is the one in docs/architecture.md. A folder may include itself, the folders listed, and all that those may
include. Value headers of include/gyre may be included everywhere; the others only from `world` upward.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

LAYERS = {
    "base": [],
    "math": ["base"],
    "task": ["base"],
    "geometry": ["math", "task"],
    "collision": ["geometry"],
    "solver": ["geometry"],
    "rigid": ["collision", "solver"],
    "soft": ["collision", "solver"],
    "fluid": ["collision"],
    "coupling": ["rigid", "soft", "fluid"],
    "world": ["coupling"],
    "io": ["world"],
    "debug": ["world"],
}
VALUE_HEADERS = {"ids", "math", "result", "geometry", "bounds", "decomposition", "defs", "events", "fields", "memory"}
SEES_WHOLE_API = {"world", "io", "debug"}

# Folders outside src/: the project's own folders that they may include besides include/gyre.
OUTER = {
    "scene": {"scene"},
    "apps": {"apps", "scene", "bench"},
    "examples": set(),
    "kit": {"kit"},
    "capi": {"capi"},
    "web": {"web", "scene"},
}

PUBLIC_STANDARD = {
    "cmath", "compare", "cstddef", "cstdint", "limits", "memory", "optional", "span", "string_view", "type_traits", "utility",
    "variant", "vector",
}
BANNED_IN_HEADERS = {"iostream", "functional", "regex"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)


def closure(folder):
    allowed = {folder}
    for lower in LAYERS[folder]:
        allowed |= closure(lower)
    return allowed


def check_table():
    """The table itself must be a graph without cycles over known folders."""
    done = set()

    def visit(folder, path):
        if folder in path:
            sys.exit("check_layers: the table has a cycle: " + " -> ".join(path + [folder]))
        if folder not in LAYERS:
            sys.exit(f"check_layers: '{folder}' (below {path[-1]}) is not in the table")
        if folder not in done:
            for lower in LAYERS[folder]:
                visit(lower, path + [folder])
            done.add(folder)

    for folder in LAYERS:
        visit(folder, [])


def folder_of(path):
    """('src', 'geometry'), ('include', 'gyre') or ('scene', 'scene') and so on."""
    parts = path.relative_to(ROOT).parts
    if parts[0] in ("src", "include"):
        return parts[0], (parts[1] if len(parts) > 2 else "")
    return parts[0], parts[0]


def resolve(path, kind, name):
    """The file of ours that an include names, or None for a header of somebody else."""
    places = [ROOT / "include", ROOT / "src", ROOT, ROOT / "apps", ROOT / "apps" / "gyre"]
    if path.name.endswith("_test.cpp"):
        places.append(ROOT / "tests")  # scenes and helpers that whole-engine tests share
    if kind == '"':
        places.insert(0, path.parent)
    for place in places:
        candidate = place / name
        if candidate.is_file():
            return candidate.resolve()
    return None


def check_include(path, kind, name):
    """Returns why this include is wrong, or None."""
    top, folder = folder_of(path)
    header = path.suffix == ".h"
    target = resolve(path, kind, name)
    if target is None:
        if kind == '"':
            return "no such file of ours"
        if header and name in BANNED_IN_HEADERS:
            return f"<{name}> is too heavy for a header"
        if top == "include" and name not in PUBLIC_STANDARD:
            return f"<{name}> is not one of the standard headers a public header may include"
        return None

    to_top, to_folder = folder_of(target)
    if to_top == "include":
        if kind == '"':
            return "public headers are included as <gyre/...>"
        whole_api = target.stem not in VALUE_HEADERS
        if top == "src" and whole_api and folder not in SEES_WHOLE_API:
            return f"only {', '.join(sorted(SEES_WHOLE_API))} may include this public header"
        return None
    if top == "include":
        return "public headers include nothing but public headers"
    if top == "src":
        if to_top == "tests" and path.name.endswith("_test.cpp"):
            return None
        if to_top != "src":
            return "the core library includes nothing outside src/ and include/"
        if to_folder not in closure(folder):
            return f"'{folder}' must not know '{to_folder}'"
        return None
    if to_top not in OUTER[top]:
        return f"'{top}' must not include '{to_top}'"
    return None


def find_cycle(graph):
    state = {}

    def visit(node, path):
        state[node] = "open"
        for following in graph.get(node, ()):
            if state.get(following) == "open":
                return path[path.index(following):] + [following] if following in path else [node, following]
            if following not in state:
                cycle = visit(following, path + [following])
                if cycle:
                    return cycle
        state[node] = "done"
        return None

    for node in sorted(graph):
        if node not in state:
            cycle = visit(node, [node])
            if cycle:
                return cycle
    return None


def main():
    sys.setrecursionlimit(10000)
    check_table()
    problems = []
    graph = {}
    count = 0
    for top in ["include", "src", *OUTER]:
        for path in sorted((ROOT / top).rglob("*")):
            if path.suffix not in (".h", ".cpp"):
                continue
            if top == "src" and folder_of(path)[1] not in LAYERS:
                problems.append(f"{path.relative_to(ROOT)}: its folder is not in the table of layers")
                continue
            count += 1
            text = path.read_text(encoding="utf-8", errors="replace")
            for match in INCLUDE.finditer(text):
                kind, name = match.groups()
                why = check_include(path, kind, name)
                if why:
                    line = text.count("\n", 0, match.start(2)) + 1
                    problems.append(f"{path.relative_to(ROOT)}:{line}: includes {name}: {why}")
                target = resolve(path, kind, name)
                if target is not None:
                    graph.setdefault(path, []).append(target)
    cycle = find_cycle(graph)
    if cycle:
        problems.append("include cycle: " + " -> ".join(str(file.relative_to(ROOT)) for file in cycle))
    for problem in problems:
        print(problem)
    print(f"check_layers: {count} files, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
