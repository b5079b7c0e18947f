// The part of the schema that is about gases and liquids, after that of soft matter: scene_schema.cpp puts it there.
#pragma once

namespace gyre {

inline constexpr char kSchemaOfGases[] = R"json(    "side": {
      "enum": ["periodic", "open", "closed", "no_slip"],
      "description": "periodic: what leaves enters on the opposite side; open: a gas passes, a liquid leaves for good; closed: a wall along which the fluid slips; no_slip: a wall that holds the fluid next to it by viscosity"
    },
    "axis_of_boundary": {
      "anyOf": [
        { "type": "null" },
        { "$ref": "#/$defs/side" },
        { "type": "array", "items": { "$ref": "#/$defs/side" }, "minItems": 2, "maxItems": 2, "description": "the lower and the upper side" }
      ]
    },
    "boundary": {
      "description": "one word for all sides, or one for each axis",
      "anyOf": [
        { "type": "null" },
        { "$ref": "#/$defs/side" },
        {
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "x": { "$ref": "#/$defs/axis_of_boundary" },
            "y": { "$ref": "#/$defs/axis_of_boundary" },
            "z": { "$ref": "#/$defs/axis_of_boundary" }
          }
        }
      ]
    },
    "wall": {
      "type": ["object", "null"],
      "additionalProperties": false,
      "properties": { "velocity": { "$ref": "#/$defs/vector_or_null", "default": [0, 0, 0], "description": "m/s, in the plane of the side" } }
    },
    "walls": {
      "type": ["object", "null"],
      "additionalProperties": false,
      "description": "closed and no_slip sides that move in their own plane; a no_slip one drags the fluid along",
      "properties": {
        "-x": { "$ref": "#/$defs/wall" }, "+x": { "$ref": "#/$defs/wall" },
        "-y": { "$ref": "#/$defs/wall" }, "+y": { "$ref": "#/$defs/wall" },
        "-z": { "$ref": "#/$defs/wall" }, "+z": { "$ref": "#/$defs/wall" }
      }
    },
    "probes": {
      "type": ["array", "null"],
      "description": "points inside the bounds where gyre simulate --probes reads the fluid",
      "items": {
        "type": "object",
        "required": ["name", "position"],
        "additionalProperties": false,
        "properties": {
          "name": { "$ref": "#/$defs/name", "description": "unique within the fluid" },
          "position": { "$ref": "#/$defs/vector", "description": "m, in the axes of the box" }
        }
      }
    },
    "numbers": { "type": ["array", "null"], "items": { "type": "number" } },
    "gas": {
      "type": "object",
      "required": ["name", "bounds", "cells"],
      "additionalProperties": false,
      "properties": {
        "name": { "$ref": "#/$defs/name", "description": "unique over bodies, ropes, cloths, soft bodies, gases and liquids" },
        "color": { "$ref": "#/$defs/color" },
        "bounds": { "$ref": "#/$defs/box", "description": "m, [lowest corner, highest corner]" },
        "position": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "m, of the origin of the axes of the box, in which all other members are" },
        "orientation": { "$ref": "#/$defs/orientation", "default": [0, 0, 0, 1], "description": "of these axes" },
        "linear_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "m/s, of the origin of these axes; the box moves and carries its walls along" },
        "angular_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "rad/s, of these axes" },
        "cells": {
          "type": "array", "items": { "type": "integer", "minimum": 1, "maximum": 16777216 }, "minItems": 3, "maxItems": 3,
          "description": "at most 16777216 together; an axis with one cell is flat: nothing moves along it"
        },
        "density": { "type": "number", "exclusiveMinimum": 0, "maximum": 1e20, "default": 1.2, "description": "kg/m^3, of the gas" },
        "viscosity": { "$ref": "#/$defs/stiffness", "default": 0, "description": "Pa s, dynamic" },
        "buoyancy": { "type": "number", "minimum": -1e6, "maximum": 1e6, "default": 1, "description": "the gas is accelerated by -buoyancy gravity (T - ambient) / ambient; 1: as an ideal gas is" },
        "vorticity": { "$ref": "#/$defs/factor", "default": 0, "description": "strength of the confinement of vortices" },
        "ambient_temperature": { "$ref": "#/$defs/amount", "default": 293.15, "description": "K" },
        "combustion": {
          "type": ["object", "null"],
          "additionalProperties": false,
          "default": null,
          "description": "fuel that burns where the gas is hot, and heats it; null: nothing burns",
          "properties": {
            "ignition_temperature": { "$ref": "#/$defs/stiffness", "default": 600, "description": "K, from which fuel burns" },
            "burn_rate": { "$ref": "#/$defs/stiffness", "default": 5, "description": "1/s: fuel that burns falls to 1/e in 1 / burn_rate" },
            "heat_release": { "$ref": "#/$defs/stiffness", "default": 4.6e7, "description": "J/kg, of the fuel" },
            "heat_capacity": { "$ref": "#/$defs/amount", "default": 1005, "description": "J/(kg K), of the gas" },
            "smoke_yield": { "$ref": "#/$defs/stiffness", "default": 0, "description": "kg of smoke from a kg of fuel" }
          }
        },
        "adaptive_domain": {
          "type": ["object", "null"],
          "additionalProperties": false,
          "default": null,
          "description": "compute only the cells around what moves; null: all cells",
          "properties": {
            "margin": { "type": "integer", "minimum": 1, "maximum": 16777216, "default": 8, "description": "cells, around all that moves" },
            "threshold": { "type": "number", "exclusiveMinimum": 0, "maximum": 1, "default": 0.05, "description": "share of the fastest speed, above which gas counts as moving" }
          }
        },
        "advection": { "enum": ["maccormack", "semi_lagrangian"], "default": "maccormack", "description": "of second order, or of first order, which blurs" },
        "boundary": { "$ref": "#/$defs/boundary", "default": "open" },
        "walls": { "$ref": "#/$defs/walls" },
        "initial_velocity": {
          "description": "m/s",
          "anyOf": [
            { "$ref": "#/$defs/vector_or_null" },
            {
              "type": "object",
              "required": ["type"],
              "additionalProperties": false,
              "description": "vortices u = A sin(kx x) cos(ky y), v = -A kx/ky cos(kx x) sin(ky y), from the lower corner of the bounds",
              "properties": {
                "type": { "const": "taylor_green" },
                "amplitude": { "type": "number", "default": 1, "description": "m/s" },
                "wave_number": { "$ref": "#/$defs/vector", "default": [1, 1, 0], "description": "rad/m, [kx, ky, 0]" }
              }
            }
          ],
          "default": [0, 0, 0]
        },
        "emitters": {
          "type": ["array", "null"],
          "description": "balls that hold smoke and temperature, and velocity if it is given, in every step that begins in [start, end)",
          "items": {
            "type": "object",
            "required": ["position"],
            "additionalProperties": false,
            "properties": {
              "position": { "$ref": "#/$defs/vector", "description": "m, inside the bounds" },
              "radius": { "$ref": "#/$defs/amount", "default": 0.3, "description": "m" },
              "density": { "type": "number", "minimum": 0, "maximum": 1e20, "default": 1, "description": "kg/m^3, of smoke" },
              "temperature": { "$ref": "#/$defs/amount", "default": 300, "description": "K" },
              "fuel": { "$ref": "#/$defs/stiffness", "default": 0, "description": "kg/m^3, of a gas with combustion" },
              "velocity": { "$ref": "#/$defs/vector_or_null", "default": null, "description": "m/s; null: it is left alone" },
              "start": { "type": "number", "default": 0, "description": "s" },
              "end": { "type": "number", "default": 1e9, "description": "s" }
            }
          }
        },
        "probes": { "$ref": "#/$defs/probes" },
        "state": {
          "type": ["object", "null"],
          "required": ["velocity"],
          "additionalProperties": false,
          "description": "fields to begin with; x runs fastest, then y, then z",
          "properties": {
            "velocity": {
              "type": "object",
              "additionalProperties": false,
              "description": "m/s across faces: of x (cells[0] + 1) cells[1] cells[2] numbers, and so on",
              "properties": { "x": { "$ref": "#/$defs/numbers" }, "y": { "$ref": "#/$defs/numbers" }, "z": { "$ref": "#/$defs/numbers" } }
            },
            "density": { "$ref": "#/$defs/numbers", "description": "kg/m^3, of smoke" },
            "temperature": { "$ref": "#/$defs/numbers", "description": "K" },
            "pressure": { "$ref": "#/$defs/numbers", "description": "m^2/s^2, over the density of the gas" },
            "fuel": { "$ref": "#/$defs/numbers", "description": "kg/m^3, of a gas with combustion" }
          }
        }
      }
    },
)json";

