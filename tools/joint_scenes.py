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


WOOD, STEEL, CLAY, DARK, LAND = "#cf9a62", "#8d99a8", "#b9674c", "#4d5560", "#9db98b"


def ground(size=20):
    return {"name": "ground", "type": "static", "position": [0, -0.5, 0], "color": LAND, "shapes": [bar(size, 0.5, size)]}


def post(name, position, shape, **more):
    return {"name": name, "type": "static", "position": list(position), "color": DARK, **more, "shapes": [shape]}


def joint(kind, a, b, **more):
    return {"type": kind, "a": a, "b": b, **more}


def cylinder(radius, half_height, **more):
    return {"type": "cylinder", "radius": radius, "half_height": half_height, **more}


def ball(radius, **more):
    return {"type": "sphere", "radius": radius, **more}


UPRIGHT_TO_Z = {"axis": [1, 0, 0], "angle": math.pi / 2}  # a cylinder's axis along z


def wheel_part(name, position, radius, width, color, **more):
    """A disc about z with a peg that shows how it turns."""
    return {"name": name, "position": list(position), "filter": APART, "color": color, **more,
            "shapes": [cylinder(radius, width, orientation=UPRIGHT_TO_Z),
                       bar(0.08 * radius, 0.3 * radius, 1.4 * width, position=[0, 0.55 * radius, 0])]}


def cone():
    """A row of arms that hang from shoulders: cones of different ellipses, let go level."""
    bodies, joints = [ground()], []
    for i, (y, z) in enumerate(((0.2, 0.2), (0.8, 0.8), (0.2, 1.2), (1.2, 0.2), (1.5, 1.5))):
        x = (i - 2) * 1.6
        bodies.append(post(f"shoulder {i + 1}", (x, 3, 0), ball(0.15)))
        bodies.append(part(f"upper arm {i + 1}", (x, 2.5, 0), bar(0.09, 0.5, 0.14), color=WOOD,
                           angular_velocity=[2.5, 1, 2.5]))
        bodies.append(part(f"forearm {i + 1}", (x, 1.55, 0), bar(0.07, 0.45, 0.1), color=CLAY))
        joints.append(joint("cone", f"shoulder {i + 1}", f"upper arm {i + 1}", anchor=[x, 3, 0], axis=[0, -1, 0], axis_b=[0, 0, 1],
                            swing=[y, z], limits=[-0.4, 0.4], friction=0.2))
        joints.append(joint("hinge", f"upper arm {i + 1}", f"forearm {i + 1}", anchor=[x, 2, 0], axis=[1, 0, 0], limits=[-2.3, 0]))
    return scene("arms on cones", (0, 2.6, 9), (0, 2, 0), bodies, joints)


def universal():
    """A shaft in three pieces around two corners, driven at one end: the middle one runs unevenly, the last evenly again."""
    bend = 0.6
    along = [(1, 0), (math.cos(bend), math.sin(bend)), (1, 0)]
    points, bodies, joints = [(-3.0, 1.5)], [ground()], []
    for x, y in along:
        points.append((points[-1][0] + 2 * x, points[-1][1] + 2 * y))
    names = ("driven", "middle", "last")
    for name, (x, y), (p, q) in zip(names, along, points):
        bodies.append(part(name, (p + x, q + y, 0), bar(0.94, 0.09, 0.09), orientation=turned(math.atan2(y, x)), color=CLAY if name == "middle" else STEEL))
    for name, number in (("driven", 0), ("last", 2)):
        p, q = points[number]
        joints.append(joint("hinge", "world", name, name=f"bearing of the {name}", anchor=[p + 1, q, 0], axis=[1, 0, 0]))
    joints[0]["motor"] = {"target_velocity": 4, "max_force": 400}
    joints.append(joint("universal", "driven", "middle", anchor=[*points[1], 0], axis=[0, 0, 1], axis_b=[-math.sin(bend), math.cos(bend), 0]))
    joints.append(joint("universal", "middle", "last", anchor=[*points[2], 0], axis=[-math.sin(bend), math.cos(bend), 0], axis_b=[0, 0, 1]))
    return scene("a shaft around two corners", (0.3, 2.6, 8), (0, 2, 0), bodies, joints)


