#!/usr/bin/env python3
"""Fails on an include that points upward between layers or between the rooms of a layer, on a cycle, on a room that has grown too
large to be read, and on a standard header that public headers or any headers must not include.

A layer is a folder of src/, a room a folder of a layer. The tables below are those in docs/architecture.md. A layer may include
itself, the layers listed, and all that those may include; a room likewise among the rooms of its layer. Value headers of
include/gyre may be included everywhere; the others only from `world` upward.
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
    "dynamics": ["rigid", "soft", "fluid"],
    "world": ["dynamics"],
    "io": ["world"],
    "debug": ["world"],
    "batch": ["io"],
}
# The rooms of each layer that has any, and which rooms of the same layer each includes; "" is the layer's own folder.
ROOMS = {
    "base": {
        "": [],
        "memory": [""],
        "container": ["memory"],
        "arena": ["container"],
        "profile": ["container"],
    },
    "geometry": {
        "tree": [],
        "shape": ["tree"],
        "distance": ["shape"],
        "query": ["distance"],
        "manifold": ["distance"],
        "manifold_mesh": ["manifold"],
        "mass": ["query"],
        "bounds": ["distance"],
        "decomposition": ["mass"],
        "testing": ["manifold_mesh", "query", "mass"],
    },
    "collision": {
        "broadphase": [],
        "contact": ["broadphase"],
        "continuous": ["contact"],
        "query": ["contact"],
    },
    "solver": {
        "core": [],
        "motion": ["core"],
        "joint": ["core"],
        "articulation": ["joint"],
        "contact": ["motion"],
        "rest": ["contact"],
        "rows": ["contact", "joint"],
        "kernels": ["contact", "articulation"],
    },
    "rigid": {
        "store": [],
        "sleep": ["store"],
        "batch": ["store"],
        "field": ["store"],
        "integrate": ["batch", "field"],
        "rest": ["integrate"],
        "articulation": ["batch"],
        "solve": ["rest", "articulation"],
        "": ["sleep"],
        "continuous": ["", "articulation"],
        "time": ["solve"],
    },
    "soft": {
        "body": [],
        "mesh": [],
        "elements": ["body", "mesh"],
        "kernels": ["body"],
        "store": ["elements", "contact"],
        "solver": ["store", "kernels"],
        "query": ["store"],
        "contact": ["body"],
    },
    "fluid": {
        "grid": [],
        "kernels": ["grid"],
        "solver": ["kernels"],
        "gas": ["solver"],
        "liquid": ["solver"],
        "store": ["gas", "liquid"],
    },
    "dynamics": {
        "fluid": [],
        "soft": ["fluid"],
        "": ["soft"],
    },
    "world": {
        "": [],
        "query": [""],
    },
    "io": {
        "codec": [],
        "snapshot": ["codec"],
        "chunk": ["snapshot"],
        "track": ["chunk"],
        "recording": ["track"],
    },
}
# Tests and what only they include may use any room of their layer.
TESTS = re.compile(r"_test(_\w+)?\.(h|cpp)$")
# Files, tests among them, that may lie in one folder: more than these nobody reads as a list.
ROOM_LIMIT = 40
VALUE_HEADERS = {"ids", "math", "result", "geometry", "bounds", "coupling", "decomposition", "defs", "events", "fields", "joints", "fluid", "memory", "soft", "stepping"}
SEES_WHOLE_API = {"world", "io", "debug", "batch"}

# Folders outside src/: the project's own folders that they may include besides include/gyre.
OUTER = {
    "scene": {"scene"},
    "formats": {"formats", "scene"},
    "apps": {"apps", "formats", "scene", "bench"},
    "examples": set(),
    "kit": {"kit"},
    "capi": {"capi", "scene"},
    "web": {"web", "formats", "scene"},
}

PUBLIC_STANDARD = {
    "array",
    "cmath", "compare", "cstddef", "cstdint", "limits", "memory", "optional", "span", "string_view", "type_traits", "utility",
    "variant", "vector",
}
BANNED_IN_HEADERS = {"iostream", "functional", "regex"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.M)


def closure(folder, table):
    allowed = {folder}
    for lower in table[folder]:
        allowed |= closure(lower, table)
    return allowed


def check_table(table):
    """A table itself must be a graph without cycles over known folders."""
    done = set()

    def visit(folder, path):
        if folder in path:
            sys.exit("check_layers: the table has a cycle: " + " -> ".join(path + [folder]))
        if folder not in table:
            sys.exit(f"check_layers: '{folder}' (below {path[-1]}) is not in the table")
        if folder not in done:
            for lower in table[folder]:
                visit(lower, path + [folder])
            done.add(folder)

    for folder in table:
        visit(folder, [])


def folder_of(path):
    """('src', 'geometry'), ('include', 'gyre') or ('scene', 'scene') and so on."""
    parts = path.relative_to(ROOT).parts
    if parts[0] in ("src", "include"):
        return parts[0], (parts[1] if len(parts) > 2 else "")
    return parts[0], parts[0]


def room_of(path):
    """'distance' of src/geometry/distance/gjk.h, '' of src/world/step.cpp."""
    return "/".join(path.relative_to(ROOT).parts[2:-1])


def check_rooms():
    """Every file of a layer with rooms stands in one of them, and no folder is too full."""
    problems = []
    files = {}
    for path in sorted((ROOT / "src").rglob("*")):
        if path.suffix not in (".h", ".cpp") or folder_of(path)[1] not in LAYERS:
            continue
        files[path.parent] = files.get(path.parent, 0) + 1
        layer = folder_of(path)[1]
        if room_of(path) not in ROOMS.get(layer, {"": []}):
            problems.append(f"{path.relative_to(ROOT)}: its room is not in the table of rooms of '{layer}'")
    for folder, count in files.items():
        if count > ROOM_LIMIT:
            problems.append(f"{folder.relative_to(ROOT)}: {count} files, more than {ROOM_LIMIT}: make rooms")
    return problems


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
        if to_folder not in closure(folder, LAYERS):
            return f"'{folder}' must not know '{to_folder}'"
        if to_folder == folder and folder in ROOMS and not TESTS.search(path.name):
            room, to_room = room_of(path), room_of(target)
            if room in ROOMS[folder] and to_room not in closure(room, ROOMS[folder]):
                return f"'{folder}/{room}' must not know '{folder}/{to_room}'"
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
    check_table(LAYERS)
    for layer, rooms in ROOMS.items():
        if layer not in LAYERS:
            sys.exit(f"check_layers: '{layer}' has rooms but is not in the table of layers")
        check_table(rooms)
    problems = check_rooms()
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
