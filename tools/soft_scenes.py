"""The scenes in scenes/soft: ropes, cloths and soft bodies. make_scenes.py writes them."""

import math

WOOD = {"density": 650, "static_friction": 0.6, "dynamic_friction": 0.5, "color": "#cf9a62"}
STEEL = {"density": 7850, "static_friction": 0.6, "dynamic_friction": 0.45, "color": "#8d99a8"}
GROUND = {"name": "ground", "type": "static", "shapes": [{"type": "plane"}], "color": "#d6d8dc"}


def scene(name, eye, target, bodies, **more):
    return {"gyre_scene": 1, "name": name, "world": more.pop("world", {"substeps": 4}),
            "view": {"eye": eye, "target": target, "field_of_view": 0.6}, "bodies": bodies, **more}


def flag():
    columns, rows = 32, 16
    pole = {"name": "pole", "type": "static", "position": [-1.04, 1.5, 0], "color": "#8d99a8",
            "shapes": [{"type": "cylinder", "radius": 0.03, "half_height": 1.6}]}
    # The edge at the pole, row by row; the grid stands upright.
    edge = [{"vertex": row * (columns + 1), "body": "pole"} for row in range(rows + 1)]
    cloth = {"name": "flag", "grid": {"size": [2, 1], "cells": [columns, rows]}, "position": [0, 2.5, 0],
             "orientation": {"axis": [1, 0, 0], "angle": math.pi / 2}, "links": "springs", "area_density": 0.15,
             "stretch_stiffness": 2000, "shear_stiffness": 50, "bend_stiffness": 2e-5, "damping": 0.002, "color": "#b9674c",
             "pinned_to": edge}
    wind = {"type": "wind", "velocity": [7, 0, 1.5], "turbulence": 0.25, "turbulence_length": 2}
    return scene("a flag in the wind", [1.5, 2.6, 6], [0.1, 1.9, 0], [GROUND, pole], cloths=[cloth], force_fields=[wind])


def rope_bridge():
    planks, step, high, width = 15, 0.5, 2.0, 0.7
    half = 0.5 * step * (planks + 1)
    bodies = [GROUND]
    for side, x in (("left", -1), ("right", 1)):
        bodies.append({"name": f"{side} bank", "type": "static", "position": [x * (half + 1), high / 2 - 0.05, 0], "color": "#9db98b",
                       "shapes": [{"type": "box", "half_extents": [1, high / 2, 1]}]})
    # Two ropes on each side run along the tops of the planks: one holds their near edges, the other their far edges, so that none tips.
    segments = 4 * (planks + 1)
    for k in range(planks):
        x = -half + (k + 1) * step
        bodies.append({"name": f"plank {k + 1}", "position": [x, high - 0.03, 0], "color": ("#cf9a62", "#b98250", "#dcae7a")[k % 3],
                       "shapes": [{"type": "box", "half_extents": [0.2, 0.025, width], "material": "wood"}]})
    bodies.append({"name": "ball", "position": [-half + 1.5, high + 0.1, 0], "linear_velocity": [0.5, 0, 0], "color": "#666b78",
                   "shapes": [{"type": "sphere", "radius": 0.25, "density": 400, "rolling_friction": 0.02}]})
    ropes = []
    for side, z in (("near", width), ("far", -width)):
        for edge, shift in (("left", -1), ("right", 1)):
            at = z + 0.02 * shift
            ropes.append({"name": f"{side} rope of the {edge} edges", "points": [[-half, high, at], [half, high, at]], "segments": segments,
                          "radius": 0.02, "linear_density": 0.4, "links": "springs", "stretch_stiffness": 20000, "damping": 0.01,
                          "color": "#cbb994", "attach": [{"end": 0, "body": "left bank"}, {"end": 1, "body": "right bank"}],
                          "pinned_to": [{"vertex": 4 * (k + 1) + shift, "body": f"plank {k + 1}"} for k in range(planks)]})
    return scene("a rope bridge", [4, 4.4, 9], [0, 1.6, 0], bodies, materials={"wood": WOOD}, ropes=ropes)


