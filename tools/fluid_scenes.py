"""The scenes in scenes/fluid: gases and liquids. make_scenes.py writes them."""

import math

from soft_scenes import GROUND, scene

AMBIENT = 293.15  # K
SMOKE, WATER, HONEY = "#e8e4dc", "#3f7fb5", "#d99a2b"
STEEL, WOOD, STONE = "#8d99a8", "#cf9a62", "#bfbbb3"


def turned(axis, angle):
    """A rotation about a coordinate axis as a quaternion."""
    out = [0.0, 0.0, 0.0, math.cos(angle / 2)]
    out[axis] = math.sin(angle / 2)
    return out


def product(p, q):
    """The rotation q, then p."""
    px, py, pz, pw = p
    qx, qy, qz, qw = q
    return [pw * qx + px * qw + py * qz - pz * qy, pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw, pw * qw - px * qx - py * qy - pz * qz]


def fan(position, speed, radius=0.6, blades=4, pitch=math.radians(40)):
    """A kinematic fan about the x axis that blows along +x: blades whose long axis is y, pitched about it, turned about the hub."""
    shapes = [{"type": "cylinder", "radius": 0.11, "half_height": 0.12, "orientation": {"axis": [0, 0, 1], "angle": math.pi / 2}}]
    half = 0.5 * (radius - 0.1)
    for k in range(blades):
        angle = 2 * math.pi * k / blades
        middle = 0.1 + half
        shapes.append({"type": "box", "half_extents": [0.045, half, 0.15],
                       "position": [0, middle * math.cos(angle), middle * math.sin(angle)],
                       "orientation": product(turned(0, angle), turned(1, -pitch))})
    return {"name": "fan", "type": "kinematic", "position": position, "angular_velocity": [speed, 0, 0], "color": STEEL, "shapes": shapes}


def smoke_fan():
    gas = {"name": "air", "bounds": [[-1.2, 0, -0.9], [1.8, 1.8, 0.9]], "cells": [40, 24, 24], "vorticity": 0.1, "color": SMOKE,
           "boundary": {"y": ["closed", "open"]},
           "emitters": [{"position": [-0.75, 0.9 + y, z], "radius": 0.12, "density": 1, "temperature": AMBIENT}
                        for y, z in ((0.35, 0), (-0.35, 0), (0, 0.35), (0, -0.35))],
           "probes": [{"name": "behind", "position": [-0.8, 0.9, 0]}, {"name": "before", "position": [0.6, 1.25, 0]}]}
    return scene("smoke through a turning fan", [2.2, 1.9, 4.2], [0.3, 0.8, 0], [GROUND, fan([-0.3, 0.9, 0], 14)], gases=[gas])


def candle():
    wax = {"name": "candle", "type": "static", "position": [0, 0.1, 0], "color": "#efe6d2",
           "shapes": [{"type": "cylinder", "radius": 0.05, "half_height": 0.1}]}
    vane = {"name": "vane", "position": [0.02, 0.83, 0], "color": "#b9674c", "can_sleep": False,
            "shapes": [{"type": "box", "half_extents": [0.015, 0.12, 0.08], "density": 10}]}
    hinge = {"type": "hinge", "a": "world", "b": "vane", "anchor": [0.02, 0.95, 0], "axis": [0, 0, 1]}
    gas = {"name": "air", "bounds": [[-0.3, 0, -0.3], [0.3, 1.2, 0.3]], "cells": [24, 48, 24], "vorticity": 0.2, "color": SMOKE,
           "boundary": {"y": ["closed", "open"]},
           "emitters": [{"position": [0, 0.24, 0], "radius": 0.045, "density": 0.6, "temperature": 480}],
           "probes": [{"name": "plume", "position": [0, 0.6, 0]}]}
    return scene("the warm plume of a candle", [0.7, 0.9, 1.9], [0, 0.55, 0], [GROUND, wax, vane],
                 joints=[hinge], gases=[gas])


