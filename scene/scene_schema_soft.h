// The part of the schema that is about ropes, cloths and soft bodies, after that of joints: scene_schema.cpp puts it there.
#pragma once

namespace gyre {

inline constexpr char kSchemaOfRopes[] = R"json(    "factor_or_null": { "type": ["number", "null"], "minimum": 0, "maximum": 1e6 },
    "stiffness": { "type": "number", "minimum": 0, "maximum": 1e12 },
    "amount": { "type": "number", "exclusiveMinimum": 0, "maximum": 1e12 },
    "soft_integrator": {
      "enum": ["implicit", "explicit_euler", "semi_implicit_euler", "rk4", "verlet", "sdirk2", "visual"],
      "default": "implicit",
      "description": "of its own vertices; that of the world is of bodies"
    },
    "soft_state": {
      "type": ["object", "null"],
      "additionalProperties": false,
      "description": "where all the vertices are at the start, and how they move; the shape at rest stays that of the rest. Without: at rest, still",
      "properties": {
        "positions": { "type": ["array", "null"], "items": { "$ref": "#/$defs/vector" }, "description": "m, in the world" },
        "velocities": { "type": ["array", "null"], "items": { "$ref": "#/$defs/vector" }, "description": "m/s" }
      }
    },
    "pinned": {
      "type": ["array", "null"],
      "items": { "$ref": "#/$defs/index" },
      "description": "vertices that stay where they are at the start"
    },
    "pinned_to": {
      "type": ["array", "null"],
      "description": "vertices, or points of triangles and tetrahedra, that keep their place in the frame of a body, or in the world",
      "items": {
        "type": "object",
        "required": ["body"],
        "additionalProperties": false,
        "properties": {
          "vertex": { "$ref": "#/$defs/index" },
          "point": { "$ref": "#/$defs/vector", "description": "instead of a vertex, m in the world: the point of the cloth or soft body that is nearest to this, at most an edge away" },
          "body": { "type": "string", "description": "a body, or world" }
        },
        "oneOf": [{ "required": ["vertex"] }, { "required": ["point"] }]
      }
    },
    "rope": {
      "type": "object",
      "required": ["name", "points"],
      "additionalProperties": false,
      "properties": {
        "name": { "$ref": "#/$defs/name", "description": "unique over bodies, ropes, cloths, soft bodies, gases and liquids" },
        "points": { "type": "array", "items": { "$ref": "#/$defs/vector" }, "minItems": 2, "description": "m, in the world" },
        "segments": {
          "type": ["integer", "null"], "minimum": 1, "maximum": 1048575,
          "description": "left out, or one less than the points: the points are the vertices; else vertices lie evenly along the line"
        },
        "radius": { "$ref": "#/$defs/stiffness", "default": 0.02, "description": "m" },
        "linear_density": { "$ref": "#/$defs/amount", "default": 0.1, "description": "kg/m" },
        "links": { "enum": ["springs", "rods"], "default": "rods", "description": "springs: Hooke's; rods: edges keep their length" },
        "stretch_stiffness": { "$ref": "#/$defs/stiffness", "default": 1e4, "description": "EA in N; rods do not ask for it" },
        "bend_stiffness": { "$ref": "#/$defs/stiffness", "default": 0, "description": "EI in N m^2" },
        "integrator": { "$ref": "#/$defs/soft_integrator" },
        "damping": { "$ref": "#/$defs/factor", "default": 0, "description": "s: stress grows by damping times its rate of change" },
        "static_friction": { "$ref": "#/$defs/factor", "default": 0.4 },
        "dynamic_friction": { "$ref": "#/$defs/factor_or_null", "default": null, "description": "null: the static one" },
        "state": { "$ref": "#/$defs/soft_state" },
        "pinned": { "$ref": "#/$defs/pinned" },
        "pinned_to": { "$ref": "#/$defs/pinned_to" },
        "color": { "$ref": "#/$defs/color" },
        "attach": {
          "type": ["array", "null"],
          "description": "an end keeps its place in the frame of a body, or in the world, and turns freely",
          "items": {
            "type": "object",
            "required": ["end", "body"],
            "additionalProperties": false,
            "properties": { "end": { "enum": [0, 1] }, "body": { "type": "string", "description": "a body, or world" } }
          }
        }
      }
    },
)json";

