// Bodies for the motion kernels: W side by side, with all data of a sub-step beside their motion records.
// Blocks are built at the start of a step in its arena; nothing that depends on W outlives the step.
//
// In: MovedBody (forces on a body, and its inertia). In and out: motion records. Out: orientations and
// inertia of bodies whose pose is read between sub-steps.
#pragma once

#include "solver/core/body_motion.h"

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

// Bounds of faithful simulation; speeds are clamped to them and the clamping is reported.
constexpr float kMaxSpeed = 1.0e7f;  // m/s
constexpr float kMaxSpin = 2.0e4f;   // rad/s
inline DVec3 clamp_length(DVec3 v, double max_length) {
  const double size = length(v);
  return size > max_length ? (max_length / size) * v : v;
}

// A constrained body. It is plain data for every width.
struct MovedBody {
  std::int32_t body = kNoBody;  // index of its records; kNoBody: an empty lane
  // The exact step of dv/dt = a - damping v is v += gain a - loss v.
  Vec3 velocity_gain;  // m/s: gain times the acceleration by forces
  float linear_loss = 0.0f;
  Vec3 torque;  // N m, times the gain of the angular velocity
  float angular_loss = 0.0f;
  Sym3 inertia;  // body frame
  Sym3 inverse_inertia;
  Quat orientation;              // at the beginning of the step
  float bounding_radius = 0.0f;  // m, farthest point from the centre of mass
  std::uint8_t locked = 0;       // locked world axes: bits 0 to 2
  bool isotropic = false;    // equal principal moments: no gyroscopic torque
  bool needs_exact_rotation = false;  // the kernels do not rotate it
  bool pose_read = false;             // its orientation and inertia are written in each sub-step
  bool carries_rounding = false;      // what rounding loses of a velocity in one half-step goes into the next
};

// The columns that the kernels read and write, indexed by body.
struct MotionArrays {
  BodyMotion* motion = nullptr;
  BodyInertia* inertia = nullptr;
  Quat* orientation = nullptr;
};

// Velocities in lanes outside of the motion records: from `first_block` on six vectors for each block,
// linear, then angular. All are aligned as vectors.
struct LaneVelocities {
  float* first = nullptr;  // null: velocities are in the motion records
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
  // Integrates velocities by forces and damping; with `warm` adds the contact impulses of the last sub-step.
  // With `recorded`, the change of velocity from here on counts as the effect of contacts.
  void (*integrate_velocities)(void* blocks, int begin, int end, BodyMotion* motion, bool warm,
                               bool recorded);
  // Only the second half of integrate_velocities.
  void (*warm_start)(void* blocks, int begin, int end, BodyMotion* motion);
  // Records velocities: their change from here on counts as the effect of contacts.
  void (*start_contact_change)(void* blocks, int begin, int end, const BodyMotion* motion);
  // Stores the velocity change since the record as the effect of contacts and restarts the record.
  // `integrate_positions` does this itself unless another stage runs in between.
  void (*add_contact_change)(void* blocks, int begin, int end, const BodyMotion* motion);
  // Displacement, rotation and gyroscopic torque over a sub-step.
  void (*integrate_positions)(void* blocks, int begin, int end, MotionArrays arrays, float substep,
                              bool recorded);
  // Saves velocities and clears them: pushout works on displacements in their place.
  void (*begin_projection)(void* blocks, int begin, int end, BodyMotion* motion);
  // Applies these displacements and restores the velocities. Rotations go to `rotations` too (one for each
  // body of prepare), because bodies that need exact rotation are rotated elsewhere.
  void (*end_projection)(void* blocks, int begin, int end, BodyMotion* motion, Vec3* rotations);

  // The same with velocities in lanes; add_contact_change_in_lanes reads records and writes lanes. Null
  // for kernels with few lanes, which gain little by this.
  void (*integrate_velocities_in_lanes)(void* blocks, int begin, int end, const LaneVelocities& lanes,
                                        bool warm, bool recorded);
  void (*start_contact_change_in_lanes)(void* blocks, int begin, int end, const LaneVelocities& lanes);
  void (*add_contact_change_in_lanes)(void* blocks, int begin, int end, const BodyMotion* motion,
                                          const LaneVelocities& lanes);
  // The effect of contacts has been recorded before.
  void (*integrate_positions_in_lanes)(void* blocks, int begin, int end, MotionArrays arrays,
                                       const LaneVelocities& lanes, float substep);
};

}  // namespace gyre
