#!/usr/bin/env python3
"""Writes the scenes in scenes/ that are too large or too regular to write by hand. Deterministic: the same files every time.

    tools/make_scenes.py            writes all
    tools/make_scenes.py --check    fails if a file differs from what would be written
"""

import colorsys
import json
import math
import random
import sys
from pathlib import Path

import fluid_scenes
import joint_scenes
import soft_scenes

SCENES = Path(__file__).resolve().parent.parent / "scenes"

# ------------------------------------------------------------------------------------------------------------ helpers

MATERIALS = {
    "wood": {"density": 650, "static_friction": 0.5, "dynamic_friction": 0.4, "restitution": 0.2, "color": "#cf9a62"},
    "steel": {"density": 7850, "static_friction": 0.6, "dynamic_friction": 0.45, "restitution": 0.5, "color": "#8d99a8"},
    "ice": {"density": 917, "static_friction": 0.05, "dynamic_friction": 0.03, "restitution": 0.05, "color": "#bfe3f2"},
    "rubber": {"density": 1100, "static_friction": 1.0, "dynamic_friction": 0.9, "restitution": 0.7, "color": "#454c57"},
    "stone": {"density": 2600, "static_friction": 0.7, "dynamic_friction": 0.6, "restitution": 0.1, "color": "#bfbbb3"},
    "lead": {"density": 11340, "static_friction": 0.5, "dynamic_friction": 0.4, "restitution": 0.05, "color": "#666b78"},
}

LAND, SAND, CONCRETE, DARK, GROUND = "#9db98b", "#cbb994", "#b4b8c0", "#4d5560", "#d6d8dc"
BRICKS = ("#b9674c", "#c67d5c", "#a95a45", "#cc8a66")
WOODS = ("#cf9a62", "#b98250", "#dcae7a")


def rainbow(share, lightness=0.56, saturation=0.62):
    """A color from red over yellow and green to violet."""
    parts = colorsys.hls_to_rgb(0.02 + 0.74 * share, lightness, saturation)
    return "#" + "".join(f"{round(255 * part):02x}" for part in parts)


def view(eye, target, field_of_view=0.6):
    return {"eye": list(eye), "target": list(target), "field_of_view": field_of_view}


def tidy(value):
    """Numbers with nine decimals at most, and whole ones without a point."""
    if isinstance(value, bool) or value is None or isinstance(value, str):
        return value
    if isinstance(value, (list, tuple)):
        return [tidy(v) for v in value]
    if isinstance(value, dict):
        return {k: tidy(v) for k, v in value.items()}
    value = round(value, 9)
    return int(value) if value == int(value) else value


def flat(value):
    return not any(isinstance(v, dict) or (isinstance(v, list) and not flat(v)) for v in value)


def text(value, indent=0):
    """JSON with small things on one line."""
    line = json.dumps(value)
    pad = "  " * (indent + 1)
    if isinstance(value, dict) and (len(line) > 150 - 2 * indent or indent < 1):
        parts = [f"{pad}{json.dumps(k)}: {text(v, indent + 1)}" for k, v in value.items()]
        return "{\n" + ",\n".join(parts) + "\n" + "  " * indent + "}"
    if isinstance(value, list) and len(line) > 150 - 2 * indent and not flat(value):
        return "[\n" + ",\n".join(pad + text(v, indent + 1) for v in value) + "\n" + "  " * indent + "]"
    return line


def about(axis, angle):
    return {"axis": list(axis), "angle": angle}


def ball(radius, **more):
    return {"type": "sphere", "radius": radius, **more}


def box(x, y, z, **more):
    return {"type": "box", "half_extents": [x, y, z], **more}


def round_shape(kind, radius, half_height, **more):
    return {"type": kind, "radius": radius, "half_height": half_height, **more}


def hull(points, **more):
    return {"type": "convex_hull", "points": points, **more}


def body(name, position, *shapes, **more):
    return {"name": name, "position": list(position), **more, "shapes": list(shapes)}


def fixed(name, position, *shapes, **more):
    return {"name": name, "type": "static", "position": list(position), **more, "shapes": list(shapes)}


def ground(**more):
    return fixed("ground", (0, 0, 0), {"type": "plane", **more})


def scene(name, bodies, joints=(), world=None, materials=(), seen=None, **more):
    out = {"gyre_scene": 1, "name": name}
    if world:
        out["world"] = world
    if seen:
        out["view"] = seen
    if materials:
        out["materials"] = {m: MATERIALS[m] for m in materials} if not isinstance(materials, dict) else materials
    out.update(more)
    out["bodies"] = bodies
    if joints:
        out["joints"] = list(joints)
    return out