inline constexpr char kSchemaOfCloths[] = R"json(    "cloth": {
      "type": "object",
      "required": ["name"],
      "anyOf": [{ "required": ["mesh"] }, { "required": ["grid"] }],
      "additionalProperties": false,
      "properties": {
        "name": { "$ref": "#/$defs/name", "description": "unique over bodies, ropes, cloths, soft bodies, gases and liquids" },
        "mesh": { "type": ["string", "null"], "description": "a mesh of the scene; its vertices keep their numbers" },
        "grid": {
          "type": ["object", "null"],
          "required": ["size", "cells"],
          "additionalProperties": false,
          "description": "in the x-z plane; vertex i + j (cells[0] + 1) is at (i size[0] / cells[0] - size[0] / 2, 0, j size[1] / cells[1] - size[1] / 2)",
          "properties": {
            "size": { "type": "array", "items": { "$ref": "#/$defs/amount" }, "minItems": 2, "maxItems": 2, "description": "m" },
            "cells": { "type": "array", "items": { "type": "integer", "minimum": 1, "maximum": 4096 }, "minItems": 2, "maxItems": 2 }
          }
        },
        "position": { "$ref": "#/$defs/vector", "default": [0, 0, 0] },
        "orientation": { "$ref": "#/$defs/orientation", "default": [0, 0, 0, 1] },
        "links": {
          "enum": ["springs", "rods", "membrane"], "default": "springs",
          "description": "springs: Hooke's; rods: edges keep their length; membrane: triangles of a continuum"
        },
        "area_density": { "$ref": "#/$defs/amount", "default": 0.2, "description": "kg/m^2" },
        "stretch_stiffness": { "$ref": "#/$defs/stiffness", "default": 1000, "description": "N/m: force per width and strain; rods do not ask for it" },
        "shear_stiffness": { "$ref": "#/$defs/stiffness", "default": 200, "description": "N/m: force per width and angle; of a membrane of a mesh half the stretch_stiffness if it is not given" },
        "bend_stiffness": { "$ref": "#/$defs/stiffness", "default": 1e-4, "description": "N m: moment per width and curvature" },
        "thickness": { "$ref": "#/$defs/stiffness", "default": 0.005, "description": "m" },
        "integrator": { "$ref": "#/$defs/soft_integrator" },
        "damping": { "$ref": "#/$defs/factor", "default": 0, "description": "s: stress grows by damping times its rate of change" },
        "static_friction": { "$ref": "#/$defs/factor", "default": 0.4 },
        "dynamic_friction": { "$ref": "#/$defs/factor_or_null", "default": null, "description": "null: the static one" },
        "state": { "$ref": "#/$defs/soft_state" },
        "pinned": { "$ref": "#/$defs/pinned" },
        "pinned_to": { "$ref": "#/$defs/pinned_to" },
        "color": { "$ref": "#/$defs/color" },
        "self_collision": { "type": "boolean", "default": true },
        "pressure": { "type": ["number", "null"], "default": null, "description": "Pa: of a gas within a closed mesh, above ambient_pressure, at the volume at rest; null: no gas" },
        "ambient_pressure": { "$ref": "#/$defs/stiffness", "default": 1e5, "description": "Pa, outside" },
        "pressure_law": {
          "enum": ["ideal_gas", "constant"], "default": "ideal_gas",
          "description": "ideal_gas: (pressure + ambient_pressure) times the volume stays; constant: the pressure stays"
        },
        "tear_strain": { "$ref": "#/$defs/stiffness", "default": 0, "description": "strain at which an edge tears the cloth; 0: never" }
      }
    },
)json";

