// Bodies that turn freely over a sub-step or a step, many side by side: what the kernels of solver/motion/turn_kernel.h take.
#pragma once

#include "solver/core/body_motion.h"

namespace gyre {

// A body that turns without torque: its orientation and angular velocity are moved on, and the rotation vector by which it turned
// (world frame, rad) is added to what it turned in this step.
struct FreeTurn {
  BodyMotion* motion = nullptr;
  Quat* orientation = nullptr;
  const Sym3* inertia = nullptr;  // body frame; can be inverted
};
// An orientation that is turned by a rotation vector (rad, world frame).
struct SteadyTurn {
  Quat orientation;
  Vec3 turn;
  float spare = 0.0f;  // kernels read eight floats
};
// So many at once.
constexpr int kMostTurns = 64;

struct TurnKernels {
  // At most kMostTurns, of different bodies.
  void (*turn_freely)(const FreeTurn* turns, int count, float seconds);
  // As integrate_rotation of math/rotation.h.
  void (*turn_steadily)(SteadyTurn* turns, int count);
};

}  // namespace gyre