def rock(rng, size):
    """A convex lump: points on a ball, pressed at random."""
    points = []
    for i in range(14):
        y = 1 - 2 * (i + 0.5) / 14
        turn = i * 2.39996  # the golden angle spreads points evenly
        across = math.sqrt(1 - y * y)
        r = size * rng.uniform(0.75, 1.1)
        points.append([round(r * across * math.cos(turn), 4), round(r * y, 4), round(r * across * math.sin(turn), 4)])
    return hull(points)


def mixed_shape(rng, i, size):
    kind = i % 6
    if kind == 0:
        return ball(size * rng.uniform(0.7, 1.1))
    if kind == 1:
        return box(*(size * rng.uniform(0.5, 1.1) for _ in range(3)))
    if kind == 2:
        return round_shape("capsule", 0.5 * size, size * rng.uniform(0.5, 0.9))
    if kind == 3:
        return round_shape("cylinder", size * rng.uniform(0.6, 0.9), size * rng.uniform(0.5, 1.0))
    if kind == 4:
        return round_shape("cone", 0.9 * size, size)
    return rock(rng, size)


def pit(half, height, thickness=0.25):
    """Four walls around the origin."""
    reach = half + thickness
    return [
        fixed("wall east", (reach, height, 0), box(thickness, height, half + 2 * thickness), color=CONCRETE),
        fixed("wall west", (-reach, height, 0), box(thickness, height, half + 2 * thickness), color=CONCRETE),
        fixed("wall south", (0, height, reach), box(half, height, thickness), color=CONCRETE),
        fixed("wall north", (0, height, -reach), box(half, height, thickness), color=CONCRETE),
    ]


def hill(x, z):
    return 0.9 * math.sin(0.35 * x) * math.cos(0.3 * z) + 0.35 * math.sin(0.9 * x + 0.7 * z) + 0.012 * (x * x + z * z)


def terrain_obj(cells, spacing, height):
    """A wavy square of triangles as a Wavefront file."""
    half = 0.5 * cells * spacing
    lines = ["# A hilly square, made by tools/make_scenes.py", "o terrain"]
    for row in range(cells + 1):
        for column in range(cells + 1):
            x, z = column * spacing - half, row * spacing - half
            lines.append(f"v {x:g} {round(height(x, z), 4):g} {z:g}")
    side = cells + 1
    for row in range(cells):
        for column in range(cells):
            a = row * side + column + 1
            lines.append(f"f {a} {a + side} {a + side + 1} {a + 1}")
    return "\n".join(lines) + "\n"


# ------------------------------------------------------------------------------------------------------------- scenes


def stack():
    boxes = [body(f"box {i + 1}", (0, 0.5 + i, 0), box(0.5, 0.5, 0.5, material="wood"), color=WOODS[i % 3]) for i in range(10)]
    return scene("ten boxes on each other", [ground(material="stone", color=GROUND)] + boxes, materials=["wood", "stone"])


def card_house():
    length, thickness, width, lean = 0.9, 0.012, 0.6, math.radians(18)
    sine, cosine = math.sin(lean), math.cos(lean)
    foot = length * sine + thickness * cosine  # half of a tent's width
    pitch = 2 * foot + 0.03
    tall = length * cosine + thickness * sine
    bodies = [ground(material="table")]
    floor = 0.0
    number = 0
    for storey, tents in enumerate((3, 2, 1)):
        for tent in range(tents):
            middle = (tent - (tents - 1) / 2) * pitch
            for side in (-1, 1):
                number += 1
                bodies.append(body(f"card {number}", (middle + side * 0.5 * foot, floor + 0.5 * tall, 0),
                                   box(thickness / 2, length / 2, width / 2, material="card"), color=("#d9604a", "#f0e6d4")[side > 0],
                                   orientation=about((0, 0, 1), side * lean)))
        floor += tall
        for deck in range(tents - 1):
            number += 1
            middle = (deck - (tents - 2) / 2) * pitch
            bodies.append(body(f"card {number}", (middle, floor + thickness / 2, 0),
                               box(pitch / 2 - 0.001, thickness / 2, width / 2, material="card"), color="#5b86a8"))
        floor += thickness
    materials = {"card": {"density": 800, "static_friction": 0.9, "dynamic_friction": 0.8},
                 "table": {"density": 700, "static_friction": 1.0, "dynamic_friction": 0.9, "color": "#b9a98f"}}
    return scene("house of cards, three storeys", bodies, materials=materials, world={"substeps": 8},
                 seen=view((1.7, 2.1, 4.7), (0, 1.2, 0)))


