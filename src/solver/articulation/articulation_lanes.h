// Articulations side by side: of several with equal topology (the ragdolls of a heap, the chains of a
// curtain), lane i of a bundle is the i-th, and kernels (solver/articulation/articulation_kernel.h) solve W
// at once in the time of one. The equations are those of solver/articulation/articulation.h. Lanes exist for
// ball, cone and hinge joints with only hard limits, motors, angular drives and dry friction.
//
// A lane never reads its neighbours, so its bits do not depend on them, on W, or on its bundle.
#pragma once

#include "math/block_plan.h"
#include "solver/core/body_motion.h"
#include "solver/core/error_bounds.h"

#include <gyre/defs.h>
#include <gyre/joints.h>

#include <cstddef>

namespace gyre {

// The limits of an axis of rotation. In each of these structs the floats have the order of the kernels' (one
// float of a lane is W floats there); inputs and outputs come first.
struct LaneLimitAxis {
  float low = 0.0f, high = 0.0f;  // rad
  float low_impulse = 0.0f, high_impulse = 0.0f;
  float total = 0.0f;                     // of the impulses over the step
  float low_gap = 0.0f, high_gap = 0.0f;  // rad: distance to the limits
  Vec3 about;                             // of this sub-step: rotation of a limb about it changes the angle
  float mass = 0.0f;                      // effective
};

// A joint as one lane.
struct LaneJoint {
  Vec3 local_a, local_b;  // anchors from the centres of mass, body frames
  Vec3 offset;            // JointOffsets::offset
  Vec3 linear_impulse, angular_impulse;
  Vec3 total_linear, total_angular;
  // For hinges and cones.
  Quat local_frame_a, local_frame_b;
  float position = 0.0f;                                 // rad: the twist
  float inverse_swing_y = 0.0f, inverse_swing_z = 0.0f;  // cones: 1 / the largest swing, 1/rad
  LaneLimitAxis twist, swing;
  // Values of this sub-step.
  Vec3 from_a, from_b;            // anchors from the centres of mass, world axes
  Vec3 error;                     // anchor b minus anchor a
  Vec3 compliance, target_speed;  // of the three point rows, as ArticulationRows
  // Hinges: a's axis, two perpendicular axes, the error, and compliance and bias of the two angular rows.
  Vec3 axis, perpendicular_1, perpendicular_2, angular_error;
  float angular_compliance_1 = 0.0f, angular_compliance_2 = 0.0f, angular_target_1 = 0.0f,
        angular_target_2 = 0.0f;
};

// The drive or motor and the dry friction of a joint, each with a bound. Vectors are in world axes; for
// hinges the value about the axis stands in x.
struct LaneDrives {
  Vec3 drive_impulse, friction_impulse;
  float total = 0.0f;                                          // hinges: of the impulses over the step
  float max_drive = 0.0f, max_friction = 0.0f;                 // N m s: largest impulses of a sub-step
  Vec3 target_speed;                                           // rad/s, in the joint's frame on a
  Quat target;                                                 // a from b; for hinges x is an angle
  float rate = 0.0f, mass_scale = 1.0f, impulse_scale = 0.0f;  // softness of the drive
  // Values of this sub-step.
  Vec3 error, speed;  // of the drive: error from the target, and target velocity
  Sym3 mass;          // effective
};

// The motor of a hinge without a frequency of its own. As stiff as the sub-step allows, it is a limit from
// both sides with a bounded impulse. Its impulse, of either sign, is the low one of the axis, and its target
// position the low end.
struct LaneServo {
  LaneLimitAxis axis;
  float max_impulse = 0.0f;   // N m s: largest impulse of a sub-step
  float target_speed = 0.0f;  // rad/s
  float rate = 0.0f;          // 1/s, at which it approaches its target position; 0: it has none
};

// Servos beyond this number are iterated, as drives are: iterations over so many coupled rows end before
// they converge.
constexpr std::size_t kMaxLaneServos = 32;

// Articulations with more limits than this are solved in scalar form, in turns
// (solver/articulation/articulation_limits.h).
constexpr std::size_t kMaxLaneLimits = 64;

// Data that all articulations of a bundle share.
struct LaneNode {
  JointKind kind = JointKind::ball;
  bool has_twist = false, has_swing = false;      // limits
  bool has_drive = false, has_friction = false;   // iterated
  bool has_servo = false;                         // solved with the limits
  std::uint32_t a = 0, b = 0;                     // indices in the bundle's bodies
  std::uint32_t rows = 0, row = 0, diagonal = 0;  // in the plan
  std::uint32_t column = 0;                       // its index in the plan
  std::uint32_t drives = 0, servo = 0;            // indices in the bundle's drives and servos, if it has any

