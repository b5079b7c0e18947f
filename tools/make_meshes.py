#!/usr/bin/env python3
"""Makes the concave meshes of scenes/decomposition by formula, and the scene that uses them.

    tools/make_meshes.py            writes them anew
"""

import json
import math
from pathlib import Path

FOLDER = Path(__file__).resolve().parent.parent / "scenes" / "decomposition"


class Mesh:
    def __init__(self):
        self.vertices, self.triangles = [], []

    def add(self, other):
        base = len(self.vertices)
        self.vertices += other.vertices
        self.triangles += [tuple(base + i for i in triangle) for triangle in other.triangles]

    def volume(self):
        total = 0.0
        for a, b, c in ((self.vertices[i] for i in triangle) for triangle in self.triangles):
            total += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2])
                      + a[2] * (b[0] * c[1] - b[1] * c[0])) / 6
        return total

    def outward(self):
        if self.volume() < 0:
            self.triangles = [(a, c, b) for a, b, c in self.triangles]
        return self

    def write(self, name, comment):
        lines = [f"# {comment}"]
        lines += ["v %.6g %.6g %.6g" % vertex for vertex in self.vertices]
        lines += ["f %d %d %d" % tuple(i + 1 for i in triangle) for triangle in self.triangles]
        (FOLDER / "meshes" / name).write_text("\n".join(lines) + "\n")


def revolved(outline, segments):
    """A closed outline of (radius, height) about the y axis."""
    mesh, count = Mesh(), len(outline)
    number = {}
    for s in range(segments):
        angle = 2 * math.pi * s / segments
        for i, (radius, height) in enumerate(outline):
            if radius == 0 and s > 0:
                number[s, i] = number[0, i]
                continue
            number[s, i] = len(mesh.vertices)
            mesh.vertices.append((radius * math.cos(angle), height, radius * math.sin(angle)))
    for s in range(segments):
        t = (s + 1) % segments
        for i in range(count):
            j = (i + 1) % count
            for triangle in ((number[s, i], number[t, i], number[t, j]), (number[s, i], number[t, j], number[s, j])):
                if len(set(triangle)) == 3:
                    mesh.triangles.append(triangle)
    return mesh.outward()


def ring(radius, tube, around, across):
    return revolved([(radius + tube * math.cos(2 * math.pi * i / across), tube * math.sin(2 * math.pi * i / across))
                     for i in range(across)], around)


def handle(middle, radius, tube, along, across):
    """Half a ring in the plane of x and y that bulges along +x, its ends at x = middle."""
    mesh = Mesh()
    for i in range(along + 1):
        a = -math.pi / 2 + math.pi * i / along
        for k in range(across):
            b = 2 * math.pi * k / across
            r = radius + tube * math.cos(b)
            mesh.vertices.append((middle + r * math.cos(a), r * math.sin(a), tube * math.sin(b)))
    at = lambda i, k: i * across + k % across
    for i in range(along):
        for k in range(across):
            mesh.triangles += [(at(i, k), at(i, k + 1), at(i + 1, k + 1)), (at(i, k), at(i + 1, k + 1), at(i + 1, k))]
    for k in range(1, across - 1):
        mesh.triangles += [(at(0, 0), at(0, k + 1), at(0, k)), (at(along, 0), at(along, k), at(along, k + 1))]
    return mesh.outward()


def mug():
    mesh = revolved([(0, -0.05), (0.04, -0.05), (0.04, 0.05), (0.034, 0.05), (0.034, -0.043), (0, -0.043)], 24)
    mesh.add(handle(0.037, 0.028, 0.006, 12, 8))
    return mesh


def gear(teeth):
    mesh, outline = Mesh(), []
    for i in range(4 * teeth):
        angle = 2 * math.pi * (i + 0.5) / (4 * teeth)
        radius = 0.09 if i % 4 < 2 else 0.07
        outline.append((radius * math.cos(angle), radius * math.sin(angle)))
    count = len(outline)
    for y in (-0.012, 0.012):
        mesh.vertices += [(x, y, z) for x, z in outline] + [(0.02 * x / math.hypot(x, z), y, 0.02 * z / math.hypot(x, z)) for x, z in outline]
    low, top = 0, 2 * count
    for i in range(count):
        j = (i + 1) % count
        for a, b, c, d in ((low + i, low + j, top + j, top + i), (low + count + j, low + count + i, top + count + i, top + count + j),
                           (low + count + i, low + count + j, low + j, low + i), (top + i, top + j, top + count + j, top + count + i)):
            mesh.triangles += [(a, b, c), (a, c, d)]
    return mesh.outward()


def scene():
    bodies = [{"name": "ground", "type": "static", "shapes": [{"type": "plane", "static_friction": 0.6}]}]
    pegs = [(-0.3, 0.0), (0.0, 0.12), (0.3, 0.0)]
    for i, (x, z) in enumerate(pegs):
        bodies.append({"name": f"peg {i + 1}", "type": "static", "position": [x, 0.15, z], "color": "#8a6d4b",
                       "shapes": [{"type": "cylinder", "radius": 0.02, "half_height": 0.15}]})
    colors = ["#d9534f", "#e8a33d", "#4c8f8b", "#5b7db1", "#9b6fb0"]
    for i, (x, z) in enumerate(pegs):
        for k in range(5):
            shape = {"type": "convex_decomposition", "mesh": "gear" if i == 1 else "ring", "density": 1200,
                     "static_friction": 0.5, "concavity": 0.03}
            bodies.append({"name": f"{shape['mesh']} {i + 1}.{k + 1}", "position": [x + 0.003 * (k % 3 - 1), 0.36 + 0.06 * k, z],
                           "orientation": {"axis": [1, 0, 0], "angle": 0.05 * (k - 2)}, "color": colors[k], "shapes": [shape]})
    for k in range(9):
        bodies.append({"name": f"mug {k + 1}", "position": [-0.12 + 0.11 * (k % 3), 0.12 + 0.13 * (k // 3), -0.3 + 0.012 * k],
                       "orientation": {"axis": [0.3, 1, 0.2 * (k % 2)], "angle": 0.7 * k}, "color": colors[k % 5],
                       "shapes": [{"type": "convex_decomposition", "mesh": "mug", "density": 2400, "static_friction": 0.4}]})
    return {
        "gyre_scene": 1,
        "name": "rings and gears on pegs, mugs in a heap",
        "world": {"time_step": 0.00833333333},
        "view": {"eye": [0.35, 0.55, -1.15], "target": [0, 0.12, -0.06], "field_of_view": 0.7},
        "meshes": {name: {"file": f"meshes/{name}.obj"} for name in ("ring", "gear", "mug")},
        "bodies": bodies,
    }


def main():
    (FOLDER / "meshes").mkdir(parents=True, exist_ok=True)
    ring(0.06, 0.018, 32, 16).write("ring.obj", "A ring about y, radius 60 mm, of a tube of 18 mm radius; made by tools/make_meshes.py")
    mug().write("mug.obj", "A mug 100 mm high whose handle runs into its wall; made by tools/make_meshes.py")
    gear(8).write("gear.obj", "A gear about y with 8 teeth and a bore of 40 mm; made by tools/make_meshes.py")
    text = json.dumps(scene(), indent=1)
    (FOLDER / "rings_and_mugs.gyre.json").write_text(text + "\n")


if __name__ == "__main__":
    main()