def spring():
    """Weights on springs: from soft and undamped to 10^9 N/m on a gram."""
    bodies, joints = [post("beam", (0, 5, 0), bar(5, 0.1, 0.3)), ground()], []
    cases = ((1, 40, 0), (1, 100, 0), (1, 100, 4), (1, 1000, 0), (4, 1000, 126), (0.001, 1e9, 0))
    for i, (mass, stiffness, damping) in enumerate(cases):
        x = (i - 2.5) * 1.6
        bodies.append(part(f"weight {i + 1}", (x, 3, 0), bar(0.25, 0.25, 0.25), mass=mass, color=CLAY if damping else WOOD))
        joints.append(joint("distance", "beam", f"weight {i + 1}", name=f"spring {i + 1}", anchor=[x, 4.9, 0], anchor_b=[x, 3, 0],
                            length=1.9, stiffness=stiffness, damping=damping))
    return scene("weights on springs", (0, 3, 11), (0, 2.8, 0), bodies, joints)


def six_dof():
    """Plates on posts, each free, sprung, driven or limited along or about one axis."""
    free, drive = {"motion": "free"}, {"motor": {"target_velocity": 2, "max_force": 500}}
    cases = {"linear_x": {"limits": [-0.6, 0.6], **drive}, "linear_y": {**free, "stiffness": 4000, "damping": 60},
             "linear_z": {**free, "stiffness": 3000, "friction": 20}, "angular_x": {**free, **drive},
             "angular_y": {**free, "motor": {"target_position": 0.5, "frequency": 1, "damping_ratio": 0.3, "max_force": 500}},
             "angular_z": {"limits": [-0.3, 0.3], "limit_frequency": 2, "limit_damping_ratio": 0.1}}
    bodies, joints = [ground()], []
    for i, (axis, what) in enumerate(cases.items()):
        x = (i - 2.5) * 2
        bodies.append(post(f"post {i + 1}", (x, 0.7, 0), bar(0.08, 0.7, 0.08)))
        bodies.append(part(axis, (x, 1.6, 0), bar(0.5, 0.08, 0.4, density=400), color=WOOD,
                           linear_velocity=[0, -1, 1.5] if axis in ("linear_y", "linear_z") else [0, 0, 0],
                           angular_velocity=[0, 0, 3] if axis == "angular_z" else [0, 0, 0]))
        joints.append(joint("six_dof", f"post {i + 1}", axis, anchor=[x, 1.5, 0], axis=[1, 0, 0], axis_b=[0, 0, 1], axes={axis: what}))
    return scene("six axes, one each", (0, 3.5, 11), (0, 1.3, 0), bodies, joints)


def gear():
    """A train of four gears; the first is driven, a weight hangs from nothing: the last turns 12 times slower."""
    bodies, joints, x, radius = [ground()], [], -2.2, 0.3
    radii = (0.3, 0.6, 0.45, 2 * 0.3 * 1.5)
    for i, r in enumerate(radii):
        x += r + (radius if i else 0)
        radius = r
        bodies.append(wheel_part(f"gear {i + 1}", (x, 1.6, 0), r * 0.98, 0.06, (STEEL, CLAY, WOOD, DARK)[i]))
        joints.append(joint("hinge", "world", f"gear {i + 1}", anchor=[x, 1.6, 0], axis=[0, 0, 1], friction=2 if i == 3 else 0))
        if i:
            joints.append(joint("gear", f"gear {i}", f"gear {i + 1}", axis=[0, 0, 1], axis_b=[0, 0, 1], ratio=radii[i] / radii[i - 1]))
    joints[0]["motor"] = {"target_velocity": 6, "max_force": 200}
    return scene("a train of gears", (-0.2, 1.9, 6.5), (-0.2, 1.5, 0), bodies, joints)