def dominoes():
    bodies = [ground(material="wood", color=GROUND)]
    angle, count = 0.0, 100
    for i in range(count):
        radius = 1.0 + 0.25 * angle
        x, z = radius * math.cos(angle), radius * math.sin(angle)
        # The way on: the tangent of the spiral.
        dx = 0.25 * math.cos(angle) - radius * math.sin(angle)
        dz = 0.25 * math.sin(angle) + radius * math.cos(angle)
        more = {"orientation": about((0, 1, 0), math.atan2(-dz, dx))}
        if i == 0:
            size = math.hypot(dx, dz)
            speed = 2.5  # falls forward: about up x forward
            more["angular_velocity"] = [speed * dz / size, 0, -speed * dx / size]
            more["linear_velocity"] = [0.15 * speed * dx / size, 0, 0.15 * speed * dz / size]
        bodies.append(body(f"domino {i + 1}", (x, 0.15, z), box(0.02, 0.15, 0.075, material="wood"), color=rainbow(i / count), **more))
        angle += 0.15 / math.hypot(radius, 0.25)
    return scene("a spiral of a hundred dominoes", bodies, materials=["wood"], seen=view((1.8, 5.0, 6.5), (0.3, 0, 0.28)))


def t_handle():
    handle = body("t handle", (0, 1, 0),
                  round_shape("cylinder", 0.025, 0.3, orientation=about((0, 0, 1), math.pi / 2), color="#8d99a8"),
                  round_shape("cylinder", 0.025, 0.15, position=[0, -0.175, 0], color="#d9773f"),
                  angular_velocity=[0.02, 12, 0], can_sleep=False)
    return scene("Dzhanibekov's wing nut: the middle axis is unstable", [handle],
                 world={"gravity": [0, 0, 0], "time_step": 0.004}, materials=["steel"],
                 seen=view((0.7, 1.35, 1.15), (0, 0.97, 0)))


def gyroscope():
    tilt = math.radians(20)
    up = [-math.sin(tilt), math.cos(tilt), 0]
    spin = 120
    top = body("top", (0, 1, 0),
               round_shape("cylinder", 0.1, 0.015, position=[0, 0.12, 0], material="steel", color="#cfa349"),
               round_shape("cylinder", 0.008, 0.08, position=[0, 0.08, 0], material="steel"),
               orientation=about((0, 0, 1), tilt), angular_velocity=[spin * u for u in up], can_sleep=False)
    stand = fixed("stand", (0, 0.49, 0), round_shape("cone", 0.2, 0.49), color=DARK)
    pivot = {"type": "ball", "name": "pivot", "a": "stand", "b": "top", "anchor": [0, 1, 0]}
    return scene("a heavy top on its pivot", [stand, top], [pivot], world={"time_step": 0.005, "substeps": 8},
                 materials=["steel"], seen=view((0.32, 1.28, 0.72), (0, 1.03, 0)))


def billiards():
    r = 0.028575
    materials = {
        "ball": {"density": 1740, "static_friction": 0.06, "dynamic_friction": 0.05, "restitution": 0.95, "color": "#f4f0e6"},
        "felt": {"density": 400, "static_friction": 0.25, "dynamic_friction": 0.2, "restitution": 0.5,
                 "rolling_friction": 0.0003, "spinning_friction": 0.0003, "color": "#3a8f6c"},
        "cushion": {"density": 400, "static_friction": 0.2, "dynamic_friction": 0.15, "restitution": 0.8, "color": "#7a4f33"},
    }
    pairs = [{"materials": ["ball", "felt"], "static_friction": 0.25, "dynamic_friction": 0.2, "restitution": 0.5},
             {"materials": ["ball", "cushion"], "static_friction": 0.15, "dynamic_friction": 0.14, "restitution": 0.8}]
    bodies = [
        fixed("table", (0, -0.05, 0), box(1.4, 0.05, 0.77, material="felt")),
        fixed("cushion head", (-1.32, 0.02, 0), box(0.05, 0.02, 0.735, material="cushion")),
        fixed("cushion foot", (1.32, 0.02, 0), box(0.05, 0.02, 0.735, material="cushion")),
        fixed("cushion left", (0, 0.02, -0.685), box(1.27, 0.02, 0.05, material="cushion")),
        fixed("cushion right", (0, 0.02, 0.685), box(1.27, 0.02, 0.05, material="cushion")),
        body("cue ball", (-0.635, r, 0.004), ball(r, material="ball"), linear_velocity=[7, 0, 0], continuous=True),
    ]
    number = 0
    for row in range(5):
        for place in range(row + 1):
            number += 1
            x = 0.635 + row * (r * math.sqrt(3) + 0.0003)
            z = (place - row / 2) * (2 * r + 0.0003)
            bodies.append(body(f"ball {number}", (x, r, z), ball(r, material="ball"), continuous=True,
                               color="#26292e" if number == 8 else rainbow(number * 7 % 15 / 15)))
    return scene("the break", bodies, materials=materials, material_pairs=pairs, world={"time_step": 1 / 240},
                 seen=view((-1.15, 2.4, 2.55), (0.02, -0.1, 0.0)))


