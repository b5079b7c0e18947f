// Ropes as particles on a line.
#pragma once

#include "soft/body/soft_body.h"

namespace gyre {

struct RopeMaterial {
  float linear_density = 0.1f;       // kg/m
  float stretch_stiffness = 1.0e4f;  // N: EA
  float bend_stiffness = 0.0f;       // N m^2: EI
  float damping = 0.0f;              // s
  bool keeps_length = true;          // rods: no segment changes its length, whatever the stretch stiffness
};

// A rope along `points`, at rest there. With `segments` one less than the points, the points are its particles; else particles lie evenly
// along the line.
SoftBody rope_along(std::span<const DVec3> points, int segments, const RopeMaterial& material);

}  // namespace gyre