  bool is_driven() const { return has_drive || has_friction; }
};
// From a body with a known position to one connected by a joint.
struct TraversalStep {
  std::uint32_t node = 0;
  bool to_b = false;
};
struct LaneCoupling {
  std::uint32_t row = 0, column = 0;  // nodes
  std::uint32_t offset = 0;
  std::uint32_t body = 0;
  bool row_has_b = false, column_has_b = false;
  bool is_first = false;  // the first in this block
};

struct ArticulationKernels;
struct ArticulationBundle {
  const ArticulationKernels* kernels = nullptr;
  const LaneNode* nodes = nullptr;
  const LaneCoupling* couplings = nullptr;
  const TraversalStep* traversal =
      nullptr;  // from the first body to all others; only for articulations with at most one immovable body
  std::uint32_t node_count = 0, coupling_count = 0;
  std::uint32_t body_count = 0, moving_count = 0;  // movable bodies come first
  // The plan of elimination, the same for all lanes.
  const BlockColumn* columns = nullptr;
  const BlockEntry* entries = nullptr;
  const std::uint32_t* targets = nullptr;
  std::uint32_t column_count = 0, value_count = 0, row_count = 0;
  bool has_fill = false;          // some blocks of the plan are empty before elimination
  std::uint32_t limit_count = 0;  // axes with limits, and servos
  std::uint32_t drive_count = 0;  // joints with drives or friction
  std::uint32_t servo_count = 0;
  bool has_drives = false;  // joints that do work: drives, servos
  std::uint32_t presses_held = 0;  // bits: lanes that press a held body (rigid/solve/held_bodies.h)
  std::byte* bodies = nullptr;
  std::byte* joints = nullptr;
  std::byte* drives = nullptr;
  std::byte* servos = nullptr;
  float* values = nullptr;  // of the matrix
  float* vector = nullptr;
  float* room = nullptr;         // of the widest column
  float* energy_gain = nullptr;  // J, by lane: gain of this sub-step; then 1 in lanes with an energy limiter
  float* has_extreme_mass_ratio = nullptr;  // 1 in lanes with a link so light that the energy limiter is
                                            // always on
  bool* is_factored = nullptr;              // true if `values` are factors already
  std::byte* limits = nullptr;              // data of limits in this step, of the size limit_room()
};

struct LaneArrays {
  BodyMotion* motion = nullptr;
  const BodyInertia* inertia = nullptr;
  const Quat* orientation = nullptr;
  // True if a stage loads the velocities of movable bodies from the records, and stores them there. Otherwise
  // they stay in the lanes, also without -0.
  bool loads = true, stores = true;
};

struct LaneSettings {
  float substep = 0.0f;
  float rate = 0.0f;  // 1/s, at which errors are removed
  // As ArticulationSolve::compliance, about 1e-4: far above the rounding of floats, in which the matrix is
  // eliminated.
  float compliance = 0.0f;
  // Adds `share` of the positive part of the geometric stiffness to an inertia and inverts it (six floats
  // each, as Sym3).
  void (*add_geometric_stiffness)(const float* geometric_stiffness, const float* inertia, float share,
                                  float* inverse) = nullptr;
  // Bounds of the errors that the first of two solves removes.
  ErrorBounds first_errors = kErrorsBeforeContacts;
  // Share of the gyroscopic torque in the rotation of a sub-step; 0 if speeds stand for displacements.
  float gyroscopic_share = 1.0f;
  // Beyond this rotation in a sub-step the second-order bias fades.
  float max_bias_angle = kMaxBiasAngle;  // rad
  // Turns the energy limiter on; off if speeds stand for displacements.
  bool limits_energy = true;
};

// The kernels of one CPU target. Each body is a block of `body_bytes` that begins with the lanes' body
// indices (kNoBody: none).
struct ArticulationKernels {
  int width;
  std::size_t body_bytes, joint_bytes, drives_bytes, servo_bytes;
  std::size_t velocities_at;  // bytes: offset of the velocities in a body's block, as LaneVelocities
  std::size_t (*limit_room)(const ArticulationBundle& bundle);  // bytes
  void (*begin)(const ArticulationBundle& bundle);              // before the first preparation in a step
  void (*prepare)(const ArticulationBundle& bundle, const LaneArrays& arrays, const LaneSettings& settings);
  void (*compute_bias)(const ArticulationBundle& bundle, const LaneArrays& arrays,
                       const LaneSettings& settings);
  void (*solve)(const ArticulationBundle& bundle, const LaneArrays& arrays, const LaneSettings& settings);
  void (*solve_after_contacts)(const ArticulationBundle& bundle, const LaneArrays& arrays,
                               const LaneSettings& settings);
  // After each move but the last: sums impulses, and computes the bias of the next half step.
  void (*end_half_step)(const ArticulationBundle& bundle, const LaneArrays& arrays,
                        const LaneSettings& settings);
  // After the last move: removes all speed along the rows and into limits, and sums impulses.
  void (*end_step)(const ArticulationBundle& bundle, const LaneArrays& arrays, const LaneSettings& settings);
};

}  // namespace gyre
