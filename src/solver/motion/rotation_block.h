// Bodies that turn freely over a sub-step or a step, many side by side: what the kernels of solver/motion/rotation_kernel.h take.
#pragma once

#include "solver/core/body_motion.h"

namespace gyre {

// A body that turns without torque: its orientation and angular velocity are moved on, and the rotation vector by which it turned
// (world frame, rad) is added to what it turned in this step.
struct TorqueFreeRotation {
  BodyMotion* motion = nullptr;
  Quat* orientation = nullptr;
  const Sym3* inertia = nullptr;  // body frame; can be inverted
};
// An orientation that is turned by a rotation vector (rad, world frame).
struct ConstantRotation {
  Quat orientation;
  Vec3 rotation;
  float spare = 0.0f;  // kernels read eight floats
};
// So many at once.
constexpr int kMaxRotations = 64;

struct RotationKernels {
  // At most kMaxRotations, of different bodies.
  void (*rotate_torque_free)(const TorqueFreeRotation* rotations, int count, float seconds);
  // As integrate_rotation of math/rotation.h.
  void (*rotate_at_constant_velocity)(ConstantRotation* rotations, int count);
};

}  // namespace gyre
