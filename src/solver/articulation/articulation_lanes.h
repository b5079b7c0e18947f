// Linkages side by side: where several hang together alike (the ragdolls of a heap, the chains of a curtain), lane i of a
// bundle is the i-th of them, and kernels (solver/articulation/articulation_kernel.h) solve W at once in the time of one. The equations are those
// of solver/articulation/articulation.h; this is the form of linkages of ball, cone and hinge joints on which nothing acts but hard stops, motors and drives
// that turn, and dry friction.
//
// A lane never sees its neighbours, so its bits do not depend on them, on W, or on which bundle a linkage is in.
#pragma once

#include "math/block_plan.h"
#include "solver/core/body_motion.h"
#include "solver/core/error_bounds.h"

#include <gyre/defs.h>

#include <cstddef>

namespace gyre {

// A stop at either end of an axis about which a joint turns. In each of these structs the floats are in the order of the kernels'
// (a float of a lane is W floats there); what goes in and comes out stands first.
struct LaneLimitAxis {
  float low = 0.0f, high = 0.0f;  // rad: where the stops are
  float low_impulse = 0.0f, high_impulse = 0.0f;
  float total = 0.0f;                     // of the impulses over the step
  float low_gap = 0.0f, high_gap = 0.0f;  // rad: how far it is to them
  Vec3 about;                             // of this sub-step: turning a limb about it changes the angle
  float mass = 0.0f;                      // effective
};

// A joint as one lane.
struct LaneJoint {
  Vec3 local_a, local_b;  // anchors from the centres of mass, body frames
  Vec3 offset;            // JointOffsets::offset
  Vec3 linear_impulse, angular_impulse;
  Vec3 total_linear, total_angular;
  // What hinges and cones have.
  Quat local_frame_a, local_frame_b;
  float position = 0.0f;                           // rad: the twist
  float inverse_swing_y = 0.0f, inverse_swing_z = 0.0f;  // cones: 1 / the largest swing, 1/rad
  LaneLimitAxis twist, swing;
  // Of this sub-step.
  Vec3 from_a, from_b;  // anchors from the centres of mass, world axes
  Vec3 error;           // anchor b minus anchor a
  Vec3 compliance, target_speed;  // of the three rows of the point, as ArticulationRows
  // Hinges: a's axis and what is across it, the error, the two rows that keep the axes together.
  Vec3 axis, perpendicular_1, perpendicular_2, angular_error;
  float angular_compliance_1 = 0.0f, angular_compliance_2 = 0.0f, angular_target_1 = 0.0f, angular_target_2 = 0.0f;
};

// What turns a joint, or holds its turning up: a drive towards a pose, or a motor, and dry friction, each up to a bound. Vectors are in
// world axes; of hinges what is about the axis stands in x.
struct LaneDrives {
  Vec3 drive_impulse, friction_impulse;
  float total = 0.0f;                                          // hinges: of the impulses over the step
  float max_drive = 0.0f, max_friction = 0.0f;                 // N m s: impulses of a sub-step
  Vec3 target_speed;                                           // rad/s, in the joint's frame on a
  Quat target;                                                 // a from b; of hinges x is an angle
  float rate = 0.0f, mass_scale = 1.0f, impulse_scale = 0.0f;  // how soft the drive is: Softness
  // Of this sub-step.
  Vec3 error, speed;  // of the drive: from the target, and that asked for
  Sym3 mass;          // effective
};

// The motor of a hinge that has no frequency of its own: as stiff as the sub-step allows, it is a stop from both sides, up to a bound. Its
// impulse, of either sign, is the low one of the axis, and the place to be held the low end.
struct LaneServo {
  LaneLimitAxis axis;
  float max_impulse = 0.0f;          // N m s: impulse of a sub-step
  float target_speed = 0.0f;  // rad/s
  float rate = 0.0f;          // 1/s, at which it goes to its place; 0: it has none
};

// More servos than that are swept, as drives are: sweeps over so many rows that depend on each other end before they stand.
constexpr std::size_t kMaxLaneServos = 32;

// More stops than that are solved in turns (solver/articulation/articulation_limits.h), not in lanes.
constexpr std::size_t kMaxLaneLimits = 64;

// What the linkages of a bundle have in common.
struct LaneNode {
  JointKind kind = JointKind::ball;
  bool has_twist = false, has_swing = false;  // stops
  bool has_drive = false, has_friction = false;   // swept
  bool has_servo = false;                         // among the stops
  std::uint32_t a = 0, b = 0;                     // entries of the bundle's bodies
  std::uint32_t rows = 0, row = 0, diagonal = 0;  // in the plan
  std::uint32_t column = 0;                       // there: its place
  std::uint32_t drives = 0, servo = 0;            // which of the bundle's, if it has any

