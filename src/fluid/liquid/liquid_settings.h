// LiquidSettings: the material of a liquid and the limits of its step.
#pragma once

#include "fluid/grid/frame_motion.h"
#include "fluid/solver/projection.h"

#include <gyre/math.h>

namespace gyre {

struct LiquidSettings {
  float density = 1000.0f;       // kg/m^3
  float viscosity = 0.0f;        // Pa s
  float surface_tension = 0.0f;  // N/m
  Vec3 gravity{0.0f, -9.81f, 0.0f};
  FrameMotion motion{};
  float blend =
      1.0f;  // 1: particles take their velocity from the grid; 0: only its change (J. Brackbill, H. Ruppel, 1986)
  float max_cells = 2.0f;  // of displacement in a sub-step
  int max_substeps = 32;
  ProjectionSettings projection{1.0e-4f, 1.0e-3f, 60};
};

}  // namespace gyre
