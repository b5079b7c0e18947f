// The persistent state of a joint, part of the world's state.
//
// Every joint has a record. Details hold what few joints have (several axes, friction, drives, curves);
// worlds without such joints store none.
#pragma once

#include "solver/core/body_motion.h"

#include <gyre/joints.h>

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
  DVec3 world_anchor_a;  // the anchor, if that body is the world
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
  // Impulses of the last sub-step, world axes, on B, for the warm start.
  Vec3 linear_impulse;
  Vec3 angular_impulse;
  float low_impulse = 0.0f;  // of the limits; gear, rack: of the only row
  float high_impulse = 0.0f;
  float motor_impulse = 0.0f;
  float spring_impulse = 0.0f;
  float position = 0.0f;  // unwrapped angle, slide or length
  // Sums over the last step, for readings.
  Vec3 total_linear;
  Vec3 total_angular;
};

// max_length of a joint without a maximum.
constexpr float kUnlimitedLength = 1.0e30f;

// Settings of one axis of a joint, and the impulses of the last sub-step.
struct JointAxisRecord {
  AxisMotion motion = AxisMotion::locked;
  bool has_motor_target = false;
  Limits limits;                 // used if the axis is limited
  float limit_frequency = 0.0f;  // Hz; 0: hard limits
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
  float locked_position = 0.0f;  // position of a locked axis
  float low_impulse = 0.0f;
  float high_impulse = 0.0f;
  float motor_impulse = 0.0f;
  float spring_impulse = 0.0f;
  float friction_impulse = 0.0f;
  float position = 0.0f;  // m or rad, unwrapped
  float total = 0.0f;     // of all impulses over the last step
};

// The frame against which a gear counts turns.
enum class GearFrame : std::uint8_t {
  world,
  centres,  // the line from shaft to shaft, which turns with the housing
  shafts,   // the plane of two shafts that are not parallel
};

struct JointDetail {
  bool used = false;
  bool disabled = false;
  bool path_closed = false;
  bool has_swing = false;
  PathOrientation path_orientation =
      PathOrientation::free;  // path; gear: its GearFrame, so that snapshots keep their layout
  // Fields that each step reads come first.
  float friction = 0.0f;  // N m, against all rotation: ball, cone
  float swing_y = 0.0f;   // rad
  float swing_z = 0.0f;
  PoseDrive drive;
  JointAxisRecord axes[kJointAxisCount];
  float row_impulses[kJointAxisCount] = {};  // of the rows, for kinds whose equations are rows
  Vec3 drive_force_impulse;
  Vec3 drive_torque_impulse;
  Vec3 friction_impulse;
  float ratio = 1.0f;
  Quat
      reference_a;  // world_from_joint when the joint was added; of gears and pinions, it follows the axis; of
                    // gears in a housing, from the frame of the shafts
  Quat reference_b;
  float start = 0.0f;  // rack_and_pinion: m, initial position of the rack
  DVec3 ground_a;      // pulley
  DVec3 ground_b;
  std::uint32_t path_first = 0;  // index of its first point
  std::uint32_t path_count = 0;
  float path_parameter = 0.0f;  // present parameter of the curve, in points
};

// One point of a curve; between points the curve is Catmull-Rom's.
struct PathPoint {
  Vec3 position;       // in the joint's frame on a
  float along = 0.0f;  // m, length of the curve from the first point
  Vec3 up;             // unit, normal to the curve; transported without twist
};

inline GearFrame gear_frame(const JointDetail& detail) { return GearFrame(detail.path_orientation); }

// Clears what the last step left in the record, as if the joint were new.
void clear_impulses(JointRecord& joint);
void clear_impulses(JointDetail& detail);

}  // namespace gyre