def planetary():
    """Sun, three planets on a carrier, and a ring that is held: gears between pairs of shafts, by Willis's formula."""
    sun, planet = 0.5, 0.5  # pitch radii, m
    ring, height = sun + 2 * planet, 2
    bodies, joints = [ground()], []
    for i in range(36):
        a = 2 * math.pi * i / 36
        bodies.append(post(f"ring {i + 1}", ((ring + 0.08) * math.cos(a), height + (ring + 0.08) * math.sin(a), 0), bar(0.06, 0.14, 0.1),
                           orientation=turned(a)))
    bodies.append(wheel_part("sun", (0, height, 0), 0.98 * sun, 0.06, STEEL))
    bodies.append(part("carrier", (0, height, -0.2), cylinder(sun + planet + 0.1, 0.03, orientation=UPRIGHT_TO_Z), color=WOOD))
    for name in ("sun", "carrier"):
        joints.append(joint("hinge", "world", name, name=f"shaft of the {name}", anchor=[0, height, 0], axis=[0, 0, 1]))
    joints[0]["motor"] = {"target_velocity": 4, "max_force": 300}
    joints.append(joint("gear", "sun", "carrier", axis=[0, 0, 1], axis_b=[0, 0, 1], ratio=-(1 + ring / sun)))
    for i in range(3):
        a = 2 * math.pi * i / 3
        at = ((sun + planet) * math.cos(a), height + (sun + planet) * math.sin(a), 0)
        bodies.append(wheel_part(f"planet {i + 1}", at, 0.98 * planet, 0.06, CLAY))
        joints.append(joint("hinge", "carrier", f"planet {i + 1}", anchor=list(at), axis=[0, 0, 1]))
        joints.append(joint("gear", f"planet {i + 1}", "carrier", axis=[0, 0, 1], axis_b=[0, 0, 1], ratio=-(1 - ring / planet)))
    return scene("a planetary gear", (0, 2.2, 6), (0, height, 0), bodies, joints)


def rack_and_pinion():
    """A pinion driven to and fro moves a rack; a spring pulls it back."""
    bodies = [ground(), wheel_part("pinion", (0, 1.6, 0), 0.4, 0.06, STEEL), part("rack", (0, 1.1, 0), bar(1.6, 0.1, 0.06), color=WOOD)]
    joints = [joint("hinge", "world", "pinion", anchor=[0, 1.6, 0], axis=[0, 0, 1], motor={"target_velocity": 3, "max_force": 150}),
              joint("slider", "world", "rack", axis=[1, 0, 0], limits=[-1.5, 1.5], limit_frequency=1, limit_damping_ratio=0),
              joint("rack_and_pinion", "pinion", "rack", axis=[0, 0, 1], axis_b=[1, 0, 0], ratio=0.4)]
    return scene("a rack on a pinion", (0, 1.8, 5), (0, 1.4, 0), bodies, joints)


def pulley():
    """Atwood's machine, and a tackle whose ratio of two lets 10 kg balance 20 kg."""
    bodies, joints = [ground(), post("beam", (0, 4.2, 0), bar(3, 0.1, 0.2))], []
    for i, (x, light, heavy, ratio) in enumerate(((-1.6, 10, 20, 1), (1.6, 10, 20, 2))):
        for side, sign, mass in (("light", -1, light), ("heavy", 1, heavy)):
            bodies.append(part(f"{side} {i + 1}", (x + 0.7 * sign, 2, 0), bar(0.2, 0.2, 0.2), mass=mass, color=WOOD if sign < 0 else DARK))
        joints.append(joint("pulley", f"light {i + 1}", f"heavy {i + 1}", anchor=[x - 0.7, 2.2, 0], anchor_b=[x + 0.7, 2.2, 0],
                            ground_a=[x - 0.7, 4.1, 0], ground_b=[x + 0.7, 4.1, 0], ratio=ratio))
    return scene("ropes over pulleys", (0, 2.8, 9), (0, 2.2, 0), bodies, joints)