def jelly():
    block = {"name": "jelly", "box": {"half_extents": [0.5, 0.4, 0.5], "cells": [6, 5, 6]}, "position": [0, 0.42, 0], "density": 1000,
             "young_modulus": 30000, "poisson_ratio": 0.45, "model": "neo_hookean", "damping": 0.01, "color": "#5fae8b"}
    ball = {"name": "ball", "position": [0.05, 1.6, 0], "color": "#8d99a8", "shapes": [{"type": "sphere", "radius": 0.25, "density": 600}]}
    return scene("a ball on a jelly", [1.6, 1.6, 3.6], [0, 0.5, 0], [GROUND, ball], soft_bodies=[block])


def tearing_banner():
    columns, rows = 28, 14
    poles = [{"name": f"{side} pole", "type": "static", "position": [1.43 * x, 1.5, 0], "color": "#8d99a8",
              "shapes": [{"type": "cylinder", "radius": 0.03, "half_height": 1.5}]} for side, x in (("left", -1), ("right", 1))]
    edges = [{"vertex": row * (columns + 1) + column, "body": pole["name"]}
             for row in range(rows + 1) for column, pole in ((0, poles[0]), (columns, poles[1]))]
    banner = {"name": "banner", "grid": {"size": [2.8, 1.4], "cells": [columns, rows]}, "position": [0, 2.2, 0],
              "orientation": {"axis": [1, 0, 0], "angle": math.pi / 2}, "links": "springs", "area_density": 0.2, "thickness": 0.01,
              "stretch_stiffness": 3000, "bend_stiffness": 2e-5, "damping": 0.005, "tear_strain": 0.18, "color": "#b9674c",
              "pinned_to": edges}
    balls = [{"name": f"ball {k + 1}", "position": [0.75 * (k - 1), 1.9 + 0.1 * k, 3 + 2 * k], "linear_velocity": [0, 2.5, -9], "color": "#666b78",
              "shapes": [{"type": "sphere", "radius": 0.16, "density": 1500}]} for k in range(3)]
    return scene("balls that tear a banner", [3.2, 2.4, 4.6], [0, 1.4, -0.3], [GROUND, *poles, *balls], cloths=[banner])


def cloth_on_sphere():
    sphere = {"name": "sphere", "type": "static", "position": [0, 0.6, 0], "color": "#8d99a8", "shapes": [{"type": "sphere", "radius": 0.6}]}
    cloth = {"name": "cloth", "grid": {"size": [2, 2], "cells": [36, 36]}, "position": [0, 1.5, 0], "links": "springs", "area_density": 0.2,
             "stretch_stiffness": 1000, "shear_stiffness": 60, "bend_stiffness": 2e-5, "damping": 0.01, "thickness": 0.01, "color": "#c67d5c"}
    return scene("a cloth falls over a sphere", [2.2, 2.4, 4], [0, 0.6, 0], [GROUND, sphere], cloths=[cloth])


# The fastest mode of a chain has w = 2 (k / m)^(1/2) = 53 rad/s. In every sub-step h explicit Euler lets it grow by (1 + (w h)^2)^(1/2).
def integrators():
    kinds = ["explicit_euler", "semi_implicit_euler", "verlet", "rk4", "implicit"]
    colors = ["#b9674c", "#cf9a62", "#9db98b", "#5b8fb9", "#7d6fa8"]
    ropes = []
    for i, (kind, color) in enumerate(zip(kinds, colors)):
        x = 1.2 * (i - 2)
        ropes.append({"name": kind.replace("_", " "), "points": [[x, 3, 0], [x, 3, 1.5]], "segments": 4, "radius": 0.03,
                      "linear_density": 0.2, "links": "springs", "stretch_stiffness": 20, "integrator": kind, "color": color,
                      "attach": [{"end": 0, "body": "world"}]})
    return scene("five integrators, one chain of springs", [0, 3.2, 10], [0, 1.6, 0], [GROUND], ropes=ropes, world={"substeps": 12})


BRICKS = ("#b9674c", "#c67d5c", "#a95a45", "#cc8a66")


def about(axis, angle):
    return {"axis": list(axis), "angle": angle}


def vertex_of(columns, column, row):
    """The number of a vertex of a grid."""
    return row * (columns + 1) + column


