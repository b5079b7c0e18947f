"""Writes the reference of the scene format: every member of the schema with its type, default, meaning, and an example.

Examples are values from scenes that the tests open: those of scenes/ and docs/guide/scenes/. The shortest value wins.
"""

import json
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
LONGEST = 120  # characters of an example

TITLES = {
    "scene": "The scene", "world": "world", "view": "view", "material": "materials", "material_pair": "material_pairs", "mesh": "meshes",
    "body": "bodies", "shape": "shapes", "force": "forces", "joint": "joints", "motor": "motor of a joint", "joint_axis": "axes of a joint",
    "drive": "drive of a joint", "rope": "ropes", "cloth": "cloths", "soft_body": "soft_bodies", "gas": "gases", "liquid": "liquids",
    "force_field": "force_fields",
}


class Schema:
    def __init__(self, path):
        self.root = json.loads(path.read_text(encoding="utf-8"))
        self.defs = self.root["$defs"]

    def resolve(self, node):
        """The node with what its reference says; its own words win."""
        if "$ref" in node:
            return {**self.resolve(self.defs[node["$ref"].rsplit("/", 1)[1]]), **{k: v for k, v in node.items() if k != "$ref"}}
        return node

    def reference(self, node):
        """The name of the definition that a member or its items refer to."""
        for inner in (node, node.get("items", {}), node.get("additionalProperties") or {}):
            if isinstance(inner, dict) and "$ref" in inner:
                return inner["$ref"].rsplit("/", 1)[1]
        return ""

    def members(self, name):
        """(member, schema) of an object, those of its variants included."""
        node = self.root if name == "scene" else self.defs[name]
        found = {}

        def walk(part):
            part = self.resolve(part)
            for key, value in part.get("properties", {}).items():
                if key not in found or len(json.dumps(value)) > len(json.dumps(found[key])):
                    found[key] = value
            for kind in ("allOf", "oneOf", "anyOf"):
                for inner in part.get(kind, []):
                    walk(inner)

        walk(node)
        return found


def kind_of(schema, node):
    node = schema.resolve(node)
    if "enum" in node:
        return ", ".join(f"`{json.dumps(value)}`" for value in node["enum"])
    if "const" in node:
        return f"`{json.dumps(node['const'])}`"
    kinds = node.get("type", [])
    kinds = [kinds] if isinstance(kinds, str) else kinds
    if not kinds and ("oneOf" in node or "anyOf" in node):
        parts = [kind_of(schema, part) for part in node.get("oneOf", node.get("anyOf"))]
        return " or ".join(dict.fromkeys(part for part in parts if part))
    words = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false", "object": "object", "null": "null"}
    named = []
    for kind in kinds:
        if kind == "array":
            size = node.get("minItems") if node.get("minItems") == node.get("maxItems") else None
            inner = kind_of(schema, node.get("items", {})) or "values"
            named.append(f"{size} of ({inner})" if size else f"list of ({inner})")
        else:
            named.append(words[kind])
    return " or ".join(named)


def bounds_of(node):
    low, above = node.get("minimum"), node.get("exclusiveMinimum")
    high, below = node.get("maximum"), node.get("exclusiveMaximum")
    parts = []
    if above is not None:
        parts.append(f"above {above:g}")
    if low is not None:
        parts.append(f"at least {low:g}")
    if below is not None:
        parts.append(f"below {below:g}")
    if high is not None:
        parts.append(f"at most {high:g}")
    return ", ".join(parts)


def scene_files():
    return sorted((ROOT / "docs" / "guide" / "scenes").glob("*.gyre.json")) + sorted((ROOT / "scenes").rglob("*.gyre.json"))


def harvest(schema):
    """The shortest value of every member: (definition, member) -> (text, file)."""
    best = {}

    def note(kind, member, value, file):
        text = json.dumps(value, ensure_ascii=False)
        if value is None or text in ("{}", "[]"):
            return
        key = (kind, member)
        if key not in best or len(text) < len(best[key][0]):
            best[key] = (text, file)

    def walk(kind, value, file):
        members = schema.members(kind)
        for member, inner in value.items():
            if member not in members:
                continue
            note(kind, member, inner, file)
            target = schema.reference(members[member])
            if target not in TITLES:
                target = "joint_axis" if (kind, member) == ("joint", "axes") else target
            if target not in TITLES:
                continue
            items = inner if isinstance(inner, list) else [inner]
            if member in ("materials", "meshes", "axes") and isinstance(inner, dict):
                items = list(inner.values())
            for item in items:
                if isinstance(item, dict):
                    walk(target, item, file)

    for path in scene_files():
        walk("scene", json.loads(path.read_text(encoding="utf-8")), path.relative_to(ROOT))
    return best


def missing(schema, best):
    """Members without any example."""
    return [f"{kind}.{member}" for kind in TITLES for member in schema.members(kind) if (kind, member) not in best]


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def shape_kinds(schema):
    """A table of what each kind of shape needs."""
    rows = ["| type | members | |", "|---|---|---|"]
    for part in schema.defs["shape"]["oneOf"]:
        part = {**schema.resolve(part), **part} if "$ref" in part else part
        inner = schema.resolve({"$ref": part["$ref"]}) if "$ref" in part else part
        members = [key for key in {**inner.get("properties", {}), **part["properties"]} if key != "type"]
        kept = [key for key in members if schema.resolve(part["properties"].get(key, {})).get("type") != "null"]
        required = part.get("required", inner.get("required", []))
        listed = ", ".join(f"`{key}`" + ("" if key in required else " (may be left out)") for key in kept)
        rows.append(f"| `{part['properties']['type']['const']}` | {listed} | {cell(part.get('description', ''))} |")
    return "\n".join(rows)


def write(path):
    schema = Schema(ROOT / "scenes" / "scene.schema.json")
    best = harvest(schema)
    out = ["# The scene format\n",
           f"{schema.root['description']}\n\nA scene is a JSON file. `gyre schema` prints its [schema](../../scenes/scene.schema.json), which editors use to complete "
           "members. `gyre info FILE` reads a scene and says where it is wrong. Members that are left out have the default.\n\n"
           "Every example below is a value from a scene of the repository, named behind it.\n"]
    for kind, title in TITLES.items():
        node = schema.root if kind == "scene" else schema.defs[kind]
        out.append(f"## {title}\n")
        if kind != "scene" and node.get("description"):
            out.append(node["description"] + "\n")
        if kind == "shape":
            out.append(shape_kinds(schema) + "\n")
        out.append("| member | value | default | meaning | example |\n|---|---|---|---|---|")
        required = node.get("required", [])
        for member, inner in schema.members(kind).items():
            full = schema.resolve(inner)
            default = f"`{json.dumps(full['default'])}`" if "default" in full else ("must be given" if member in required else "")
            target = schema.reference(inner)
            value = f"[{TITLES[target]}](#{TITLES[target].replace(' ', '-').lower()})" if target in TITLES else kind_of(schema, inner)
            limits = bounds_of(full)
            text, file = best.get((kind, member), ("", None))
            if text and len(text) > LONGEST:
                text = text[:LONGEST - 4].rsplit(",", 1)[0] + ", …"
            example = f"`\"{member}\": {cell(text)}` ([{file.name.removesuffix('.gyre.json')}](../../{file}))" if file else ""
            out.append(f"| `{member}` | {cell(value)}{f' ({limits})' if limits else ''} | {cell(default)} | {cell(full.get('description', ''))} | {example} |")
        out.append("")
    path.write_text("\n".join(out), encoding="utf-8")
    return missing(schema, best)
