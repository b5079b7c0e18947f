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


ALL = [flag, rope_bridge, jelly, cloth_on_sphere, tearing_banner, integrators]