def flag_in_fan_wind():
    columns, rows = 16, 12
    pole = {"name": "pole", "type": "static", "position": [0.35, 0.8, 0], "color": STEEL,
            "shapes": [{"type": "cylinder", "radius": 0.03, "half_height": 0.8}]}
    edge = [{"vertex": row * (columns + 1), "body": "pole"} for row in range(rows + 1)]
    cloth = {"name": "flag", "grid": {"size": [0.8, 0.6], "cells": [columns, rows]}, "position": [0.79, 1.1, 0],
             "orientation": {"axis": [1, 0, 0], "angle": math.pi / 2}, "links": "springs", "area_density": 0.04,
             "stretch_stiffness": 400, "shear_stiffness": 10, "bend_stiffness": 2e-6, "damping": 0.002, "color": "#b9674c", "pinned_to": edge}
    gas = {"name": "air", "bounds": [[-1.2, 0, -0.9], [1.8, 1.8, 0.9]], "cells": [40, 24, 24], "color": SMOKE,
           "boundary": {"y": ["closed", "open"]},
           "emitters": [{"position": [-0.75, 1.1, 0.2], "radius": 0.15, "density": 0.5, "temperature": AMBIENT}],
           "probes": [{"name": "at the pole", "position": [0.2, 1.2, 0.3]}]}
    return scene("a flag in the wind of a fan", [2.4, 1.9, 4.2], [0.3, 0.9, 0], [GROUND, fan([-0.4, 1.0, 0], 16), pole],
                 cloths=[cloth], gases=[gas])


def fire_and_wind_on_a_flag():
    """A fan bends the flame of a burner towards a flag."""
    columns, rows = 14, 10
    pole = {"name": "pole", "type": "static", "position": [0.3, 0.8, 0], "color": STEEL,
            "shapes": [{"type": "cylinder", "radius": 0.03, "half_height": 0.8}]}
    burner = {"name": "burner", "type": "static", "position": [-0.05, 0.1, 0], "color": "#4d5560",
              "shapes": [{"type": "cylinder", "radius": 0.12, "half_height": 0.1}]}
    edge = [{"vertex": row * (columns + 1), "body": "pole"} for row in range(rows + 1)]
    cloth = {"name": "flag", "grid": {"size": [0.8, 0.6], "cells": [columns, rows]}, "position": [0.74, 1.2, 0],
             "orientation": {"axis": [1, 0, 0], "angle": math.pi / 2}, "links": "springs", "area_density": 0.04,
             "stretch_stiffness": 400, "shear_stiffness": 10, "bend_stiffness": 2e-6, "damping": 0.002, "color": "#5b86a8", "pinned_to": edge}
    gas = {"name": "air", "bounds": [[-1.2, 0, -0.9], [1.8, 1.8, 0.9]], "cells": [40, 24, 24], "vorticity": 0.15, "color": "#6b6660",
           "boundary": {"y": ["closed", "open"]},
           "combustion": {"ignition_temperature": 550, "burn_rate": 6, "heat_release": 4.6e7, "smoke_yield": 2},
           "emitters": [{"position": [-0.05, 0.3, 0], "radius": 0.13, "density": 0, "temperature": 900, "fuel": 0.03}],
           "probes": [{"name": "flame", "position": [0.1, 0.6, 0]}, {"name": "at the flag", "position": [0.7, 1.2, 0]}]}
    return scene("fire and wind on a flag", [1.9, 1.5, 3.2], [0.2, 0.85, 0], [GROUND, fan([-0.5, 0.9, 0], 20), burner, pole],
                 cloths=[cloth], gases=[gas])


