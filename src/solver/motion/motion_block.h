// Bodies as the kernels move them: W side by side, with all that a sub-step needs of them beside their motion records.
// Blocks are built at the start of each step in the step's arena; nothing that depends on W outlives the step.
//
// In: MovedBody (what acts on a body, and its inertia). In and out: motion records. Out: orientations and inertia of those
// bodies whose place others look at between sub-steps.
#pragma once

#include "solver/core/body_motion.h"

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

// Beyond these nothing is simulated faithfully; speeds are clamped to them and the clamping is reported.
constexpr float kMaxSpeed = 1.0e7f;  // m/s
constexpr float kMaxSpin = 2.0e4f;   // rad/s
inline DVec3 clamp_length(DVec3 v, double max_length) {
  const double size = length(v);
  return size > max_length ? (max_length / size) * v : v;
}

// A body that constraints act on. Plain data: the same for every width.
struct MovedBody {
  std::int32_t body = kNoBody;  // index of its records; none: the lane stays empty
  // The exact step of dv/dt = a - damping v:  v += gain a - lost v.
  Vec3 velocity_gain;  // m/s: gain times the acceleration by forces
  float linear_loss = 0.0f;
  Vec3 torque;  // N m, times the gain of angular motion
  float angular_loss = 0.0f;
  Sym3 inertia;  // body frame
  Sym3 inverse_inertia;
  Quat orientation;          // as the step begins
  float bounding_radius = 0.0f;        // m, farthest point from the centre of mass
  std::uint8_t locked = 0;   // world axes that it may not move along: bits 0 to 2
  bool isotropic = false;    // equal principal moments: no gyroscopic torque
  bool needs_exact_rotation = false;  // the kernels leave its rotation alone
  bool pose_read = false;        // its orientation and inertia are written in each sub-step
};

// The columns that kernels read and write, indexed by body.
struct MotionArrays {
  BodyMotion* motion = nullptr;
  BodyInertia* inertia = nullptr;
  Quat* orientation = nullptr;
};

// Velocities that stand side by side where others have laid them: of each block from `first_block` on six vectors, linear, then angular.
// Aligned as vectors are, from block to block too.
struct LaneVelocities {
  float* first = nullptr;  // none: the motion records have them
  std::size_t stride = 0;  // floats from block to block
  int first_block = 0;

  bool is_set() const { return first != nullptr; }
  float* of(int block) const { return first + std::size_t(block - first_block) * stride; }
};

// The kernels of one CPU target: every function works on blocks [begin, end) of the array at `blocks`.
struct MotionKernels {
  std::size_t block_bytes;
  // Blocks of bodies [0, count).
  void (*prepare)(void* blocks, int begin, int end, const MovedBody* bodies, int count,
                  const BodyInertia* inertia);
  // Velocities from forces and damping; with `warm`, then from the impulses of the contacts in the last sub-step. With `watched`, what
  // they gain from here on is the work of contacts.
  void (*integrate_velocities)(void* blocks, int begin, int end, BodyMotion* motion, bool warm, bool recorded);
  // The second half of that alone.
  void (*warm_start)(void* blocks, int begin, int end, BodyMotion* motion);
  // What velocities gain from here on is the work of contacts.
  void (*record_velocities)(void* blocks, int begin, int end, const BodyMotion* motion);
  // What they gained since was; and from here on again. (`advance` does the same of what is watched where nothing comes between.)
  void (*record_velocity_change)(void* blocks, int begin, int end, const BodyMotion* motion);
  // Displacement, rotation and gyroscopic torque over a sub-step.
  void (*integrate_positions)(void* blocks, int begin, int end, MotionArrays arrays, float substep, bool recorded);
  // Puts velocities by and clears them: overlap is pushed apart by displacements in their place.
  void (*begin_projection)(void* blocks, int begin, int end, BodyMotion* motion);
  // Makes these displacements and puts the velocities back. Turns go to `turns` too (one for each body of prepare): those
  // of bodies that turn alone are still to be made.
  void (*end_projection)(void* blocks, int begin, int end, BodyMotion* motion, Vec3* rotations);

  // The same as those above, but velocities are taken from lanes and go there, of `note` from the records to there. None where kernels
  // have few lanes, and the way through records costs little.
  void (*integrate_velocities_in_lanes)(void* blocks, int begin, int end, const LaneVelocities& lanes, bool warm,
                           bool recorded);
  void (*record_velocities_in_lanes)(void* blocks, int begin, int end, const LaneVelocities& lanes);
  void (*record_velocity_change_in_lanes)(void* blocks, int begin, int end, const BodyMotion* motion,
                        const LaneVelocities& lanes);
  // What contacts gave has been noted by now.
  void (*integrate_positions_in_lanes)(void* blocks, int begin, int end, MotionArrays arrays, const LaneVelocities& lanes,
                           float substep);
};

}  // namespace gyre