def wheel():
    """A cart on four wheels, sprung and driven, the front ones steered, over a row of sills."""
    bodies = [{**ground(40), "shapes": [bar(40, 0.5, 40)]}]
    for i in range(8):
        bodies.append(post(f"sill {i + 1}", (4 + 2.2 * i, 0.02, 0.4 if i % 2 else -0.4), bar(0.12, 0.06, 1.2)))
    bodies.append(part("chassis", (0, 0.75, 0), bar(1.2, 0.2, 0.5, density=300), color=CLAY))
    joints = []
    for name, x, z in (("front left", 0.9, -0.7), ("front right", 0.9, 0.7), ("rear left", -0.9, -0.7), ("rear right", -0.9, 0.7)):
        bodies.append({**wheel_part(name, (x, 0.4, z), 0.38, 0.1, DARK), "filter": {"layer": 2, "collides_with": 1}})
        front = name.startswith("front")
        steer = {"limits": [-0.6, 0.6], "motor": {"target_position": 0.08, "max_force": 4000, "frequency": 6}}
        joints.append(joint("wheel", "chassis", name, anchor=[x, 0.4, z], axis=[0, 1, 0], axis_b=[0, 0, 1], limits=[-0.2, 0.2],
                            stiffness=9000, damping=700, motor={"target_velocity": -9, "max_force": 0 if front else 60},
                            **({"axes": {"angular_x": steer}} if front else {})))
    return scene("a cart on sprung wheels", (6, 5, 14), (6, 0.5, 0), bodies, joints)


def path():
    """Carts on a closed track with a loop, held to it and turning with it; a bead on an open wire."""
    points = [(-6, 4.2, 0), (-4, 2.2, 0), (-2, 0.8, 0)]
    for i in range(13):
        a = 2 * math.pi * i / 12
        points.append((1.5 * math.sin(a), 2.2 - 1.5 * math.cos(a), -0.6 + 1.2 * i / 12))
    points += [(2.5, 0.8, 1), (4.5, 1.4, 0.4), (5.5, 2.2, -1.5), (4.5, 2.6, -3.4), (0, 3, -4), (-4, 3.6, -3.6), (-6.4, 4.2, -2)]
    points = [[x, y + 0.4, z] for x, y, z in points]
    bodies, joints = [ground()], []
    for i in range(3):
        x, y, z = points[-1 - i]
        bodies.append(part(f"cart {i + 1}", (x, y, z), bar(0.35, 0.15, 0.2), color=(CLAY, WOOD, STEEL)[i]))
        joints.append(joint("path", "world", f"cart {i + 1}", anchor=[x, y, z], path=points, path_closed=True, path_orientation="following",
                            motor={"target_velocity": 3, "max_force": 60}))
    wire = [[-3, 2.5, 4], [-1.5, 1.2, 4], [0, 0.8, 4], [1.5, 1.2, 4], [3, 2.5, 4]]
    bodies.append(part("bead", (-3, 2.5, 4), ball(0.18), color=DARK))
    joints.append(joint("path", "world", "bead", anchor=[-3, 2.5, 4], path=wire))
    return scene("carts on a track with a loop", (0, 5, 15), (0, 2, 0), bodies, joints)


def mouse():
    """Three bodies dragged by a point of theirs to the same height: by enough force, by little, and by too little."""
    bodies, joints = [ground()], []
    for i, force in enumerate((2000, 420, 300)):
        x = (i - 1) * 2
        bodies.append(part(f"box {i + 1}", (x, 0.3, 0), bar(0.4, 0.3, 0.3, density=140), color=(WOOD, CLAY, STEEL)[i], angular_damping=1))
        joints.append(joint("mouse", "world", f"box {i + 1}", anchor=[x + 0.4, 0.6, 0], drive={"position": [0, 1.5, 0], "frequency": 2, "max_force": force}))
    return scene("boxes dragged by a corner", (0, 2, 7), (0, 1.2, 0), bodies, joints)


def motor():
    """Plates held in the air at a pose by motors, weak and strong, and balls that fall on them."""
    bodies, joints = [ground()], []
    for i, (force, torque, frequency) in enumerate(((3000, 800, 0), (3000, 800, 2), (600, 30, 4))):
        x = (i - 1) * 2.4
        bodies.append({"name": f"plate {i + 1}", "position": [x, 1.5, 0], "color": (STEEL, WOOD, CLAY)[i], "shapes": [bar(0.9, 0.06, 0.9, density=250)]})
        joints.append(joint("motor", "world", f"plate {i + 1}", anchor=[x, 1.5, 0],
                            drive={"orientation": {"axis": [0, 0, 1], "angle": 0.15}, "frequency": frequency, "max_force": force, "max_torque": torque}))
        for k in range(3):
            bodies.append({"name": f"ball {i + 1} {k + 1}", "position": [x + 0.3 * (k - 1), 3 + k, 0.2 * (k - 1)], "color": DARK, "shapes": [ball(0.2)]})
    return scene("plates that motors hold", (0, 3, 9), (0, 1.8, 0), bodies, joints)