# The inflow is a column of emitters that hold the velocity; every other one has smoke. Re = U D / nu = 150.
def vortex_street():
    long, high, speed, diameter = 4.0, 1.5, 1.0, 0.3
    cylinder = {"name": "cylinder", "type": "static", "position": [0.8, 0.51 * high, 0.025], "color": STEEL,
                "shapes": [{"type": "cylinder", "radius": diameter / 2, "half_height": 0.1,
                            "orientation": {"axis": [1, 0, 0], "angle": math.pi / 2}}]}
    count = 15
    inflow = [{"position": [0.05, (k + 0.5) * high / count, 0.025], "radius": 0.09, "density": k % 2, "temperature": AMBIENT,
               "velocity": [speed, 0, 0]} for k in range(count)]
    gas = {"name": "air", "bounds": [[0, 0, 0], [long, high, 0.05]], "cells": [112, 42, 1], "viscosity": 1.2 * speed * diameter / 150,
           "boundary": {"y": "closed", "z": "closed"}, "initial_velocity": [speed, 0, 0], "color": SMOKE, "emitters": inflow,
           "probes": [{"name": "wake", "position": [2, 0.75, 0.025]}, {"name": "ahead", "position": [0.3, 0.75, 0.025]}]}
    return scene("vortices behind a cylinder", [2, 0.75, 4.2], [2, 0.75, 0], [cylinder], gases=[gas],
                 world={"gravity": [0, 0, 0], "substeps": 4})


# Re = U L / nu = 400. Smoke that is held for a second shows the motion.
def lid_driven_cavity():
    gas = {"name": "air", "bounds": [[0, 0, 0], [1, 1, 0.02]], "cells": [48, 48, 1], "density": 1.2, "viscosity": 1.2 / 400,
           "boundary": {"x": "no_slip", "y": "no_slip", "z": "closed"}, "walls": {"+y": {"velocity": [1, 0, 0]}}, "color": SMOKE,
           "emitters": [{"position": [0.5, 0.85, 0.01], "radius": 0.1, "density": 1, "temperature": AMBIENT, "end": 1}],
           "probes": [{"name": "lower", "position": [0.5, 0.25, 0.01]}, {"name": "middle", "position": [0.5, 0.5, 0.01]},
                      {"name": "upper", "position": [0.5, 0.75, 0.01]}]}
    return scene("a lid drives the air in a box", [0.5, 0.5, 2.2], [0.5, 0.5, 0], [], gases=[gas],
                 world={"gravity": [0, 0, 0], "substeps": 1})


def basin(low, high, top):
    """Walls round a box in x and z, so that bodies stay where the liquid does."""
    thick = 0.1
    (x0, z0), (x1, z1) = low, high
    xm, zm, hx, hz = (x0 + x1) / 2, (z0 + z1) / 2, (x1 - x0) / 2, (z1 - z0) / 2
    walls = (("left wall", x0 - thick, zm, thick, hz), ("right wall", x1 + thick, zm, thick, hz),
             ("back wall", xm, z0 - thick, hx + 2 * thick, thick), ("front wall", xm, z1 + thick, hx + 2 * thick, thick))
    return [{"name": name, "type": "static", "position": [x, top / 2, z], "color": STONE,
             "shapes": [{"type": "box", "half_extents": [ex, top / 2, ez], "static_friction": 0.2}]} for name, x, z, ex, ez in walls]


def crate(name, position, half, density, color=WOOD):
    return {"name": name, "position": position, "color": color,
            "shapes": [{"type": "box", "half_extents": [half, half, half], "density": density, "static_friction": 0.4}]}


def dam_break():
    crates = [crate(f"crate {4 * k + i + 1}", [2.0 + 0.3 * k, 0.1 + 0.205 * i, 0.4 + 0.25 * (k - 1)], 0.1, density,
                    ("#cf9a62", "#b98250", "#dcae7a")[i % 3])
              for k, density in enumerate((300, 500, 800)) for i in range(3)]
    water = {"name": "water", "bounds": [[0, 0, 0], [3.2, 1.6, 0.8]], "cell_size": 0.08, "color": WATER,
             "fill": [{"box": [[0, 0, 0], [0.8, 1.2, 0.8]]}],
             "probes": [{"name": "behind the dam", "position": [0.2, 0.1, 0.4]}, {"name": "far wall", "position": [3.1, 0.1, 0.4]}]}
    return scene("a dam breaks over crates", [2.6, 2.4, 4.6], [1.5, 0.5, 0.4], [GROUND, *basin((0, 0), (3.2, 0.8), 0.6), *crates],
                 liquids=[water])


