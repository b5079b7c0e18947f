// The JSON Schema (draft 2020-12) of a scene. scenes/scene.schema.json is the same text; a test compares them.
#include "scene/scene_schema.h"

#include "scene/scene_schema_fluid.h"
#include "scene/scene_schema_joints.h"
#include "scene/scene_schema_soft.h"

namespace gyre {
namespace {

// In parts, as some compilers limit the length of one literal.
constexpr char kPart0[] = R"json({
  "$schema": "https://json-schema.org/draft/2020-12/schema",
  "title": "Gyre scene",
  "description": "A scene of the physics engine Gyre. SI units (m, kg, s, rad, N, Pa); right-handed frame, y up; quaternions are [x, y, z, w].",
  "type": "object",
  "required": ["gyre_scene"],
  "additionalProperties": false,
  "properties": {
    "gyre_scene": { "const": 1, "description": "version of the format" },
    "name": { "type": "string" },
    "world": { "$ref": "#/$defs/world" },
    "view": { "$ref": "#/$defs/view" },
    "materials": { "type": "object", "propertyNames": { "$ref": "#/$defs/name" }, "additionalProperties": { "$ref": "#/$defs/material" } },
    "material_pairs": { "type": "array", "items": { "$ref": "#/$defs/material_pair" } },
    "meshes": { "type": "object", "propertyNames": { "$ref": "#/$defs/name" }, "additionalProperties": { "$ref": "#/$defs/mesh" } },
    "bodies": { "type": "array", "items": { "$ref": "#/$defs/body" } },
    "joints": { "type": "array", "items": { "$ref": "#/$defs/joint" } },
    "couplings": { "type": "array", "items": { "$ref": "#/$defs/coupling" } },
    "ignored_pairs": { "type": "array", "items": { "type": "array", "items": { "$ref": "#/$defs/name" }, "minItems": 2, "maxItems": 2 }, "description": "pairs of bodies that have no contacts with each other" },
    "cloths": { "type": "array", "items": { "$ref": "#/$defs/cloth" } },
    "ropes": { "type": "array", "items": { "$ref": "#/$defs/rope" } },
    "soft_bodies": { "type": "array", "items": { "$ref": "#/$defs/soft_body" } },
    "gases": { "type": "array", "items": { "$ref": "#/$defs/gas" } },
    "liquids": { "type": "array", "items": { "$ref": "#/$defs/liquid" } },
    "force_fields": { "type": "array", "items": { "$ref": "#/$defs/force_field" } }
  },
  "$defs": {
    "name": { "type": "string", "minLength": 1, "maxLength": 1024 },
    "positive": { "type": "number", "exclusiveMinimum": 0 },
    "not_negative": { "type": "number", "minimum": 0 },
    "factor": { "type": "number", "minimum": 0, "maximum": 1e6 },
    "positive_or_null": { "type": ["number", "null"], "exclusiveMinimum": 0 },
    "not_negative_or_null": { "type": ["number", "null"], "minimum": 0 },
    "vector": { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 },
    "vector_or_null": { "type": ["array", "null"], "items": { "type": "number" }, "minItems": 3, "maxItems": 3 },
    "box": { "type": "array", "items": { "$ref": "#/$defs/vector" }, "minItems": 2, "maxItems": 2, "description": "[lowest corner, highest corner]" },
    "truth_values": { "type": "array", "items": { "type": "boolean" }, "minItems": 3, "maxItems": 3 },
    "index": { "type": "integer", "minimum": 0 },
    "color": { "type": ["string", "null"], "pattern": "^#[0-9a-fA-F]{6}$", "description": "sRGB, #rrggbb, for pictures only" },
    "orientation": {
      "anyOf": [
        { "type": "array", "items": { "type": "number" }, "minItems": 4, "maxItems": 4, "description": "quaternion [x, y, z, w]" },
        {
          "type": "object",
          "required": ["axis", "angle"],
          "additionalProperties": false,
          "properties": { "axis": { "$ref": "#/$defs/vector" }, "angle": { "type": "number", "description": "rad" } }
        },
        {
          "type": "object",
          "required": ["euler_xyz"],
          "additionalProperties": false,
          "properties": { "euler_xyz": { "$ref": "#/$defs/vector", "description": "intrinsic rotations about x, y and z, rad" } }
        }
      ]
    },
    "world": {
      "type": "object",
      "additionalProperties": false,
      "properties": {
        "gravity": { "$ref": "#/$defs/vector", "default": [0, -9.81, 0], "description": "m/s^2" },
        "time_step": { "type": "number", "exclusiveMinimum": 0, "maximum": 1, "default": 0.016666667, "description": "s, one step" },
        "substeps": { "type": "integer", "minimum": 1, "maximum": 64, "default": 4 },
        "integrator": { "enum": ["explicit_euler", "semi_implicit_euler", "rk4", "verlet"], "default": "semi_implicit_euler" },
        "solver": { "enum": ["soft_step", "sequential_impulses", "lcp"], "default": "soft_step" },
        "lcp_method": {
          "enum": ["automatic", "dantzig", "lemke", "newton", "nncg"], "default": "automatic",
          "description": "lcp: how the complementarity problem of an island is solved"
        },
        "friction_sides": {
          "type": "integer", "minimum": 0, "maximum": 32, "multipleOf": 2, "not": { "const": 2 }, "default": 0,
          "description": "sequential_impulses, lcp: of the friction pyramid; 0: Coulomb's cone"
        },
        "iterations": {
          "type": "integer", "minimum": 0, "maximum": 10000, "default": 0,
          "description": "sequential_impulses, lcp: sweeps a sub-step; 0: 10, or at most 200 for NNCG"
        },
        "direct_rows": {
          "type": "integer", "minimum": 0, "maximum": 600, "default": 200,
          "description": "lcp: pivoting leaves islands with more rows to Newton's method"
        },
        "broad_phase": {
          "enum": ["bvh", "grid", "octree", "quadtree", "kd_tree", "bsp_tree", "sweep_and_prune", "brute_force"],
          "default": "bvh"
        },
        "springs": {
          "enum": ["implicit", "explicit"],
          "default": "implicit",
          "description": "explicit: springs of distance joints are forces that the integrator sees at its stages"
        },
        "stepping": {
          "enum": ["fixed", "adaptive", "error_controlled"],
          "default": "fixed",
          "description": "adaptive: advance to the times of impact; error_controlled: sub-steps by the estimated error"
        },
        "tolerance": { "type": "number", "minimum": 1e-9, "maximum": 1, "default": 1e-5, "description": "m, of a step that is not fixed" },
        "max_impacts": { "type": "integer", "minimum": 1, "maximum": 4096, "default": 128, "description": "in a step, adaptive" },
        "sleeping": { "type": "boolean", "default": true },
        "sleep_share": { "type": "number", "minimum": 0, "maximum": 1000, "default": 0.015, "description": "speed below which bodies are still, as a share of sqrt(gravity x radius)" }
      }
    },
    "view": {
      "type": ["object", "null"],
      "required": ["eye", "target"],
      "additionalProperties": false,
      "description": "Where a good picture is taken from.",
      "properties": {
        "eye": { "$ref": "#/$defs/vector" },
        "target": { "$ref": "#/$defs/vector", "description": "another place than the eye" },
        "field_of_view": { "type": "number", "minimum": 0.01, "maximum": 3, "default": 0.7, "description": "rad, from bottom to top" }
      }
    },
    "material": {
      "type": "object",
      "additionalProperties": false,
      "description": "One friction given alone stands for both.",
      "properties": {
        "density": { "$ref": "#/$defs/not_negative_or_null", "default": 1000, "description": "kg/m^3" },
        "static_friction": { "$ref": "#/$defs/not_negative_or_null", "default": 0.6 },
        "dynamic_friction": { "$ref": "#/$defs/not_negative_or_null", "default": 0.6 },
        "restitution": { "type": ["number", "null"], "minimum": 0, "maximum": 1, "default": 0 },
        "rolling_friction": { "$ref": "#/$defs/not_negative_or_null", "default": 0, "description": "m" },
        "spinning_friction": { "$ref": "#/$defs/not_negative_or_null", "default": 0, "description": "m" },
        "color": { "$ref": "#/$defs/color" },
        "surface_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "m/s, in the body's frame: the surface runs like a conveyor belt" },
        "one_way": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "direction in the body's frame: what moves along it passes, what comes against it is held; zero: nothing passes" }
      }
    },
    "material_pair": {
      "type": "object",
      "required": ["materials"],
      "additionalProperties": false,
      "description": "Overrides the combine rule for two materials; what is not given follows from the rule.",
      "properties": {
        "materials": { "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 },
        "static_friction": { "$ref": "#/$defs/not_negative_or_null" },
        "dynamic_friction": { "$ref": "#/$defs/not_negative_or_null" },
        "restitution": { "type": ["number", "null"], "minimum": 0, "maximum": 1 }
      }
    },
    "mesh": {
      "anyOf": [
        {
          "type": "object",
          "required": ["file"],
          "additionalProperties": false,
          "properties": {
            "file": {
              "type": "string",
              "maxLength": 1024,
              "description": "Wavefront OBJ, STL or PLY, relative to the scene file and within its folder"
            },
            "vertices": { "type": "null" },
            "triangles": { "type": "null" }
          }
        },
        {
          "type": "object",
          "required": ["vertices", "triangles"],
          "additionalProperties": false,
          "properties": {
            "vertices": { "type": "array", "items": { "$ref": "#/$defs/vector" }, "minItems": 3 },
            "triangles": {
              "type": "array",
              "minItems": 1,
              "items": { "type": "array", "items": { "$ref": "#/$defs/index" }, "minItems": 3, "maxItems": 3 },
              "description": "counter-clockwise seen from outside"
            }
          }
        }
      ]
    },
    "body": {
      "type": "object",
      "required": ["name"],
      "additionalProperties": false,
      "properties": {
        "name": { "$ref": "#/$defs/name", "description": "unique" },
        "type": { "enum": ["static", "kinematic", "dynamic"], "default": "dynamic" },
        "position": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "of the body's origin" },
        "orientation": { "$ref": "#/$defs/orientation", "default": [0, 0, 0, 1] },
        "linear_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "of the centre of mass" },
        "angular_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "world frame" },
        "linear_damping": { "$ref": "#/$defs/factor", "default": 0, "description": "1/s" },
        "angular_damping": { "$ref": "#/$defs/factor", "default": 0, "description": "1/s" },
        "gravity_scale": { "type": "number", "minimum": -1e6, "maximum": 1e6, "default": 1 },
        "continuous": { "type": "boolean", "default": false, "description": "swept against moving bodies too" },
        "can_sleep": { "type": "boolean", "default": true },
        "sleep_speed": { "type": "number", "minimum": 0, "maximum": 1e6, "default": 0, "description": "m/s below which the body is still; 0: by the world's sleep_share" },
        "enabled": { "type": "boolean", "default": true, "description": "false: the body is out of the simulation, until the program enables it" },
        "locked": {
          "type": "object",
          "additionalProperties": false,
          "properties": { "linear": { "$ref": "#/$defs/truth_values" }, "angular": { "$ref": "#/$defs/truth_values" } },
          "description": "world axes along and about which the body does not move"
        },
        "mass": { "$ref": "#/$defs/positive_or_null", "default": null, "description": "overrides what the shapes give" },
        "center_of_mass": { "$ref": "#/$defs/vector_or_null", "default": null, "description": "body frame" },
        "inertia": {
          "type": ["array", "null"],
          "items": { "type": "number" },
          "minItems": 6,
          "maxItems": 6,
          "default": null,
          "description": "[xx, yy, zz, xy, xz, yz] about the centre of mass, body axes"
        },
        "filter": {
          "type": "object",
          "additionalProperties": false,
          "properties": {
            "layer": { "type": "integer", "minimum": 0, "maximum": 4294967295, "default": 1 },
            "collides_with": { "type": "integer", "minimum": 0, "maximum": 4294967295, "default": 4294967295 },
)json";

constexpr char kPart1[] = R"json(            "group": { "type": "integer", "minimum": -2147483648, "maximum": 2147483647, "default": 0 }
          }
        },
        "sensor": { "type": "boolean", "default": false, "description": "reports what overlaps it and touches nothing" },
        "color": { "$ref": "#/$defs/color", "description": "of shapes that have none of their own; wins over their material's" },
        "shapes": { "type": "array", "items": { "$ref": "#/$defs/shape" } },
        "forces": { "type": "array", "items": { "$ref": "#/$defs/force" } }
      }
    },
    "shape_common": {
      "properties": {
        "position": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "of the shape in the body" },
        "orientation": { "$ref": "#/$defs/orientation", "default": [0, 0, 0, 1] },
        "material": { "type": ["string", "null"], "description": "a name; values given in place win over the material's" },
        "density": { "$ref": "#/$defs/not_negative_or_null" },
        "static_friction": { "$ref": "#/$defs/not_negative_or_null" },
        "dynamic_friction": { "$ref": "#/$defs/not_negative_or_null" },
        "restitution": { "type": ["number", "null"], "minimum": 0, "maximum": 1 },
        "rolling_friction": { "$ref": "#/$defs/not_negative_or_null" },
        "spinning_friction": { "$ref": "#/$defs/not_negative_or_null" },
        "color": { "$ref": "#/$defs/color" }
      }
    },
    "round": {
      "required": ["radius", "half_height"],
      "properties": { "radius": { "$ref": "#/$defs/positive" }, "half_height": { "$ref": "#/$defs/positive" } }
    },
    "shape": {
      "type": "object",
      "required": ["type"],
      "allOf": [{ "$ref": "#/$defs/shape_common" }],
      "unevaluatedProperties": false,
      "oneOf": [
        {
          "properties": { "type": { "const": "sphere" }, "radius": { "$ref": "#/$defs/positive" } },
          "required": ["radius"]
        },
        {
          "properties": {
            "type": { "const": "box" },
            "half_extents": { "type": "array", "items": { "$ref": "#/$defs/positive" }, "minItems": 3, "maxItems": 3 },
            "rounding": { "$ref": "#/$defs/not_negative", "default": 0, "description": "at most the smallest half extent" }
          },
          "required": ["half_extents"]
        },
        {
          "properties": {
            "type": { "const": "capsule" },
            "radius": { "$ref": "#/$defs/positive" },
            "half_height": { "$ref": "#/$defs/not_negative", "description": "without the caps" }
          },
          "required": ["radius", "half_height"]
        },
        { "properties": { "type": { "const": "cylinder" } }, "$ref": "#/$defs/round" },
        { "properties": { "type": { "const": "cone" } }, "$ref": "#/$defs/round" },
        {
          "properties": {
            "type": { "const": "convex_hull" },
            "points": { "type": "array", "items": { "$ref": "#/$defs/vector" }, "minItems": 4 },
            "mesh": { "type": "null" }
          },
          "required": ["points"]
        },
        {
          "properties": { "type": { "const": "convex_hull" }, "mesh": { "type": "string" }, "points": { "type": "null" } },
          "required": ["mesh"]
        },
        {
          "properties": { "type": { "const": "mesh" }, "mesh": { "type": "string" } },
          "required": ["mesh"],
          "description": "static and kinematic bodies"
        },
        {
          "properties": {
            "type": { "const": "convex_decomposition" },
            "mesh": { "type": "string" },
            "max_hulls": { "type": "integer", "minimum": 1, "maximum": 1024, "default": 32 },
            "concavity": {
              "type": "number",
              "minimum": 0.001,
              "maximum": 1,
              "default": 0.02,
              "description": "how far hulls may reach beyond the solid, and surface may lie below them, as a part of the diameter of the mesh"
            },
            "max_hull_vertices": { "type": "integer", "minimum": 8, "maximum": 255, "default": 128 },
            "meaning": {
              "enum": ["automatic", "solid", "shell"],
              "default": "automatic",
              "description": "whether the triangles bound a solid or are a sheet; automatic: a sheet if it is wide open"
            },
            "shell_thickness": {
              "type": "number",
              "minimum": 0,
              "default": 0,
              "description": "m, of a sheet; 0: half of concavity times the diameter of the mesh"
            }
          },
          "required": ["mesh"],
          "description": "a concave mesh as convex hulls, for bodies of any type; see docs/decomposition.md"
        },
        {
          "properties": {
            "type": { "const": "height_field" },
            "size": {
              "type": "array",
              "items": { "type": "integer", "minimum": 2, "maximum": 65536 },
              "minItems": 2,
              "maxItems": 2,
              "description": "samples along x and along z, centred on the shape's origin"
            },
            "spacing": { "$ref": "#/$defs/positive", "default": 1, "description": "m between samples" },
            "heights": {
              "type": "array",
              "items": { "type": ["number", "null"] },
              "minItems": 4,
              "description": "row after row along x, rows along z; null makes a hole"
            }
          },
          "required": ["size", "heights"],
          "description": "static and kinematic bodies"
        },
        {
          "properties": {
            "type": { "const": "plane" },
            "normal": { "$ref": "#/$defs/vector", "default": [0, 1, 0] },
            "offset": { "type": "number", "default": 0 }
          },
          "description": "static and kinematic bodies"
        }
      ]
    },
    "force": {
      "type": "object",
      "additionalProperties": false,
      "description": "Acts in every step that begins in [start, end).",
      "properties": {
        "force": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "N" },
        "torque": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "N m" },
        "at": { "$ref": "#/$defs/vector_or_null", "default": null, "description": "null: the centre of mass" },
        "frame": { "enum": ["world", "body"], "default": "world", "description": "of force, torque and at" },
        "start": { "type": "number", "default": 0, "description": "s" },
        "end": { "type": "number", "default": 1e9, "description": "s" }
      }
    },
)json";

