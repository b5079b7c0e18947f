// Bodies that turn freely over a sub-step or a step, many side by side: what the kernels of solver/turn_kernel.h take.
#pragma once

#include "solver/body_motion.h"

namespace gyre {

// A body that turns without torque: its orientation and angular velocity are moved on, and the rotation vector by which it turned
// (world frame, rad) is added to what it turned in this step.
struct FreeTurn {
  BodyMotion* motion = nullptr;
  Quat* orientation = nullptr;
  const Sym3* inertia = nullptr;  // body frame; can be inverted
};
// So many at once.
constexpr int kMostFreeTurns = 64;

struct TurnKernels {
  // At most kMostFreeTurns, of different bodies.
  void (*turn_freely)(const FreeTurn* turns, int count, float seconds);
};

}  // namespace gyre