def harbour():
    level, half = 0.625, 0.14
    boxes = [crate(name, [x, level + half * (1 - 2 * density / 1000), z], half, density, color)  # at the draft of Archimedes
             for name, x, z, density, color in (("cork", 0.5, 0.5, 200, "#dcae7a"), ("pine", 0.5, 1.5, 500, WOOD),
                                                ("oak", 1.0, 0.5, 800, "#8a5a33"), ("ice", 1.0, 1.5, 917, "#bfe3f2"))]
    boxes.append(crate("stone", [1.5, 0.6, 0.35], half, 2600, STONE))
    ship = {"name": "ship", "position": [2.4, 0.56, 1], "color": "#7c4a2d",
            "shapes": [{"type": "box", "half_extents": [0.7, 0.06, 0.3], "density": 900},
                       {"type": "box", "half_extents": [0.7, 0.12, 0.05], "position": [0, 0.18, 0.25], "density": 300},
                       {"type": "box", "half_extents": [0.7, 0.12, 0.05], "position": [0, 0.18, -0.25], "density": 300},
                       {"type": "box", "half_extents": [0.05, 0.12, 0.2], "position": [0.65, 0.18, 0], "density": 300},
                       {"type": "box", "half_extents": [0.05, 0.12, 0.2], "position": [-0.65, 0.18, 0], "density": 300},
                       {"type": "box", "half_extents": [0.15, 0.14, 0.15], "position": [-0.35, 0.2, 0], "density": 200}]}
    water = {"name": "harbour", "bounds": [[0, 0, 0], [3.5, 1.25, 2]], "cell_size": 0.125, "color": WATER,
             "fill": [{"box": [[0, 0, 0], [3.5, 0.625, 2]]}], "probes": [{"name": "level", "position": [1.9, 0.3, 1.8]}]}
    return scene("a ship and boxes in a harbour", [3.2, 2.6, 5.4], [1.7, 0.5, 1], [GROUND, *basin((0, 0), (3.5, 2), 1.0), ship, *boxes],
                 liquids=[water])


# Small, as honey is: a block of a metre would run apart as fast as water.
def honey():
    ball = {"name": "ball", "type": "static", "position": [0.12, 0.044, 0.12], "color": STONE,
            "shapes": [{"type": "sphere", "radius": 0.044}]}
    syrup = {"name": "honey", "bounds": [[0, 0, 0], [0.24, 0.24, 0.24]], "cell_size": 0.01, "density": 1400, "viscosity": 200,
             "surface_tension": 0.06, "color": HONEY, "boundary": "no_slip", "fill": [{"box": [[0.08, 0.12, 0.08], [0.16, 0.22, 0.16]]}]}
    return scene("honey runs over a ball", [0.38, 0.3, 0.6], [0.12, 0.08, 0.12], [GROUND, ball], liquids=[syrup])


def communicating_vessels():
    divider = {"name": "divider", "type": "static", "position": [1, 0.7, 0.1], "color": STONE,
               "shapes": [{"type": "box", "half_extents": [0.05, 0.5, 0.2]}]}
    water = {"name": "water", "bounds": [[0, 0, 0], [2, 1.2, 0.2]], "cell_size": 0.05, "color": WATER,
             "fill": [{"box": [[0, 0, 0], [0.95, 0.9, 0.2]]}, {"box": [[0.95, 0, 0], [2, 0.2, 0.2]]}],
             "probes": [{"name": "left", "position": [0.5, 0.1, 0.1]}, {"name": "right", "position": [1.5, 0.1, 0.1]}]}
    return scene("communicating vessels", [1.2, 1.1, 3.2], [1, 0.5, 0.1], [GROUND, divider], liquids=[water])


