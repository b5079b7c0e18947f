// The part of the schema that is about joints, between those of bodies and of cloths: scene_schema.cpp puts it there.
#pragma once

namespace gyre {

constexpr char kSchemaOfJoints[] = R"json(    "motor": {
      "type": ["object", "null"],
      "additionalProperties": false,
      "properties": {
        "target_velocity": { "type": "number", "minimum": -1e6, "maximum": 1e6, "default": 0, "description": "rad/s or m/s" },
        "target_position": { "type": ["number", "null"], "default": null, "description": "rad or m; makes it a spring to there" },
        "max_force": { "$ref": "#/$defs/not_negative", "default": 0, "description": "N m or N" },
        "frequency": { "$ref": "#/$defs/factor", "default": 0, "description": "Hz, of the spring" },
        "damping_ratio": { "$ref": "#/$defs/factor", "default": 1 }
      }
    },
    "joint_axis": {
      "type": ["object", "null"],
      "additionalProperties": false,
      "properties": {
        "motion": { "enum": ["locked", "free", "limited", null], "description": "six_dof and steering: locked where nothing is said" },
        "limits": {
          "type": ["array", "null"],
          "items": { "type": "number", "minimum": -1e9, "maximum": 1e9 },
          "minItems": 2,
          "maxItems": 2,
          "description": "makes it limited; rad or m"
        },
        "limit_frequency": { "$ref": "#/$defs/factor", "default": 0 },
        "limit_damping_ratio": { "$ref": "#/$defs/factor", "default": 1 },
        "motor": { "$ref": "#/$defs/motor" },
        "stiffness": { "$ref": "#/$defs/not_negative", "default": 0, "description": "N/m or N m/rad" },
        "damping": { "$ref": "#/$defs/not_negative", "default": 0, "description": "N s/m or N m s/rad" },
        "rest_position": { "type": "number", "minimum": -1e9, "maximum": 1e9, "default": 0 },
        "friction": { "$ref": "#/$defs/not_negative", "default": 0, "description": "N or N m" }
      }
    },
    "drive": {
      "type": ["object", "null"],
      "additionalProperties": false,
      "description": "motor, mouse; cone: its turning part",
      "properties": {
        "position": { "$ref": "#/$defs/vector", "default": [0, 0, 0], "description": "m, of b's anchor from a's, in the joint's frame on a" },
        "orientation": { "$ref": "#/$defs/orientation" },
        "linear_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0] },
        "angular_velocity": { "$ref": "#/$defs/vector", "default": [0, 0, 0] },
        "frequency": { "$ref": "#/$defs/factor", "default": 0, "description": "Hz; 0: as stiff as the step allows" },
        "damping_ratio": { "$ref": "#/$defs/factor", "default": 1 },
        "max_force": { "$ref": "#/$defs/not_negative", "default": 0, "description": "N" },
        "max_torque": { "$ref": "#/$defs/not_negative", "default": 0, "description": "N m" }
      }
    },
    "joint": {
      "type": "object",
      "required": ["type", "a", "b"],
      "additionalProperties": false,
      "properties": {
        "type": {
          "enum": ["ball", "hinge", "slider", "fixed", "distance", "cone", "universal", "six_dof", "gear", "rack_and_pinion", "pulley", "wheel",
            "path", "mouse", "motor"]
        },
        "name": { "type": ["string", "null"], "minLength": 1, "maxLength": 1024 },
        "a": { "type": "string", "description": "a body, or world" },
        "b": { "type": "string", "description": "a body, or world" },
        "anchor": { "$ref": "#/$defs/vector_or_null", "description": "world frame, at the start; distance: the point on a" },
        "axis": { "$ref": "#/$defs/vector_or_null", "description": "world frame, at the start" },
        "anchor_b": { "$ref": "#/$defs/vector_or_null", "description": "distance and pulley: the point on b; null: b's origin" },
        "limits": {
          "type": ["array", "null"],
          "items": { "type": "number", "minimum": -1e9, "maximum": 1e9 },
          "minItems": 2,
          "maxItems": 2
        },
        "axis_b": { "$ref": "#/$defs/vector_or_null", "description": "universal, wheel (spin), gear, rack_and_pinion (way): of b; cone, six_dof, motor: z of the frame" },
        "limit_frequency": { "$ref": "#/$defs/factor", "default": 0, "description": "Hz: limits give way like springs; 0: they hold" },
        "limit_damping_ratio": { "$ref": "#/$defs/factor", "default": 1 },
        "swing": {
          "type": ["array", "null"],
          "items": { "type": "number", "minimum": 0, "maximum": 3.1415 },
          "minItems": 2,
          "maxItems": 2,
          "description": "cone: the most that the axis turns about y and z of the frame, rad"
        },
        "motor": { "$ref": "#/$defs/motor" },
        "friction": { "$ref": "#/$defs/not_negative", "default": 0, "description": "N or N m, dry" },
        "axes": {
          "type": ["object", "null"],
          "additionalProperties": false,
          "description": "six_dof; wheel: angular_x steers; universal: angular_z about axis_b",
          "properties": {
            "linear_x": { "$ref": "#/$defs/joint_axis" },
            "linear_y": { "$ref": "#/$defs/joint_axis" },
            "linear_z": { "$ref": "#/$defs/joint_axis" },
            "angular_x": { "$ref": "#/$defs/joint_axis" },
            "angular_y": { "$ref": "#/$defs/joint_axis" },
            "angular_z": { "$ref": "#/$defs/joint_axis" }
          }
        },
        "ratio": { "type": ["number", "null"], "minimum": -1e6, "maximum": 1e6, "default": 1, "description": "gear: turns of a per turn of b, the other way; rack_and_pinion: m/rad; pulley: of b's part of the rope" },
        "ground_a": { "$ref": "#/$defs/vector_or_null", "description": "pulley: the point that a's part of the rope runs over" },
        "ground_b": { "$ref": "#/$defs/vector_or_null", "description": "pulley: the point that b's part of the rope runs over" },
        "path": {
          "type": ["array", "null"],
          "items": { "$ref": "#/$defs/vector" },
          "minItems": 2,
          "maxItems": 4096,
          "description": "path: points that the curve runs through, world frame, at the start"
        },
        "path_closed": { "type": "boolean", "default": false },
        "path_orientation": { "enum": ["free", "fixed", "following", null], "default": "free" },
        "drive": { "$ref": "#/$defs/drive" },
        "length": { "$ref": "#/$defs/not_negative_or_null", "description": "distance: of the rod, or the spring at rest" },
        "min_length": { "$ref": "#/$defs/not_negative_or_null" },
        "max_length": { "$ref": "#/$defs/not_negative_or_null" },
        "stiffness": { "$ref": "#/$defs/not_negative_or_null", "description": "distance: N/m; hinge, slider, wheel (suspension) and the like: N/m or N m/rad" },
        "damping": { "$ref": "#/$defs/not_negative_or_null", "description": "N s/m or N m s/rad" },
        "frequency": { "type": ["number", "null"], "minimum": 1e-6, "maximum": 1e6, "description": "distance, instead of stiffness and damping: Hz, of the two bodies alone" },
        "damping_ratio": { "$ref": "#/$defs/factor", "default": 0 },
        "break_force": { "$ref": "#/$defs/positive_or_null", "description": "N" },
        "break_torque": { "$ref": "#/$defs/positive_or_null", "description": "N m" },
        "collide_connected": { "type": "boolean", "default": false }
      },
      "allOf": [
        { "if": { "properties": { "type": { "enum": ["ball", "hinge", "cone", "universal", "wheel"] } } }, "then": { "required": ["anchor"] } },
        { "if": { "properties": { "type": { "enum": ["hinge", "slider", "cone", "universal", "gear", "rack_and_pinion", "wheel"] } } }, "then": { "required": ["axis"] } }
      ]
    },
)json";

}  // namespace gyre
