"""The scenes in scenes/joints/: things that hold only if joints do. tools/make_scenes.py writes them."""

import math

APART = {"layer": 2, "collides_with": 1}  # parts of one thing do not touch each other


def capsule(radius, half_height, **more):
    return {"type": "capsule", "radius": radius, "half_height": half_height, **more}


def bar(x, y, z, **more):
    return {"type": "box", "half_extents": [x, y, z], **more}


def part(name, position, shape, **more):
    return {"name": name, "position": list(position), "filter": APART, **more, "shapes": [shape]}


def turned(angle):
    return {"axis": [0, 0, 1], "angle": angle}


def hinge(name, a, b, anchor, **more):
    return {"type": "hinge", "name": name, "a": a, "b": b, "anchor": list(anchor), "axis": [0, 0, 1], **more}


def scene(name, eye, target, bodies, joints, **more):
    return {"gyre_scene": 1, "name": name, "view": {"eye": list(eye), "target": list(target), "field_of_view": 0.6}, **more,
            "bodies": bodies, "joints": joints}


def chain():
    """A hundred links under a thousand times the weight of one, let go level."""
    link, links = 0.25, 100
    density = 1 / (math.pi * 0.04**2 * (2 * 0.08 + 4 / 3 * 0.04))  # 1 kg a link
    bodies, joints = [], []
    for i in range(links):
        bodies.append(part(f"link {i + 1}", ((i + 0.5) * link, 28, 0), capsule(0.04, 0.08, density=density),
                           orientation=turned(-math.pi / 2), color="#8d99a8" if i % 2 else "#6f7b8b"))
        joints.append({"type": "ball", "a": f"link {i}" if i else "world", "b": f"link {i + 1}", "anchor": [i * link, 28, 0]})
    bodies.append(part("load", (links * link + 0.5, 28, 0), {"type": "sphere", "radius": 0.5, "density": 1000 / (4 / 3 * math.pi * 0.125)},
                       color="#4d5560"))
    joints.append({"type": "ball", "a": f"link {links}", "b": "load", "anchor": [links * link, 28, 0]})
    return scene("a chain of 100 links under 1,000 times a link's weight", (4, 14, 62), (4, 14, 0), bodies, joints)


def bridge():
    """Two hundred planks, each hung to the next by two balls, one row more than they need, and boxes on them."""
    planks, length, slack = 200, 0.5, 0.02
    low, high = 1e-6, 3.0
    for _ in range(60):
        t = (low + high) / 2
        low, high = (t, high) if math.sin(t) / t > 1 - slack else (low, t)
    angles = [-low + 2 * low * (i + 0.5) / planks for i in range(planks)]
    points = [(0.0, 0.0)]
    for angle in angles:
        x, y = points[-1]
        points.append((x + length * math.cos(angle), y + length * math.sin(angle)))
    half, height = points[-1][0] / 2, 12
    points = [(x - half, y + height) for x, y in points]
    bodies = [{"name": f"{side} bank", "type": "static", "position": [sign * (half + 2), height - 6, 0], "color": "#9aa7a0",
               "shapes": [bar(2, 6, 2)]} for side, sign in (("left", -1), ("right", 1))]
    joints = []
    names = ["left bank"] + [f"plank {i + 1}" for i in range(planks)] + ["right bank"]
    for i, angle in enumerate(angles):
        (x1, y1), (x2, y2) = points[i], points[i + 1]
        bodies.append({"name": names[i + 1], "position": [(x1 + x2) / 2, (y1 + y2) / 2, 0], "orientation": turned(angle),
                       "color": "#cf9a62" if i % 2 else "#b98250", "shapes": [bar(0.235, 0.05, 1, density=400)]})
    for i, (x, y) in enumerate(points):
        for z in (-0.8, 0.8):
            joints.append({"type": "ball", "a": names[i], "b": names[i + 1], "anchor": [x, y, z]})
    lowest = min(y for _, y in points)
    for i in range(5):
        bodies.append({"name": f"box {i + 1}", "position": [(i - 2) * 1.6, lowest + 0.75, 0], "color": "#b9674c",
                       "shapes": [bar(0.4, 0.4, 0.4, density=2600)]})
    return scene("a bridge of 200 planks", (0, 16, 95), (0, 8, 0), bodies, joints)


def linkage():
    """Six links: the ground, a bar, and four parallel cranks of which two would do; one is driven."""
    bodies = [part("bar", (1.5, 1, 0), bar(1.8, 0.06, 0.06), color="#b9674c")]
    joints = []
    for i in range(4):
        bodies.append(part(f"crank {i + 1}", (i, 1.5, 0.2), bar(0.06, 0.56, 0.06), color="#8d99a8"))
        joints.append(hinge(f"bearing {i + 1}", "world", f"crank {i + 1}", (i, 2, 0.2)))
        joints.append(hinge(f"pin {i + 1}", f"crank {i + 1}", "bar", (i, 1, 0.1)))
    joints[0]["motor"] = {"target_velocity": 2, "max_force": 20000}
    return scene("a linkage with twice the joints it needs", (1.5, 2.2, 9), (1.5, 2, 0), bodies, joints)


def loop():
    """A ring of forty links, hung up at one and let go."""
    links, pitch = 40, 0.3
    radius = links * pitch / (2 * math.pi)
    bodies, joints = [], []
    for i in range(links):
        a = 2 * math.pi * i / links
        bodies.append(part(f"link {i + 1}", (radius * math.cos(a), 6 + radius * math.sin(a), 0), capsule(0.05, 0.1),
                           orientation=turned(a), color="#c67d5c" if i % 2 else "#8d99a8"))
    joints.append({"type": "ball", "name": "nail", "a": "world", "b": "link 1", "anchor": [radius, 6, 0]})
    for i in range(links):
        a = 2 * math.pi * (i + 0.5) / links
        joints.append({"type": "ball", "a": f"link {i + 1}", "b": f"link {(i + 1) % links + 1}",
                       "anchor": [radius * math.cos(a), 6 + radius * math.sin(a), 0]})
    return scene("a loop of forty links", (1, 4.5, 12), (1.2, 4, 0), bodies, joints)


ALL = (chain, bridge, linkage, loop)