def five_densities():
    level, half = 0.4, 0.12
    boxes = [crate(f"{density} kg/m^3", [0.3 + 0.35 * k, level + half * (1 - 2 * density / 1000), 0.3], half, density, color)
             for k, (density, color) in enumerate(((100, "#efe6d2"), (300, "#dcae7a"), (500, WOOD), (700, "#b98250"), (900, "#8a5a33")))]
    water = {"name": "water", "bounds": [[0, 0, 0], [2, 0.8, 0.6]], "cell_size": 0.05, "color": WATER,
             "fill": [{"box": [[0, 0, 0], [2, level, 0.6]]}], "probes": [{"name": "level", "position": [0.05, 0.2, 0.05]}]}
    return scene("five boxes, each as deep as its density says", [1.6, 1.2, 2.6], [1, 0.35, 0.3],
                 [GROUND, *basin((0, 0), (2, 0.6), 0.55), *boxes], liquids=[water])


# Six cups on a wheel that turns: each is dipped, lifted full, and emptied at the top.
def scoop_wheel():
    shapes = [{"type": "cylinder", "radius": 0.08, "half_height": 0.3, "orientation": {"axis": [1, 0, 0], "angle": math.pi / 2}}]
    arm, wide, deep, thin = 0.5, 0.11, 0.09, 0.03
    for k in range(6):
        angle = 2 * math.pi * k / 6
        turn = turned(2, angle)

        def place(x, y):
            return [x * math.cos(angle) - y * math.sin(angle), x * math.sin(angle) + y * math.cos(angle)]

        # In the frame of the cup, x leads out from the hub and the cup opens along +y, the way it moves.
        for x, y, z, ex, ey, ez in ((arm / 2 - 0.05, 0, 0, arm / 2 - 0.05, 0.02, 0.04), (arm, -deep, 0, wide, thin, 0.2),
                                    (arm - wide, 0, 0, thin, deep, 0.2), (arm + wide, 0, 0, thin, deep, 0.2),
                                    (arm, 0, 0.2, wide, deep, thin), (arm, 0, -0.2, wide, deep, thin)):
            shapes.append({"type": "box", "half_extents": [ex, ey, ez], "position": [*place(x, y), z], "orientation": turn})
    wheel = {"name": "wheel", "type": "kinematic", "position": [1, 0.85, 0.4], "angular_velocity": [0, 0, 1.2], "color": WOOD, "shapes": shapes}
    water = {"name": "water", "bounds": [[0, 0, 0], [2, 1.6, 0.8]], "cell_size": 0.05, "color": WATER,
             "fill": [{"box": [[0, 0, 0], [2, 0.45, 0.8]]}], "probes": [{"name": "level", "position": [0.1, 0.2, 0.1]}]}
    return scene("cups on a wheel dip into water and lift it", [2.4, 1.7, 3.6], [1, 0.7, 0.4],
                 [GROUND, *basin((0, 0), (2, 0.8), 0.6), wheel], liquids=[water])


