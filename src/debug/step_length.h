// The length of the last step: impulses divided by it are forces.
#pragma once

#include "rigid/store/rigid_world.h"

namespace gyre {

// 1/s; 0 before the first step.
inline float inverse_step_length(const RigidWorld& w) {
  return w.settings.last_step > 0.0f ? 1.0f / w.settings.last_step : 0.0f;
}

}  // namespace gyre
