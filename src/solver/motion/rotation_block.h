// Bodies in free rotation over a sub-step or a step, for the kernels of solver/motion/rotation_kernel.h.
#pragma once

#include "solver/core/body_motion.h"

namespace gyre {

// A body that rotates without torque. The kernel updates its orientation and angular velocity, and adds the
// rotation vector (world frame, rad) to its delta_rotation.
struct TorqueFreeRotation {
  BodyMotion* motion = nullptr;
  Quat* orientation = nullptr;
  const Sym3* inertia = nullptr;  // body frame; invertible
};
// An orientation that is rotated by a rotation vector (rad, world frame).
struct ConstantRotation {
  Quat orientation;
  Vec3 rotation;
  float spare = 0.0f;  // kernels read eight floats
};
// Capacity of one call.
constexpr int kMaxRotations = 64;

struct RotationKernels {
  // At most kMaxRotations, of different bodies.
  void (*rotate_torque_free)(const TorqueFreeRotation* rotations, int count, float seconds);
  // As integrate_rotation of math/rotation.h.
  void (*rotate_at_constant_velocity)(ConstantRotation* rotations, int count);
};

}  // namespace gyre