def hinge_scene():
    """Doors: free with friction, between hard and soft stops, on a spring, driven to a place and at a speed, and one that breaks off."""
    cases = (("with friction", {"friction": 8}), ("between stops", {"limits": [-0.6, 1.2]}),
             ("between soft stops", {"limits": [-0.6, 0.6], "limit_frequency": 3, "limit_damping_ratio": 0.1}),
             ("on a spring", {"stiffness": 20, "damping": 0.8}),
             ("driven to a place", {"motor": {"target_position": 1, "frequency": 0.8, "damping_ratio": 0.4, "max_force": 300}}),
             ("driven at a speed", {"motor": {"target_velocity": 2, "max_force": 100}}),
             ("that breaks off", {"limits": [-0.5, 0.5], "break_torque": 60}))
    bodies, joints = [ground()], []
    for i, (name, what) in enumerate(cases):
        x = (i - 3) * 2
        bodies.append(post(f"post {i + 1}", (x - 0.75, 1, 0), bar(0.06, 1, 0.06)))
        bodies.append(part(f"door {name}", (x - 0.05, 1, 0), bar(0.6, 0.8, 0.03, density=300), color=(WOOD, CLAY)[i % 2],
                           angular_velocity=[0, 3, 0], linear_velocity=[0, 0, -2.1]))
        joints.append(joint("hinge", f"post {i + 1}", f"door {name}", anchor=[x - 0.75, 1, 0], axis=[0, 1, 0], **what))
    return scene("doors", (0, 5.5, 13), (0, 0.8, 0), bodies, joints)


def slider():
    """Sledges on rails: free with friction, between hard and soft stops, on a spring, driven to a place and at a speed, and a lift."""
    cases = (("with friction", {"friction": 60}), ("between stops", {"limits": [-1, 1.5]}),
             ("between soft stops", {"limits": [-1, 1], "limit_frequency": 2, "limit_damping_ratio": 0.1}),
             ("on a spring", {"stiffness": 600, "damping": 12}),
             ("driven to a place", {"motor": {"target_position": 1.5, "frequency": 0.7, "damping_ratio": 0.5, "max_force": 2000}}),
             ("driven at a speed", {"limits": [-3, 3], "motor": {"target_velocity": 1, "max_force": 400}}))
    bodies, joints = [ground()], []
    for i, (name, what) in enumerate(cases):
        z = (i - 2.5) * 1.2
        bodies.append(post(f"rail {i + 1}", (0, 0.2, z), bar(4, 0.05, 0.05)))
        bodies.append(part(f"sledge {name}", (0, 0.5, z), bar(0.4, 0.2, 0.3, density=200), color=(WOOD, CLAY)[i % 2], linear_velocity=[3, 0, 0]))
        joints.append(joint("slider", f"rail {i + 1}", f"sledge {name}", axis=[1, 0, 0], **what))
    bodies.append(part("lift", (5.5, 0.6, 0), bar(0.7, 0.08, 0.7, density=300), color=STEEL))
    joints.append(joint("slider", "world", "lift", axis=[0, 1, 0], limits=[0, 2.5], motor={"target_velocity": 0.6, "max_force": 6000}))
    bodies.append(part("load", (5.5, 0.95, 0), bar(0.25, 0.25, 0.25), color=DARK, filter={"layer": 1}))
    bodies[-2]["filter"] = {"layer": 1}
    return scene("sledges on rails, and a lift", (1, 6, 11), (1, 0.4, 0), bodies, joints)