inline constexpr char kSchemaOfLiquids[] = R"json(    "liquid": {
      "type": "object",
      "required": ["name", "bounds", "cell_size"],
      "additionalProperties": false,
      "properties": {
        "name": { "$ref": "#/$defs/name", "description": "unique over bodies, ropes, cloths, soft bodies, gases and liquids" },
        "color": { "$ref": "#/$defs/color" },
        "bounds": { "$ref": "#/$defs/box", "description": "m, [lowest corner, highest corner]; widened at the latter to whole cells" },
        "position": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "m, of the origin of the axes of the box, in which all other members are" },
        "orientation": { "$ref": "#/$defs/orientation", "default": [0, 0, 0, 1], "description": "of these axes" },
        "linear_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "m/s, of the origin of these axes; the box moves and carries its walls along" },
        "angular_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "rad/s, of these axes" },
        "cell_size": { "$ref": "#/$defs/amount", "description": "m; at most 16777216 cells; an axis with one cell is flat: nothing moves along it" },
        "density": { "type": "number", "exclusiveMinimum": 0, "maximum": 1e20, "default": 1000, "description": "kg/m^3" },
        "viscosity": { "$ref": "#/$defs/stiffness", "default": 0, "description": "Pa s, dynamic" },
        "surface_tension": { "$ref": "#/$defs/stiffness", "default": 0, "description": "N/m" },
        "fill": {
          "type": ["array", "null"],
          "description": "where the liquid is at the start, but for bodies",
          "items": {
            "type": "object",
            "required": ["box"],
            "additionalProperties": false,
            "properties": { "box": { "$ref": "#/$defs/box" } }
          }
        },
        "boundary": { "$ref": "#/$defs/boundary", "default": "closed" },
        "walls": { "$ref": "#/$defs/walls" },
        "initial_velocity": { "$ref": "#/$defs/vector_or_null", "default": [0, 0, 0], "description": "m/s" },
        "emitters": {
          "type": ["array", "null"],
          "description": "balls that are filled with liquid in every step that begins in [start, end)",
          "items": {
            "type": "object",
            "required": ["position"],
            "additionalProperties": false,
            "properties": {
              "position": { "$ref": "#/$defs/vector", "description": "m, inside the bounds" },
              "radius": { "$ref": "#/$defs/amount", "default": 0.3, "description": "m" },
              "velocity": { "$ref": "#/$defs/vector_or_null", "default": null, "description": "m/s; null: at rest" },
              "start": { "type": "number", "default": 0, "description": "s" },
              "end": { "type": "number", "default": 1e9, "description": "s" }
            }
          }
        },
        "probes": { "$ref": "#/$defs/probes" },
        "state": {
          "type": ["object", "null"],
          "required": ["positions"],
          "additionalProperties": false,
          "description": "particles to begin with, instead of those of `fill`",
          "properties": {
            "positions": { "type": "array", "items": { "$ref": "#/$defs/vector" }, "description": "m, in the axes of the box; at most 4194304" },
            "velocities": { "type": ["array", "null"], "items": { "$ref": "#/$defs/vector" }, "description": "m/s" },
            "affine": {
              "type": ["array", "null"],
              "items": { "type": "array", "items": { "type": "number" }, "minItems": 9, "maxItems": 9 },
              "description": "1/s: how the velocity changes around the particle, row by row"
            },
            "volumes": { "$ref": "#/$defs/numbers", "description": "m^3; without: an eighth of a cell each, a quarter in a plane flow" }
          }
        }
      }
    },
)json";

}  // namespace gyre
