// The submerged part of shapes that are round about their local y. See submerged.h.
#pragma once

#include "geometry/mass/submerged.h"

namespace gyre {

SubmergedPart submerged_sphere(double radius, DVec3 normal, double level);
// Capsule, cylinder, cone.
SubmergedPart submerged_round(const Shape& shape, DVec3 normal, double level);

}  // namespace gyre