def curtain_through_ring():
    """A hook on a driven slider pulls a curtain through a ring by its middle."""
    cells, high, radius, bars, wire = 28, 1.6, 0.13, 16, 0.02
    middle = radius + wire
    ring = {"name": "ring", "type": "static", "position": [0, high, 0], "color": "#cfa349", "shapes": [
        {"type": "capsule", "radius": wire, "half_height": middle * math.tan(math.pi / bars),
         "position": [middle * math.cos(a), 0, middle * math.sin(a)],
         # A capsule lies along y; it is turned into the ring's tangent.
         "orientation": about([math.cos(a), 0, math.sin(a)], math.pi / 2), "static_friction": 0.1, "dynamic_friction": 0.1}
        for a in (2 * math.pi * k / bars for k in range(bars))]}
    post = {"name": "post", "type": "static", "position": [-0.65, high / 2, 0], "color": "#8d99a8", "shapes": [
        {"type": "cylinder", "radius": 0.03, "half_height": high / 2},
        {"type": "capsule", "radius": 0.02, "half_height": 0.24, "position": [0.25, high / 2, 0], "orientation": about([0, 0, 1], math.pi / 2)}]}
    hook = {"name": "hook", "position": [0, high + 0.03, 0], "mass": 1, "color": "#4d5560", "shapes": [{"type": "sphere", "radius": 0.03}]}
    slider = {"type": "slider", "a": "world", "b": "hook", "anchor": [0, high, 0], "axis": [0, 1, 0], "limits": [-1.4, 0],
              "motor": {"target_velocity": -0.2, "max_force": 200}}
    half = cells // 2
    held = [{"vertex": vertex_of(cells, half + i, half + j), "body": "hook"} for i, j in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1))]
    curtain = {"name": "curtain", "grid": {"size": [1.4, 1.4], "cells": [cells, cells]}, "position": [0, high + 0.065, 0], "links": "springs",
               "area_density": 0.2, "stretch_stiffness": 2000, "shear_stiffness": 20, "bend_stiffness": 5e-6, "damping": 0.005,
               "thickness": 0.006, "static_friction": 0.2, "color": "#7d6fa8", "pinned_to": held}
    return scene("a curtain pulled through a ring", [1.5, 2.2, 2.9], [0, 0.95, 0], [GROUND, ring, post, hook], joints=[slider], cloths=[curtain])


def cloth_on_spikes():
    places = [(0, 0)] + [(0.48 * math.cos(a), 0.48 * math.sin(a)) for a in (math.pi / 4 + math.pi / 2 * k for k in range(4))]
    spikes = [{"name": f"spike {k + 1}", "type": "kinematic", "position": [x, 0, z], "color": "#8d99a8", "shapes": [
        {"type": "cone", "radius": 0.16, "half_height": 0.45, "position": [0, 0.45, 0]},
        {"type": "sphere", "radius": 0.05, "position": [0, 0.84, 0]}]} for k, (x, z) in enumerate(places)]
    cloth = {"name": "cloth", "grid": {"size": [1.7, 1.7], "cells": [30, 30]}, "position": [0.02, 1.3, 0.03], "links": "springs",
             "area_density": 0.2, "stretch_stiffness": 2000, "shear_stiffness": 60, "bend_stiffness": 2e-5, "damping": 0.01,
             "thickness": 0.012, "color": "#5b86a8"}
    return scene("a cloth falls on five spikes", [1.7, 1.9, 2.7], [0, 0.5, 0], [GROUND, *spikes], cloths=[cloth])


def twisted_towel():
    """The upper bar turns; the lower one may only rise and sink, so that the towel winds up."""
    columns, rows, length, width, high = 16, 40, 1.6, 0.5, 2.3
    bars = [{"name": "upper bar", "type": "kinematic", "position": [0, high, 0], "angular_velocity": [0, 2, 0], "color": "#8d99a8"},
            {"name": "lower bar", "position": [0, high - length, 0], "mass": 3, "locked": {"linear": [True, False, True], "angular": [True] * 3},
             "color": "#8d99a8"}]
    for bar in bars:
        bar["shapes"] = [{"type": "capsule", "radius": 0.025, "half_height": 0.3, "orientation": about([0, 0, 1], math.pi / 2)}]
    edges = [{"vertex": vertex_of(columns, column, row), "body": bar["name"]}
             for row, bar in ((0, bars[0]), (rows, bars[1])) for column in range(columns + 1)]
    towel = {"name": "towel", "grid": {"size": [width, length], "cells": [columns, rows]}, "position": [0, high - length / 2, 0],
             "orientation": about([1, 0, 0], math.pi / 2), "links": "springs", "area_density": 0.4, "stretch_stiffness": 4000,
             "shear_stiffness": 40, "bend_stiffness": 1e-4, "damping": 0.01, "thickness": 0.01, "color": "#cf9a62", "pinned_to": edges}
    return scene("a towel is wrung out", [1.2, 1.8, 3.0], [0, 1.4, 0], [GROUND, *bars], cloths=[towel])