def incline_materials():
    angle = math.radians(22)
    out = [fixed("ramp", (0, 2, 0), box(4, 0.1, 3, static_friction=1, dynamic_friction=1), color="#8fa3b8", orientation=about((0, 0, 1), angle)),
           ground(static_friction=0.6)]
    # The geometric mean with the ramp's 1 makes these squares the friction that counts.
    colors = (MATERIALS["ice"]["color"], "#efe9dc", MATERIALS["steel"]["color"], MATERIALS["wood"]["color"], MATERIALS["rubber"]["color"])
    for i, (name, friction) in enumerate((("ice", 0.05), ("teflon", 0.2), ("steel", 0.35), ("wood", 0.45), ("rubber", 0.9))):
        x, y = 2.6, 0.1 + 0.25
        position = (x * math.cos(angle) - y * math.sin(angle), 2 + x * math.sin(angle) + y * math.cos(angle), (i - 2) * 1.1)
        out.append(body(f"{name} block", position,
                        box(0.35, 0.25, 0.35, static_friction=friction ** 2, dynamic_friction=friction ** 2), color=colors[i],
                        orientation=about((0, 0, 1), angle)))
    return scene("five materials on one ramp: tan 22 degrees is 0.40", out, seen=view((-5.5, 7.5, 11.5), (-0.9, 1.2, 0)))


def half_wood_half_lead():
    def brick(name, z, left, right):
        # A brick of two halves, its middle 0.2 m beyond the edge of the table.
        return body(name, (0.2, 1.2, z), box(0.25, 0.2, 0.2, position=[-0.25, 0, 0], material=left),
                    box(0.25, 0.2, 0.2, position=[0.25, 0, 0], material=right))

    bodies = [ground(), fixed("table", (-1, 0.5, 0), box(1, 0.5, 2), color="#7f9cb3"),
              brick("lead on the table", -1, "lead", "wood"), brick("all wood", 0, "wood", "wood"),
              brick("lead in the air", 1, "wood", "lead")]
    return scene("half wood, half lead: one stays, two tip", bodies, materials=["wood", "lead"],
                 seen=view((3.9, 3.2, 5.0), (-0.15, 0.6, 0)))


