// How a world integrates motion: integrator, springs, time stepping. Part of the state.
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
  std::int32_t planned_substeps = 0;  // of the next step, from the error of the last; 0: as the settings say
};

inline bool is_default(const MotionSettings& m) {
  return m.integrator == IntegratorKind::semi_implicit_euler && m.springs == SpringKind::implicit &&
         m.time == TimeStepping::fixed;
}

// The state of the Verlet integrator in place of a velocity: the displacement from the pose before the last to the
// last pose. The former pose itself would not do: the difference of two rounded positions loses digits, and a
// teleport moves both poses. `linear` and `angular` are the velocities that were published; if a command changed them
// since, the next step starts from the new ones.
struct LastMove {
  DVec3 moved, turned;   // m; rad, rotation vector, world frame
  double seconds = 0.0;  // duration of the displacement; 0: there is none
  Vec3 linear, angular;  // m/s, rad/s
};

}  // namespace gyre
