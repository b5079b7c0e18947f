// What of a joint persists from step to step: part of the world's state.
//
// Every joint has a record. What only some joints have (several axes, friction, drives, curves) is in details, which worlds
// without such joints do not have.
#pragma once

#include "solver/core/body_motion.h"

#include <gyre/defs.h>

#include <cstdint>

namespace gyre {

struct JointRecord {
  JointKind kind = JointKind::ball;
  bool has_limits = false;
  bool is_spring = false;  // distance with stiffness
  bool collide_connected = false;
  bool has_motor_target = false;
  std::int32_t body_a = kNoBody;
  std::int32_t body_b = kNoBody;
  Vec3 local_anchor_a;  // from the centre of mass, body frame
  Vec3 local_anchor_b;
  Quat local_frame_a;  // body_from_joint
  Quat local_frame_b;
  DVec3 world_anchor_a;  // where the anchor is when that body is the world
  DVec3 world_anchor_b;
  Limits limits;                // rad or m
  float motor_velocity = 0.0f;  // target
  float motor_position = 0.0f;  // target, if has_motor_target
  float motor_force = 0.0f;     // 0: no motor
  float motor_frequency = 0.0f;
  float motor_damping = 1.0f;
  float rest_length = 0.0f;  // distance: m; of the spring
  float min_length = 0.0f;
  float max_length = 0.0f;
  float stiffness = 0.0f;
  float damping = 0.0f;
  float break_force = 0.0f;  // 0: unbreakable
  float break_torque = 0.0f;
  // Impulses of the last sub-step, world axes, on B: the warm start.
  Vec3 linear_impulse;
  Vec3 angular_impulse;
  float low_impulse = 0.0f;  // limits; gear, rack: of the one row
  float high_impulse = 0.0f;
  float motor_impulse = 0.0f;
  float spring_impulse = 0.0f;
  float position = 0.0f;  // unwrapped angle, slide or length
  // Sums over the last step, for reading.
  Vec3 total_linear;
  Vec3 total_angular;
};

// max_length of a joint without one.
constexpr float kUnlimitedLength = 1.0e30f;

// One axis of a joint: what acts along or about it, and the impulses of the last sub-step.
struct JointAxisRecord {
  AxisMotion motion = AxisMotion::locked;
  bool has_motor_target = false;
  Limits limits;                 // if limited
  float limit_frequency = 0.0f;  // Hz; 0: they hold
  float limit_damping = 1.0f;
  float motor_velocity = 0.0f;
  float motor_position = 0.0f;
  float motor_force = 0.0f;  // 0: no motor
  float motor_frequency = 0.0f;
  float motor_damping = 1.0f;
  float stiffness = 0.0f;
  float damping = 0.0f;
  float rest_position = 0.0f;
  float friction = 0.0f;
  float locked_position = 0.0f;  // where a locked axis stays
  float low_impulse = 0.0f;
  float high_impulse = 0.0f;
  float motor_impulse = 0.0f;
  float spring_impulse = 0.0f;
  float friction_impulse = 0.0f;
  float position = 0.0f;  // m or rad, unwrapped
  float total = 0.0f;     // of all impulses over the last step
};

struct JointDetail {
  bool used = false;
  bool disabled = false;
  bool path_closed = false;
  bool has_swing = false;
  PathOrientation path_orientation = PathOrientation::free;
  // What is asked of most joints in each step lies together.
  float friction = 0.0f;  // N m, against all turning: ball, cone
  float swing_y = 0.0f;   // rad
  float swing_z = 0.0f;
  PoseDrive drive;
  JointAxisRecord axes[kJointAxisCount];
  float row_impulses[kJointAxisCount] = {};  // of the rows of kinds that have only these
  Vec3 drive_force_impulse;
  Vec3 drive_torque_impulse;
  Vec3 friction_impulse;
  float ratio = 1.0f;
  Quat reference_a;  // world_from_joint when the joint was added
  Quat reference_b;
  float start = 0.0f;  // rack_and_pinion: m, where the rack was
  DVec3 ground_a;      // pulley
  DVec3 ground_b;
  std::uint32_t path_first = 0;  // of its points
  std::uint32_t path_count = 0;
  float path_parameter = 0.0f;  // where on it, in points
};

// One point of a curve; places between are Catmull-Rom's.
struct PathPoint {
  Vec3 position;       // in the joint's frame on a
  float along = 0.0f;  // m, of the curve from the first point
  Vec3 up;             // unit, across the curve; carried along without twist
};

// Takes everything away that the last step left in the record: the joint goes on as if it were new.
void clear_impulses(JointRecord& joint);
void clear_impulses(JointDetail& detail);

}  // namespace gyre