def all_matter():
    """Rigid bodies, a rope, a cloth, a solid, a liquid and a gas that burns, side by side."""
    flag_at, columns, rows = (-2.2, 1.5, -0.3), 14, 8
    pole = {"name": "pole", "type": "static", "position": [flag_at[0] - 0.54, 0.95, flag_at[2]], "color": STEEL,
            "shapes": [{"type": "cylinder", "radius": 0.03, "half_height": 0.95}]}
    flag = {"name": "flag", "grid": {"size": [1, 0.6], "cells": [columns, rows]}, "position": list(flag_at),
            "orientation": {"axis": [1, 0, 0], "angle": math.pi / 2}, "area_density": 0.15, "stretch_stiffness": 2000, "shear_stiffness": 50,
            "bend_stiffness": 2e-5, "damping": 0.002, "color": "#b9674c",
            "pinned_to": [{"vertex": row * (columns + 1), "body": "pole"} for row in range(rows + 1)]}
    wind = {"type": "wind", "velocity": [6, 0, 1.2], "turbulence": 0.25, "turbulence_length": 1, "bounds": [[-3, 0.8, -1.2], [-1.2, 2.2, 0.6]]}
    jelly = {"name": "jelly", "box": {"half_extents": [0.3, 0.22, 0.3], "cells": [4, 3, 4]}, "position": [-0.95, 0.23, 0.35],
             "young_modulus": 20000, "poisson_ratio": 0.4, "damping": 0.01, "color": "#5fae8b"}
    ball = {"name": "ball", "position": [-0.93, 1.1, 0.35], "color": "#666b78", "shapes": [{"type": "sphere", "radius": 0.15, "density": 1500}]}
    gallows = {"name": "gallows", "type": "static", "position": [0, 0, -0.9], "color": "#cfa349",
               "shapes": [{"type": "box", "half_extents": [0.05, 1, 0.05], "position": [-0.55, 1, 0]},
                          {"type": "box", "half_extents": [0.35, 0.05, 0.05], "position": [-0.25, 2, 0]}]}
    weight = {"name": "weight", "position": [0.82, 1.62, -0.9], "color": "#4d5560", "shapes": [{"type": "sphere", "radius": 0.16, "density": 3000}]}
    rope = {"name": "rope", "points": [[0, 1.95, -0.9], [0.67, 1.68, -0.9]], "segments": 20, "linear_density": 0.5, "color": "#cbb994",
            "attach": [{"end": 0, "body": "gallows"}, {"end": 1, "body": "weight"}]}
    bricks = [{"name": f"brick {4 * row + k + 1}", "position": [-0.15, 0.1 + 0.2 * row, -1.4 + 0.33 * k], "color": WOOD if (k + row) % 2 else "#b98250",
               "shapes": [{"type": "box", "half_extents": [0.08, 0.1, 0.16], "density": 650}]} for row in range(7) for k in range(4)]
    basin_walls = basin((0.5, 0), (1.7, 0.8), 0.5)
    crates = [crate(f"crate {k + 1}", [0.85 + 0.3 * k, 0.75 + 0.1 * k, 0.4], 0.1, 400) for k in range(3)]
    water = {"name": "water", "bounds": [[0.5, 0, 0], [1.7, 0.8, 0.8]], "cell_size": 0.08, "color": WATER, "fill": [{"box": [[0.5, 0, 0], [1.1, 0.6, 0.8]]}]}
    burner = {"name": "burner", "type": "static", "position": [2.6, 0.08, 0.2], "color": "#4d5560",
              "shapes": [{"type": "cylinder", "radius": 0.12, "half_height": 0.08}]}
    air = {"name": "air", "bounds": [[2.1, 0, -0.3], [3.1, 1.8, 0.7]], "cells": [16, 28, 16], "vorticity": 0.2, "color": "#6b6660",
           "boundary": {"y": ["closed", "open"]},
           "combustion": {"ignition_temperature": 550, "burn_rate": 4, "heat_release": 4.6e7, "smoke_yield": 4},
           "emitters": [{"position": [2.6, 0.24, 0.2], "radius": 0.1, "density": 0, "temperature": 700, "fuel": 0.02}]}
    return scene("one of each kind of matter", [0.9, 2.9, 7.2], [0.25, 0.75, -0.2],
                 [GROUND, pole, ball, gallows, weight, *bricks, *basin_walls, *crates, burner],
                 ropes=[rope], cloths=[flag], soft_bodies=[jelly], gases=[air], liquids=[water], force_fields=[wind])


GASES = [smoke_fan, candle, flag_in_fan_wind, fire_and_wind_on_a_flag, vortex_street, lid_driven_cavity]
LIQUIDS = [dam_break, harbour, honey, communicating_vessels, five_densities, scoop_wheel]
ALL = GASES + LIQUIDS + [all_matter]