def sheets_on_cylinder():
    sheets, cells = 10, 8
    cylinder = {"name": "cylinder", "type": "static", "position": [0, 0.7, 0], "orientation": about([1, 0, 0], math.pi / 2), "color": "#8d99a8",
                "shapes": [{"type": "cylinder", "radius": 0.3, "half_height": 0.7}]}
    colors = ("#b9674c", "#cf9a62", "#cbb994", "#9db98b", "#5fae8b", "#5b8fb9", "#5b86a8", "#7d6fa8", "#a9749a", "#d9604a")
    cloths = [{"name": f"sheet {k + 1}", "grid": {"size": [1, 1], "cells": [cells, cells]}, "position": [0.02 * (-1) ** k, 1.1 + 0.08 * k, 0],
               "orientation": about([0, 1, 0], 0.3 * k), "links": "springs", "area_density": 0.3, "stretch_stiffness": 1000,
               "shear_stiffness": 40, "bend_stiffness": 5e-5, "damping": 0.01, "thickness": 0.016, "color": colors[k]} for k in range(sheets)]
    return scene("ten sheets fall over a cylinder", [1.8, 1.7, 2.7], [0, 0.75, 0], [GROUND, cylinder], cloths=cloths)


def bag_of_balls():
    """Four clips lift the corners of a cloth and draw them together; the balls on it stay in the bag."""
    cells, half = 24, 0.8
    clips, corners = [], []
    for k, (x, z) in enumerate(((-1, -1), (1, -1), (-1, 1), (1, 1))):
        clips.append({"name": f"clip {k + 1}", "type": "kinematic", "position": [half * x, 0.05, half * z], "color": "#4d5560",
                      "linear_velocity": [-0.045 * x, 0.2, -0.045 * z], "shapes": [{"type": "sphere", "radius": 0.03}]})
        corners.append({"vertex": vertex_of(cells, cells * (x > 0), cells * (z > 0)), "body": f"clip {k + 1}"})
    colors = ("#d9604a", "#cfa349", "#5fae8b", "#5b8fb9", "#7d6fa8")
    balls = [{"name": f"ball {k + 1}", "position": [0.175 * (k % 3 - 1), 0.145 + 0.175 * (k // 9), 0.175 * (k // 3 % 3 - 1)],
              "color": colors[k % 5], "shapes": [{"type": "sphere", "radius": 0.085, "density": 300, "rolling_friction": 0.02}]}
             for k in range(20)]
    cloth = {"name": "bag", "grid": {"size": [2 * half, 2 * half], "cells": [cells, cells]}, "position": [0, 0.05, 0], "links": "springs",
             "area_density": 0.3, "stretch_stiffness": 4000, "shear_stiffness": 80, "bend_stiffness": 5e-5, "damping": 0.01,
             "thickness": 0.012, "color": "#cbb994", "pinned_to": corners}
    return scene("a cloth lifts twenty balls", [2.0, 1.9, 3.2], [0, 0.7, 0], [GROUND, *clips, *balls], cloths=[cloth])


def rope_bridge_with_car():
    """The planks of rope_bridge closer together, and a car that drives over them."""
    planks, step, high, width = 24, 0.3, 2.0, 0.8
    half = 0.5 * step * (planks + 1)
    bodies = [GROUND]
    for side, x in (("left", -1), ("right", 1)):
        bodies.append({"name": f"{side} bank", "type": "static", "position": [x * (half + 2), high / 2 - 0.02, 0], "color": "#9db98b",
                       "shapes": [{"type": "box", "half_extents": [2, high / 2, 1.2]}]})
    for k in range(planks):
        bodies.append({"name": f"plank {k + 1}", "position": [-half + (k + 1) * step, high - 0.045, 0],
                       "color": ("#cf9a62", "#b98250", "#dcae7a")[k % 3],
                       "shapes": [{"type": "box", "half_extents": [0.135, 0.03, width], "material": "wood"}]})
    ropes, segments = [], 4 * (planks + 1)
    for side, z in (("near", width), ("far", -width)):
        for edge, shift in (("left", -1), ("right", 1)):
            at = z + 0.02 * shift
            ropes.append({"name": f"{side} rope of the {edge} edges", "points": [[-half, high, at], [half, high, at]], "segments": segments,
                          "radius": 0.02, "linear_density": 0.6, "links": "springs", "stretch_stiffness": 150000, "damping": 0.01,
                          "color": "#cbb994", "attach": [{"end": 0, "body": "left bank"}, {"end": 1, "body": "right bank"}],
                          "pinned_to": [{"vertex": 4 * (k + 1) + shift, "body": f"plank {k + 1}"} for k in range(planks)]})
    start, floor = -half - 1.4, high - 0.02
    bodies.append({"name": "car", "position": [start, floor + 0.34, 0], "color": "#d9604a", "filter": {"layer": 2, "collides_with": 1},
                   "shapes": [{"type": "box", "half_extents": [0.6, 0.11, 0.3], "density": 150},
                              {"type": "box", "half_extents": [0.3, 0.1, 0.26], "position": [-0.08, 0.2, 0], "density": 60}]})
    joints = []
    for name, x, z in (("front left", 0.42, -0.4), ("front right", 0.42, 0.4), ("rear left", -0.42, -0.4), ("rear right", -0.42, 0.4)):
        bodies.append({"name": name, "position": [start + x, floor + 0.2, z], "color": "#4d5560", "filter": {"layer": 2, "collides_with": 1},
                       "shapes": [{"type": "cylinder", "radius": 0.2, "half_height": 0.06, "orientation": about([1, 0, 0], math.pi / 2),
                                   "density": 200, "static_friction": 1, "dynamic_friction": 1}]})
        joints.append({"type": "wheel", "a": "car", "b": name, "anchor": [start + x, floor + 0.2, z], "axis": [0, 1, 0], "axis_b": [0, 0, 1],
                       "limits": [-0.06, 0.06], "stiffness": 4000, "damping": 300, "motor": {"target_velocity": -5.5, "max_force": 20}})
    return scene("a car crosses a rope bridge", [4.4, 4.6, 9.5], [0, 1.7, 0], bodies, materials={"wood": WOOD}, joints=joints, ropes=ropes)


def crane():
    """A wrecking ball on a rope, let go from the side, swings into a wall. The jib turns after it."""
    high, reach, swing, length = 4.6, 2.4, math.radians(62), 3.4
    ball = [reach, high - length * math.cos(swing), length * math.sin(swing)]
    bodies = [GROUND, {"name": "tower", "type": "static", "position": [0, high / 2, 0], "color": "#cfa349",
                       "shapes": [{"type": "box", "half_extents": [0.15, high / 2, 0.15]}]},
              {"name": "jib", "position": [0.9, high + 0.1, 0], "color": "#cfa349",
               "shapes": [{"type": "box", "half_extents": [1.6, 0.1, 0.1], "density": 400},
                          {"type": "box", "half_extents": [0.3, 0.25, 0.25], "position": [-1.5, 0, 0], "density": 2000}]},
              {"name": "wrecking ball", "position": ball, "color": "#4d5560",
               "shapes": [{"type": "sphere", "radius": 0.3, "density": 5000}]}]
    size = (0.4, 0.2, 0.2)
    for row in range(9):
        for place in range(6):
            x = reach + (place - 2.5) * size[0] + 0.15 * size[0] * (-1) ** row
            bodies.append({"name": f"brick {6 * row + place + 1}", "position": [x, size[1] * (row + 0.5), -0.35], "color": BRICKS[(place + 2 * row) % 4],
                           "shapes": [{"type": "box", "half_extents": [0.98 * size[0] / 2, size[1] / 2, size[2] / 2], "density": 1800,
                                       "static_friction": 0.7, "dynamic_friction": 0.6}]})
    joints = [{"type": "hinge", "name": "slewing ring", "a": "tower", "b": "jib", "anchor": [0, high + 0.1, 0], "axis": [0, 1, 0],
               "motor": {"target_velocity": 0.08, "max_force": 200000}}]
    # The rope ends at the surface of the ball, where it would be tied.
    end = [ball[0], ball[1] + 0.3 * math.cos(swing), ball[2] - 0.3 * math.sin(swing)]
    rope = {"name": "rope", "points": [[reach, high, 0], end], "segments": 40, "radius": 0.025, "linear_density": 1.2, "links": "springs", "stretch_stiffness": 3e6, "damping": 0.02,
            "color": "#454c57", "attach": [{"end": 0, "body": "jib"}, {"end": 1, "body": "wrecking ball"}]}
    return scene("a crane with a wrecking ball", [7.5, 4.2, 7.5], [1.4, 2.0, 0.2], bodies, joints=joints, ropes=[rope])


def jelly_stack():
    """A heavy ball on three jellies, the softest below."""
    colors, moduli = ("#5fae8b", "#cfa349", "#d9604a"), (40000, 30000, 20000)
    blocks = [{"name": f"jelly {k + 1}", "box": {"half_extents": [0.4 - 0.05 * k, 0.18, 0.4 - 0.05 * k], "cells": [5, 3, 5]},
               "position": [0, 0.19 + 0.37 * k, 0], "density": 1000, "young_modulus": moduli[k], "poisson_ratio": 0.4, "model": "neo_hookean",
               "damping": 0.02, "static_friction": 0.8, "color": colors[k]} for k in range(3)]
    ball = {"name": "heavy ball", "position": [0, 2, 0], "color": "#666b78",
            "shapes": [{"type": "sphere", "radius": 0.2, "density": 2500, "rolling_friction": 0.02}]}
    return scene("a heavy ball on a stack of jellies", [1.9, 1.7, 3.6], [0, 0.7, 0], [GROUND, ball], soft_bodies=blocks)


def untangling():
    """Two sheets that begin halfway through each other, like slotted cards, without gravity."""
    material = {"links": "springs", "area_density": 0.2, "stretch_stiffness": 1000, "shear_stiffness": 100, "bend_stiffness": 1e-3, "damping": 0.02, "thickness": 0.01}
    cloths = [{"name": "level sheet", "grid": {"size": [1, 1], "cells": [20, 20]}, "position": [0, 1, 0], "color": "#c67d5c", **material},
              {"name": "upright sheet", "grid": {"size": [1, 1], "cells": [20, 20]}, "position": [0.7, 1.01, 0.013],
               "orientation": about([1, 0, 0], math.pi / 2), "color": "#5b8fb9", **material}]
    return scene("two crossed sheets part", [1.9, 2.3, 3.2], [0.35, 1, 0], [GROUND], cloths=cloths, world={"substeps": 4, "gravity": [0, 0, 0]})


def broken_plate():
    """A brittle plate breaks over a rod; its pieces lie on each other."""
    rod = {"name": "rod", "type": "static", "position": [0, 0.4, 0], "orientation": about([1, 0, 0], math.pi / 2), "color": "#8d99a8",
           "shapes": [{"type": "cylinder", "radius": 0.05, "half_height": 0.6}]}
    plate = {"name": "plate", "box": {"half_extents": [0.6, 0.04, 0.4], "cells": [8, 2, 5]}, "position": [0.02, 1, 0.01],
             "orientation": about([0, 0, 1], 0.04), "density": 1000, "young_modulus": 1e6, "poisson_ratio": 0.3, "fracture_stress": 20000,
             "damping": 0.005, "color": "#cfa349"}
    return scene("a plate breaks over a rod", [0.9, 1.2, 3.2], [0, 0.4, 0], [GROUND, rod], soft_bodies=[plate], world={"substeps": 8})


ALL = [flag, rope_bridge, jelly, cloth_on_sphere, tearing_banner, integrators, curtain_through_ring, cloth_on_spikes, twisted_towel,
       sheets_on_cylinder, bag_of_balls, rope_bridge_with_car, crane, jelly_stack, untangling, broken_plate]