inline constexpr char kSchemaOfSoftBodies[] = R"json(    "soft_body": {
      "type": "object",
      "required": ["name"],
      "anyOf": [{ "required": ["mesh"] }, { "required": ["box"] }, { "required": ["vertices", "tetrahedra"] }],
      "additionalProperties": false,
      "description": "Given by mesh, by box, or by vertices and tetrahedra.",
      "properties": {
        "name": { "$ref": "#/$defs/name", "description": "unique over bodies, ropes, cloths, soft bodies, gases and liquids" },
        "mesh": { "type": ["string", "null"], "description": "a closed mesh of the scene, filled with tetrahedra" },
        "resolution": {
          "type": ["integer", "null"], "minimum": 2, "maximum": 128, "default": 16,
          "description": "of a mesh: cells along the longest side of its box"
        },
        "vertices": { "type": ["array", "null"], "items": { "$ref": "#/$defs/vector" }, "minItems": 4, "description": "they keep their numbers" },
        "tetrahedra": {
          "type": ["array", "null"],
          "minItems": 1,
          "items": { "type": "array", "items": { "$ref": "#/$defs/index" }, "minItems": 4, "maxItems": 4 }
        },
        "box": {
          "type": ["object", "null"],
          "required": ["half_extents", "cells"],
          "additionalProperties": false,
          "description": "its middle at the position; the corners of the cells are its vertices",
          "properties": {
            "half_extents": { "type": "array", "items": { "$ref": "#/$defs/amount" }, "minItems": 3, "maxItems": 3, "description": "m" },
            "cells": { "type": "array", "items": { "type": "integer", "minimum": 1, "maximum": 256 }, "minItems": 3, "maxItems": 3 }
          }
        },
        "position": { "$ref": "#/$defs/vector", "default": [0, 0, 0] },
        "orientation": { "$ref": "#/$defs/orientation", "default": [0, 0, 0, 1] },
        "density": { "$ref": "#/$defs/amount", "default": 1000, "description": "kg/m^3" },
        "young_modulus": { "$ref": "#/$defs/amount", "default": 1e5, "description": "Pa" },
        "poisson_ratio": { "type": "number", "exclusiveMinimum": -1, "exclusiveMaximum": 0.5, "default": 0.45 },
        "model": { "enum": ["linear", "corotated", "neo_hookean"], "default": "neo_hookean" },
        "fracture_stress": { "$ref": "#/$defs/stiffness", "default": 0, "description": "Pa: tension at which it breaks along faces; 0: never; not of a mesh" },
        "yield_stress": { "$ref": "#/$defs/stiffness", "default": 0, "description": "Pa, of von Mises, beyond which the rest shape yields; 0: never; not of the linear model" },
        "creep_time": { "$ref": "#/$defs/stiffness", "default": 0, "description": "s, in which stress beyond the yield stress falls to 1/e; 0: at once" },
        "integrator": { "$ref": "#/$defs/soft_integrator" },
        "damping": { "$ref": "#/$defs/factor", "default": 0, "description": "s: stress grows by damping times its rate of change" },
        "static_friction": { "$ref": "#/$defs/factor", "default": 0.4 },
        "dynamic_friction": { "$ref": "#/$defs/factor_or_null", "default": null, "description": "null: the static one" },
        "state": { "$ref": "#/$defs/soft_state" },
        "pinned": { "$ref": "#/$defs/pinned" },
        "pinned_to": { "$ref": "#/$defs/pinned_to" },
        "color": { "$ref": "#/$defs/color" },
        "pinned_region": {
          "type": ["object", "null"],
          "required": ["box"],
          "additionalProperties": false,
          "properties": { "box": { "$ref": "#/$defs/box" } },
          "description": "vertices in this box of the world at the start stay where they are"
        }
      }
    },
)json";

}  // namespace gyre