def pile():
    rng = random.Random(4)
    bodies = [ground()] + pit(2.0, 1.5)
    for i in range(240):
        layer, place = divmod(i, 16)
        x, z = (place % 4 - 1.5) * 0.9, (place // 4 - 1.5) * 0.9
        turn = [rng.uniform(-1, 1) for _ in range(3)]
        bodies.append(body(f"piece {i + 1}", (x + rng.uniform(-0.1, 0.1), 0.6 + 0.75 * layer, z + rng.uniform(-0.1, 0.1)),
                           mixed_shape(rng, i, 0.3), orientation=about(turn, rng.uniform(0, 3))))
    return scene("240 mixed pieces in a pit", bodies, seen=view((7.2, 9.4, 10.4), (0, 2.3, 0)))


def pin(name, x, z):
    """A ten-pin of three convex parts: base and belly, neck, head. 0.38 m tall, 1.5 kg."""
    def turned(profile):
        points = []
        for height, radius in profile:
            for k in range(10):
                angle = 2 * math.pi * k / 10
                points.append([round(radius * math.cos(angle), 4), round(height, 4), round(radius * math.sin(angle), 4)])
        return hull(points, material="maple")

    belly = turned([(0, 0.026), (0.02, 0.032), (0.09, 0.058), (0.14, 0.058), (0.2, 0.04)])
    neck = dict(turned([(0.2, 0.04), (0.25, 0.024), (0.29, 0.024)]), color="#cf4f42")
    return body(name, (x, 0, z), belly, neck, ball(0.032, position=[0, 0.345, 0], material="maple"), mass=1.5)


def bowling():
    materials = {"maple": {"density": 700, "static_friction": 0.35, "dynamic_friction": 0.3, "restitution": 0.6, "color": "#f4f0e6"},
                 "lane": {"density": 700, "static_friction": 0.15, "dynamic_friction": 0.1, "restitution": 0.2, "color": "#d8ad74"},
                 "ball": {"density": 1360, "static_friction": 0.2, "dynamic_friction": 0.15, "restitution": 0.4, "color": "#35549c"}}
    bodies = [fixed("floor", (0, -0.25, 0), {"type": "plane"}),
              fixed("lane", (-5, -0.1, 0), box(7, 0.1, 0.9, material="lane")),
              fixed("backstop", (2.2, 0.4, 0), box(0.1, 0.5, 0.9, restitution=0), color=DARK),
              body("ball", (-8, 0.1085, -0.35), ball(0.1085, material="ball"), linear_velocity=[8.5, 0, 0.25],
                   angular_velocity=[14, 0, -20], continuous=True)]
    number = 0
    for row in range(4):
        for place in range(row + 1):
            number += 1
            bodies.append(pin(f"pin {number}", row * 0.264, (place - row / 2) * 0.305))
    return scene("a strike, perhaps", bodies, materials=materials, world={"substeps": 6},
                 seen=view((-2.6, 1.5, 1.9), (0.55, 0.05, 0)))


def newtons_cradle():
    r, rope, spread, swing = 0.1, 1.0, 0.3, math.radians(40)
    materials = {"ball": {"density": 7850, "static_friction": 0, "dynamic_friction": 0, "restitution": 1, "color": "#a9b6c4"}}
    bodies, joints = [], []
    drop = math.sqrt(rope ** 2 - spread ** 2)
    for i in range(5):
        x = (i - 2) * (2 * r + 0.0005)
        place = (x, 0.2, 0)
        if i == 0:
            place = (x - drop * math.sin(swing), 0.2 + drop * (1 - math.cos(swing)), 0)
        bodies.append(body(f"ball {i + 1}", place, ball(r, material="ball"), can_sleep=False))
        for side, z in (("left", -spread), ("right", spread)):
            joints.append({"type": "distance", "name": f"wire {i + 1} {side}", "a": "world", "b": f"ball {i + 1}",
                           "anchor": [x, 0.2 + drop, z], "length": rope})
    return scene("Newton's cradle", bodies, joints, materials=materials, world={"time_step": 1 / 240, "substeps": 8},
                 seen=view((0.7, 0.85, 2.5), (-0.02, 0.58, 0)))


def mesh_terrain():
    rng = random.Random(11)
    bodies = [fixed("terrain", (0, 0, 0), {"type": "mesh", "mesh": "hills", "material": "stone"}, color=SAND),
              fixed("valley", (0, -3, 0), {"type": "plane", "material": "stone", "color": GROUND})]
    for i in range(120):
        x, z = (i % 12 - 5.5) * 1.1, (i // 12 - 4.5) * 1.1
        bodies.append(body(f"piece {i + 1}", (x, hill(x, z) + 1.5 + rng.uniform(0, 1), z), mixed_shape(rng, i, 0.25),
                           orientation=about([rng.uniform(-1, 1) for _ in range(3)], rng.uniform(0, 3))))
    return scene("pieces rolling down hills of triangles", bodies, materials=["stone"],
                 meshes={"hills": {"file": "meshes/hills.obj"}})


def height_field():
    rng = random.Random(5)
    side, spacing = 33, 0.6
    heights = []
    for row in range(side):
        for column in range(side):
            x, z = (column - (side - 1) / 2) * spacing, (row - (side - 1) / 2) * spacing
            heights.append(round(hill(x, z), 3))
    bodies = [fixed("land", (0, 0, 0), {"type": "height_field", "size": [side, side], "spacing": spacing, "heights": heights,
                                        "static_friction": 0.7}, color=LAND)]
    for i in range(60):
        x, z = (i % 10 - 4.5) * 1.5, (i // 10 - 2.5) * 1.5
        bodies.append(body(f"piece {i + 1}", (x, hill(x, z) + 1.2, z), mixed_shape(rng, i, 0.25)))
    return scene("a grid of heights", bodies)


def bridge():
    planks, length, radius = 20, 0.5, 12.0
    # The planks hang in an arc, so that there is no pull in them at the start.
    half = planks / 2 * 2 * math.asin(0.5 * length / radius)
    reach = radius * math.sin(half)

    def arc(i):
        angle = (i - planks / 2) * 2 * math.asin(0.5 * length / radius)
        return radius * math.sin(angle), 2.95 + radius * (math.cos(half) - math.cos(angle)), angle

    bodies = [ground(), fixed("left bank", (-reach - 1, 1.5, 0), box(1, 1.5, 1.5), color="#9aa7a0"),
              fixed("right bank", (reach + 1, 1.5, 0), box(1, 1.5, 1.5), color="#9aa7a0")]
    joints = []
    names = ["left bank"]
    for i in range(planks):
        (x1, y1, a1), (x2, y2, a2) = arc(i), arc(i + 1)
        name = f"plank {i + 1}"
        bodies.append(body(name, (0.5 * (x1 + x2), 0.5 * (y1 + y2), 0), box(0.24, 0.05, 1, material="wood"),
                           orientation=about((0, 0, 1), 0.5 * (a1 + a2)), angular_damping=0.1, color=WOODS[i % 2]))
        names.append(name)
    names.append("right bank")
    for i in range(planks + 1):
        x, y, _ = arc(i)
        joints.append({"type": "hinge", "name": f"hinge {i + 1}", "a": names[i], "b": names[i + 1], "anchor": [x, y, 0],
                       "axis": [0, 0, 1]})
    for i in range(5):
        bodies.append(body(f"load {i + 1}", ((i - 2) * 1.2, 4 + 0.3 * i, 0.2 * (i - 2)), box(0.3, 0.3, 0.3, material="wood"), color=rainbow(i / 5)))
    return scene("a bridge of hinged planks", bodies, joints, materials=["wood"], seen=view((5.0, 6.2, 13.2), (0.1, 1.7, 0)))


def bouncing():
    balls = [body(f"restitution {i / 10:g}", ((i - 5) * 0.7, 3, 0), ball(0.25, restitution=i / 10), color=rainbow(1 - i / 10), can_sleep=False)
             for i in range(11)]
    return scene("restitution from 0 to 1", [ground(restitution=0)] + balls, world={"time_step": 1 / 120},
                 seen=view((1.3, 2.5, 9.4), (0.12, 1.4, 0)))


def rolling():
    angle = math.radians(12)
    slope = about((0, 0, 1), angle)
    bodies = [ground(), fixed("ramp", (-3, 1.2, 0), box(3, 0.1, 3), color="#8fa3b8", orientation=slope),
              fixed("stop", (-14, 0.4, 0), box(0.2, 0.4, 4), color=DARK)]
    side = about((1, 0, 0), math.pi / 2)
    racers = (("ball", ball(0.25)), ("cylinder", round_shape("cylinder", 0.25, 0.3, orientation=side)),
              ("capsule", round_shape("capsule", 0.25, 0.2, orientation=side)),
              ("hollow cylinder", round_shape("cylinder", 0.25, 0.3, orientation=side)))
    for i, (name, shape) in enumerate(racers):
        x, y = 1.0 - 3.5 + 3.0, 0.35
        position = (-3 - 0 + x * math.cos(angle) - y * math.sin(angle) + 1.5, 1.2 + (x + 1.5) * math.sin(angle) + y * math.cos(angle),
                    (i - 1.5) * 1.2)
        more = {}
        if name == "hollow cylinder":  # all its mass in the shell: m r^2 about the axis
            more = {"mass": 50, "inertia": [3.0625, 3.0625, 3.125, 0, 0, 0]}
        bodies.append(body(name, position, shape, **more))
    # A cone that lies on its side rolls around its apex, and a coin spins on its edge.
    half = math.atan2(0.4, 1.2)
    bodies.append(body("cone", (3.5, 0.6 * math.sin(half) + 0.02, 1), round_shape("cone", 0.4, 0.6),
                       orientation=about((0, 0, 1), math.pi / 2 - half), angular_velocity=[0, 1.2, 0],
                       linear_velocity=[0, 0, 0.6]))
    bodies.append(body("coin", (3.5, 0.41, -1.5), round_shape("cylinder", 0.4, 0.03),
                       orientation=about((1, 0, 0), math.pi / 2 - 0.05), angular_velocity=[0, 12, 0]))
    return scene("what rolls: race down a ramp, a cone around its apex, a spinning coin", bodies, world={"time_step": 1 / 120},
                 seen=view((-0.5, 7.6, 18.5), (-4.3, 0, 0)))


def chain():
    bodies, joints = [], []
    previous = "world"
    for i in range(24):
        name = f"link {i + 1}"
        bodies.append(body(name, (0.3 * i + 0.15, 8.3, 0), round_shape("capsule", 0.05, 0.1, material="steel",
                                                                    orientation=about((0, 0, 1), math.pi / 2))))
        joints.append({"type": "ball", "name": f"joint {i + 1}", "a": previous, "b": name, "anchor": [0.3 * i, 8.3, 0]})
        previous = name
    bodies.append(body("wrecking ball", (7.6, 8.3, 0), ball(0.4, material="steel"), color=DARK, continuous=True))
    joints.append({"type": "ball", "name": "hook", "a": previous, "b": "wrecking ball", "anchor": [7.2, 8.3, 0]})
    wall = [body(f"brick {4 * row + column + 1}", (-2.5, 0.25 + 0.5 * row, (column - 1.5) * 1.0 + 0.25 * (row % 2)),
                 box(0.25, 0.25, 0.5, material="stone"), color=BRICKS[(column + 2 * row) % 4]) for row in range(5) for column in range(4)]
    return scene("a wrecking ball on a chain", [ground()] + bodies + wall, joints, materials=["steel", "stone"],
                 world={"substeps": 8}, seen=view((6.8, 7.0, 18.5), (1.8, 4.2, 0)))


def machines():
    bodies = [
        ground(),
        fixed("frame", (0, 1, 0), box(0.2, 1, 0.2), color=DARK),
        body("wheel", (0, 2, 0.5), round_shape("cylinder", 0.8, 0.1, orientation=about((1, 0, 0), math.pi / 2)),
             can_sleep=False),
        fixed("rail", (3, 1, 0), box(1.5, 0.1, 0.2), color=DARK),
        body("cart", (3, 1.4, 0), box(0.3, 0.2, 0.3)),
        fixed("post", (-3, 1.5, 0), box(0.1, 1.5, 0.1), color=DARK),
        body("gate", (-2.2, 1.2, 0), box(0.7, 0.8, 0.05)),
        body("rocket", (0, 0.61, 4), round_shape("capsule", 0.2, 0.4, density=200),
             forces=[{"force": [0, 700, 0], "at": [0, -0.6, 0], "frame": "body", "start": 0.5, "end": 2.5}]),
        {"name": "mixer", "type": "kinematic", "position": [0, 0.3, -4], "angular_velocity": [0, 2, 0],
         "shapes": [box(1.2, 0.15, 0.08), box(0.08, 0.15, 1.2)]},
        body("weight", (5.5, 1.5, -2), box(0.2, 0.2, 0.2)),
    ]
    for wall in pit(1.5, 0.3, 0.1):
        wall["position"][2] -= 4
        bodies.append(wall)
    for i in range(12):
        angle = 2 * math.pi * i / 12
        bodies.append(body(f"ball {i + 1}", (1.0 * math.cos(angle), 0.8, -4 + 1.0 * math.sin(angle)), ball(0.15)))
    joints = [
        {"type": "hinge", "name": "axle", "a": "frame", "b": "wheel", "anchor": [0, 2, 0.5], "axis": [0, 0, 1],
         "motor": {"target_velocity": 3, "max_force": 500}},
        {"type": "slider", "name": "track", "a": "rail", "b": "cart", "axis": [1, 0, 0], "limits": [-1, 1],
         "motor": {"target_position": 0.8, "max_force": 2000, "frequency": 0.5, "damping_ratio": 0.3}},
        {"type": "hinge", "name": "gate hinge", "a": "post", "b": "gate", "anchor": [-2.95, 1.2, 0], "axis": [0, 1, 0],
         "limits": [-1.2, 1.2], "motor": {"target_velocity": -1, "max_force": 20}},
        {"type": "distance", "name": "spring", "a": "world", "b": "weight", "anchor": [5.5, 3, -2], "length": 1,
         "stiffness": 2000, "damping": 20},
    ]
    return scene("motors, limits, springs, forces and a kinematic mixer", bodies, joints,
                 seen=view((6.2, 6.2, 11.2), (1.0, 0.9, -0.2)))


def showcase():
    rng = random.Random(21)
    bodies = [ground(material="stone", color=GROUND)]
    joints = []
    # A wall of bricks and a tower.
    for row in range(8):
        for column in range(10):
            bodies.append(body(f"brick {10 * row + column + 1}",
                               ((column - 4.5) * 0.82 + 0.41 * (row % 2), 0.2 + 0.4 * row, -2.3),
                               box(0.4, 0.2, 0.2, material="stone"), color=BRICKS[(column + 2 * row) % 4]))
    for i in range(10):
        bodies.append(body(f"tower {i + 1}", (7, 0.4 + 0.8 * i, -5), box(0.4, 0.4, 0.4, material="wood"), color=WOODS[i % 3]))
    # A pit that fills with mixed pieces.
    for wall in pit(2.0, 0.8, 0.15):
        wall["position"][0] += 6
        wall["position"][2] += 3
        bodies.append(wall)
    for i in range(180):
        layer, place = divmod(i, 16)
        bodies.append(body(f"piece {i + 1}", (6 + (place % 4 - 1.5) * 0.85, 0.5 + 0.7 * layer, 3 + (place // 4 - 1.5) * 0.85),
                           mixed_shape(rng, i, 0.26), orientation=about([rng.uniform(-1, 1) for _ in range(3)], rng.uniform(0, 3))))
    # Balls down a ramp into dominoes.
    slope = math.radians(20)
    bodies.append(fixed("ramp", (-9, 1.5, 0), box(2.5, 0.1, 1), color="#8fa3b8", orientation=about((0, 0, 1), -slope)))
    for i in range(5):
        bodies.append(body(f"rolling ball {i + 1}", (-10.9 + 0.5 * i, 2.6 - 0.18 * i, 0), ball(0.22, material="steel")))
    for i in range(30):
        bodies.append(body(f"domino {i + 1}", (-5.5 + 0.3 * i, 0.3, 0), box(0.035, 0.3, 0.16, material="wood"), color=rainbow(i / 30)))
    # A corner of hills, with pieces rolling down.
    bodies.append(fixed("hills", (-7, 0.2, 8), {"type": "mesh", "mesh": "hills", "material": "stone"}, color=LAND))
    for i in range(60):
        x, z = (i % 10 - 4.5) * 0.9, (i // 10 - 2.5) * 1.2
        bodies.append(body(f"stone {i + 1}", (-7 + x, hill(x, z) + 1.4, 8 + z), mixed_shape(rng, i, 0.24)))
    # A chain with a heavy ball that swings into the wall.
    previous, hook, links = "world", 7.4, 14
    for i in range(links):
        name = f"link {i + 1}"
        bodies.append(body(name, (0, hook, 0.2 + 0.4 * i), round_shape("capsule", 0.06, 0.14, material="steel",
                                                                     orientation=about((1, 0, 0), math.pi / 2))))
        joints.append({"type": "ball", "a": previous, "b": name, "anchor": [0, hook, 0.4 * i]})
        previous = name
    bodies.append(body("wrecking ball", (0, hook, 0.4 * links + 0.5), ball(0.5, material="steel"), color=DARK, continuous=True))
    joints.append({"type": "ball", "a": previous, "b": "wrecking ball", "anchor": [0, hook, 0.4 * links]})
    return scene("showcase", bodies, joints, materials=["stone", "wood", "steel"], meshes={"hills": {"file": "meshes/small_hills.obj"}},
                 seen=view((9.0, 10.5, 23.5), (-1.9, 1.5, 0.6)))


ALL = [stack, card_house, dominoes, t_handle, gyroscope, billiards, incline_materials, half_wood_half_lead, pile, bowling,
       newtons_cradle, mesh_terrain, height_field, bridge, bouncing, rolling, chain, machines, showcase]


def main():
    files = {SCENES / f"{make.__name__}.gyre.json": text(tidy(make())) + "\n" for make in ALL}
    files.update({SCENES / "joints" / f"{make.__name__}.gyre.json": text(tidy(make())) + "\n" for make in joint_scenes.ALL})
    files.update({SCENES / "soft" / f"{make.__name__}.gyre.json": text(tidy(make())) + "\n" for make in soft_scenes.ALL})
    files.update({SCENES / "fluid" / f"{make.__name__}.gyre.json": text(tidy(make())) + "\n" for make in fluid_scenes.ALL})
    files[SCENES / "meshes" / "hills.obj"] = terrain_obj(40, 0.4, hill)
    files[SCENES / "meshes" / "small_hills.obj"] = terrain_obj(24, 0.4, hill)
    different = 0
    for path, content in files.items():
        if "--check" not in sys.argv:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content, encoding="utf-8")
        elif not path.is_file() or path.read_text(encoding="utf-8") != content:
            print(f"{path} is not what this script writes")
            different += 1
    return 1 if different else 0


if __name__ == "__main__":
    sys.exit(main())