  bool is_driven() const { return has_drive || has_friction; }
};
// From a body whose place is known to one that a joint ties to it.
struct TraversalStep {
  std::uint32_t node = 0;
  bool to_b = false;
};
struct LaneCoupling {
  std::uint32_t row = 0, column = 0;  // nodes
  std::uint32_t offset = 0;
  std::uint32_t body = 0;
  bool row_has_b = false, column_has_b = false;
  bool is_first = false;  // of those with this block
};

struct ArticulationKernels;
struct ArticulationBundle {
  const ArticulationKernels* kernels = nullptr;
  const LaneNode* nodes = nullptr;
  const LaneCoupling* couplings = nullptr;
  const TraversalStep* traversal =
      nullptr;  // from the first body to all others; of those that hang on one body at most
  std::uint32_t node_count = 0, coupling_count = 0;
  std::uint32_t body_count = 0, moving_count = 0;  // those that can be pushed come first
  // The plan of elimination, the same for all lanes.
  const BlockColumn* columns = nullptr;
  const BlockEntry* entries = nullptr;
  const std::uint32_t* targets = nullptr;
  std::uint32_t column_count = 0, value_count = 0, row_count = 0;
  bool has_fill = false;          // blocks of the plan in which nothing stands before elimination
  std::uint32_t limit_count = 0;  // axes with stops, and servos
  std::uint32_t drive_count = 0;  // joints with drives or friction
  std::uint32_t servo_count = 0;
  bool has_drives = false;  // what does work: drives, servos
  std::byte* bodies = nullptr;
  std::byte* joints = nullptr;
  std::byte* drives = nullptr;
  std::byte* servos = nullptr;
  float* values = nullptr;  // of the matrix
  float* vector = nullptr;
  float* room = nullptr;        // of the widest column
  float* energy_gain =
      nullptr;  // J, by lane: what joints gave in this sub-step; then 1 in lanes that are watched
  float* has_extreme_mass_ratio = nullptr;  // 1 in lanes with a link so light that it is always watched
  bool* is_factored = nullptr;  // whether `values` are factors by now
  std::byte* limits = nullptr;   // what is known of them in this step: as much as limit_room() says
};

struct LaneArrays {
  BodyMotion* motion = nullptr;
  const BodyInertia* inertia = nullptr;
  const Quat* orientation = nullptr;
  // Whether a stage takes the velocities of what it may push from the records, and leaves them there: else they stay in the lanes, without -0
  // there, too.
  bool loads = true, stores = true;
};

struct LaneSettings {
  float substep = 0.0f;
  float rate = 0.0f;  // 1/s, at which errors are taken back
  // As ArticulationSolve::give, 1e-4 or so: far above the rounding of floats, in which the matrix is eliminated.
  float compliance = 0.0f;
  // The inverse of an inertia raised by `share` of what of `pull` holds back (six floats each, as Sym3).
  void (*add_geometric_stiffness)(const float* geometric_stiffness, const float* inertia, float share,
                float* inverse) = nullptr;
  // What the first of two solutions takes back.
  ErrorBounds first_errors = kErrorsBeforeContacts;
  // Of the way that free rotation swerves in a sub-step, how much is asked for; none where speeds stand for displacements.
  float gyroscopic_share = 1.0f;
  // Where a body turns by more than that in a sub-step, less of the bend is asked for.
  float max_bias_angle = kMaxBiasAngle;  // rad
  // Whether joints that do work are answered for; not where speeds stand for displacements.
  bool keeps_energy = true;
};

// The kernels of one CPU target. Each body is a block of `body_bytes` that begins with the lanes' body indices (kNoBody: none).
struct ArticulationKernels {
  int width;
  std::size_t body_bytes, joint_bytes, drives_bytes, servo_bytes;
  std::size_t velocities_at;  // bytes: where a body's block has them, as LaneVelocities
  std::size_t (*limit_room)(const ArticulationBundle& bundle);  // bytes
  void (*begin)(const ArticulationBundle& bundle);  // before it is placed for the first time in a step
  void (*prepare)(const ArticulationBundle& bundle, const LaneArrays& arrays, const LaneSettings& settings);
  void (*compute_bias)(const ArticulationBundle& bundle, const LaneArrays& arrays, const LaneSettings& settings);
  void (*solve)(const ArticulationBundle& bundle, const LaneArrays& arrays, const LaneSettings& settings);
  void (*solve_after_contacts)(const ArticulationBundle& bundle, const LaneArrays& arrays,
                      const LaneSettings& settings);
  // After each move but the last: sums impulses, and asks for what the next part begins with.
  void (*end_half_step)(const ArticulationBundle& bundle, const LaneArrays& arrays, const LaneSettings& settings);
  // After the last move: no speed is left along the rows or into stops; sums impulses.
  void (*end_step)(const ArticulationBundle& bundle, const LaneArrays& arrays, const LaneSettings& settings);
};

}  // namespace gyre