def fixed():
    """Beams of ten welded boxes out of a wall: one holds, one breaks under its weight; and a column under a hundred times its boxes."""
    bodies, joints = [ground(), post("wall", (-5.2, 2, 0), bar(0.2, 2, 2))], []
    for name, z, strength in (("strong", -0.8, None), ("weak", 0.8, 120)):
        for i in range(10):
            bodies.append(part(f"{name} {i + 1}", (-4.8 + 0.4 * i, 3, z), bar(0.2, 0.15, 0.15, density=300), color=WOOD if strength is None else CLAY))
            joints.append(joint("fixed", f"{name} {i}" if i else "wall", f"{name} {i + 1}", anchor=[-5 + 0.4 * i, 3, z],
                                **({} if strength is None else {"break_torque": strength})))
    for i in range(8):
        bodies.append(part(f"column {i + 1}", (3, 0.25 + 0.5 * i, 0), bar(0.25, 0.25, 0.25, density=8), color=STEEL))
        joints.append(joint("fixed", f"column {i}" if i else "ground", f"column {i + 1}", anchor=[3, 0.5 * i, 0]))
    bodies.append(part("load", (3.1, 4.5, 0), bar(0.5, 0.5, 0.5, density=100), color=DARK))
    joints.append(joint("fixed", "column 8", "load", anchor=[3, 4, 0]))
    return scene("welded beams and a column", (0, 3, 12), (-0.5, 2, 0), bodies, joints)


def distance():
    """Weights on a rod, a rope, a rope with a least length, springs by stiffness and by frequency, and a rope that breaks."""
    cases = (("rod", {}), ("rope", {"max_length": 2.2}), ("between two lengths", {"min_length": 1, "max_length": 2.2}),
             ("spring by stiffness", {"length": 1.2, "stiffness": 60, "damping": 1}),
             ("spring by frequency", {"length": 1.2, "frequency": 1.5, "damping_ratio": 0.05}),
             ("rope that breaks", {"max_length": 2.2, "break_force": 60}))
    bodies, joints = [ground(), post("beam", (0, 5, 0), bar(6, 0.1, 0.3))], []
    for i, (name, what) in enumerate(cases):
        x = (i - 2.5) * 2
        bodies.append(part(f"on a {name}", (x + 1.2, 3.8, 0), ball(0.2), mass=4, color=(WOOD, CLAY)[i % 2], angular_damping=2))
        joints.append(joint("distance", "beam", f"on a {name}", name=name, anchor=[x, 4.9, 0], anchor_b=[x + 1.2, 3.8, 0], **what))
    return scene("rods, ropes and springs", (0, 3, 12), (0, 3, 0), bodies, joints)


def ball_scene():
    """A mobile: bars in balance on ball joints; and a pair of balls whose friction brakes them."""
    bodies, joints = [ground(), post("beam", (0, 5, 0), bar(3, 0.1, 0.3))], []
    weights = iter(range(1, 5))

    def hang(x, y, reach, level, above):
        name = f"bar {level} {x:g}"
        bodies.append(part(name, (x, y, 0), bar(reach, 0.04, 0.04, density=300), color=STEEL, angular_velocity=[0, 0.5 * level, 0.1]))
        joints.append(joint("ball", above, name, anchor=[x, y + 0.4, 0]))
        for side in (-1, 1):
            if level == 1:
                hang(x + side * reach, y - 0.9, reach / 2, 2, name)
            else:
                weight = f"weight {next(weights)}"
                bodies.append(part(weight, (x + side * reach, y - 0.6, 0), ball(0.2), color=(WOOD, CLAY)[side > 0]))
                joints.append(joint("ball", name, weight, anchor=[x + side * reach, y, 0]))

    hang(0, 4.3, 1.6, 1, "beam")
    for i, friction in enumerate((0, 8)):
        x = 2.2 + 1.6 * i
        bodies.append(post(f"stand {i + 1}", (x, 0.5, 1.5), bar(0.06, 0.5, 0.06)))
        bodies.append(part(f"club {i + 1}", (x + 0.5, 1, 1.5), bar(0.5, 0.07, 0.07, density=300), color=DARK))
        joints.append(joint("ball", f"stand {i + 1}", f"club {i + 1}", anchor=[x, 1, 1.5], friction=friction))
    return scene("a mobile, and clubs with and without friction", (1, 3, 9), (0.6, 2.6, 0), bodies, joints)


hinge_scene.__name__, ball_scene.__name__ = "hinge", "ball"

ALL = (ball_scene, hinge_scene, slider, fixed, distance, chain, bridge, linkage, loop, cone, universal, spring, six_dof, gear, planetary, rack_and_pinion, pulley, wheel, path, mouse, motor)