constexpr char kPart2[] = R"json(    "coupling": {
      "type": "object",
      "required": ["terms"],
      "additionalProperties": false,
      "description": "the sum of coefficient times position of some axes of joints stays",
      "properties": {
        "terms": {
          "type": "array",
          "minItems": 2,
          "maxItems": 8,
          "items": {
            "type": "object",
            "required": ["joint"],
            "additionalProperties": false,
            "properties": {
              "joint": { "$ref": "#/$defs/name", "description": "a hinge, slider, universal, wheel or six_dof with a name" },
              "axis": { "enum": ["linear_x", "linear_y", "linear_z", "angular_x", "angular_y", "angular_z"], "description": "default: linear_x of a slider, else angular_x" },
              "coefficient": { "type": "number", "minimum": -1e6, "maximum": 1e6, "default": 1, "description": "not 0; per rad or m" }
            }
          }
        },
        "offset": { "type": ["number", "null"], "default": null, "description": "of the sum; null: the sum at the start" }
      }
    },
    "force_field": {
      "type": "object",
      "required": ["type"],
      "additionalProperties": false,
      "properties": {
        "type": { "enum": ["wind", "radial", "vortex", "drag", "buoyancy", "magnetic", "magnetic_dipole", "stokes", "grid", "explosion"] },
        "bounds": { "anyOf": [{ "type": "null" }, { "$ref": "#/$defs/box" }], "description": "where it acts, by centre of mass; null: everywhere" },
        "layers": { "type": ["integer", "null"], "minimum": 0, "maximum": 4294967295, "default": 4294967295, "description": "bodies with a shape in one of these layers" },
        "velocity": { "$ref": "#/$defs/vector_or_null", "default": [0, 0, 0], "description": "m/s, of the medium (wind, vortex, drag, buoyancy, stokes)" },
        "density": { "$ref": "#/$defs/not_negative_or_null", "description": "kg/m^3, of the medium; default 1.2, of buoyancy 1000" },
        "drag_coefficient": { "$ref": "#/$defs/not_negative_or_null", "default": 1, "description": "of the drag by shape, with the square of the speed" },
        "linear_drag": { "$ref": "#/$defs/not_negative_or_null", "default": 0, "description": "1/s: velocity and spin against the medium die away at this rate besides" },
        "turbulence": { "$ref": "#/$defs/not_negative_or_null", "default": 0, "description": "wind: root mean square of the gusts over the mean speed" },
        "turbulence_length": { "$ref": "#/$defs/positive_or_null", "default": 10, "description": "wind: m, size of the gusts" },
        "center": { "$ref": "#/$defs/vector_or_null", "default": [0, 0, 0], "description": "radial, vortex, magnetic_dipole, explosion" },
        "strength": { "type": ["number", "null"], "default": 0, "description": "at the radius: radial m/s^2 towards the center, vortex m/s about the axis, magnetic_dipole 1/s at right angles to the axis; magnetic: 1/s, charge over mass times flux density; stokes: Pa s, the viscosity" },
        "radius": { "$ref": "#/$defs/not_negative_or_null", "default": 1, "description": "m; explosion: nothing farther away is hit, default 10" },
        "falloff": { "type": ["number", "null"], "minimum": -4, "maximum": 4, "default": 2, "description": "radial, explosion: power of the distance" },
        "core": { "$ref": "#/$defs/not_negative_or_null", "default": 0, "description": "radial, magnetic_dipole: m, within which it weakens" },
        "axis": { "$ref": "#/$defs/vector_or_null", "default": [0, 1, 0], "description": "vortex; magnetic: the direction of the field; magnetic_dipole: of the moment" },
        "points": { "type": "array", "items": { "type": "integer", "minimum": 2, "maximum": 1024 }, "minItems": 3, "maxItems": 3, "description": "grid: points along x, y and z, from the lowest corner of the bounds to the highest" },
        "vectors": { "type": "array", "items": { "$ref": "#/$defs/vector" }, "minItems": 8, "maxItems": 4194304, "description": "grid: m/s^2 at each point, x fastest, then y, then z" },
        "normal": { "$ref": "#/$defs/vector_or_null", "default": [0, 1, 0], "description": "buoyancy: up from the surface" },
        "offset": { "type": ["number", "null"], "default": 0, "description": "buoyancy: m, the surface is where dot(normal, p) = offset" },
        "pressure": { "type": ["number", "null"], "default": 100, "description": "explosion: Pa s at the reference distance" },
        "reference": { "$ref": "#/$defs/positive_or_null", "default": 1, "description": "explosion: m" },
        "occlusion": { "type": ["boolean", "null"], "default": true, "description": "explosion: bodies hide others" },
        "start": { "type": ["number", "null"], "default": 0, "description": "explosion: s, it goes off in the first step that begins then or later" }
      }
    }
  }
}
)json";

}  // namespace

std::string scene_schema() {
  std::string out;
  for (const char* part :
       {kPart0, kPart1, kSchemaOfJoints, kSchemaOfRopes, kSchemaOfCloths, kSchemaOfSoftBodies,
                           kSchemaOfGases, kSchemaOfLiquids, kPart2}) {
    out += part;
  }
  return out;
}

}  // namespace gyre
