// How a world moves its bodies where that is not the default: integrator, springs, time plan. Part of the state.
#pragma once

#include <gyre/defs.h>
#include <gyre/math.h>

#include <cstdint>

namespace gyre {

constexpr float kMinTolerance = 1.0e-9f;  // m
constexpr int kMaxImpacts = 4096;

struct MotionSettings {
  IntegratorKind integrator = IntegratorKind::semi_implicit_euler;
  SpringKind springs = SpringKind::implicit;
  TimeStepping time = TimeStepping::fixed;
  float tolerance = 1.0e-5f;       // m
  std::int32_t max_impacts = 128;  // in a step
  std::int32_t planned_substeps =
      0;  // that the next step begins with, by the error of the last; 0: as many as the settings say
};

inline bool is_default(const MotionSettings& m) {
  return m.integrator == IntegratorKind::semi_implicit_euler && m.springs == SpringKind::implicit &&
         m.time == TimeStepping::fixed;
}

// What Verlet knows of a body instead of a velocity: the way from its last pose but one to its last. (Not that pose itself: the
// difference of two rounded places has lost its digits, and what is put elsewhere takes both poses with it.) The velocities are
// those that were shown; whoever changes them since has changed the body's motion, and the next step begins with theirs.
struct LastMove {
  DVec3 moved, turned;   // m; rad, rotation vector, world frame
  double seconds = 0.0;  // in which; 0: there is none
  Vec3 linear, angular;  // m/s, rad/s
};

}  // namespace gyre
