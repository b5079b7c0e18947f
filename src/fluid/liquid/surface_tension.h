// Surface tension: the pressure at the surface is sigma times its curvature, which is minus the divergence of the direction in which the
// smoothed fraction of liquid grows (J. Brackbill, D. Kothe, C. Zemach, "A Continuum Method for Modeling Surface Tension", 1992).
#pragma once

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

// The pressure over density of cells of air beside liquid: `ratio` is surface tension over density, m^3/s^2.
void set_surface_pressure(const LiquidPass& pass, float ratio);
// The longest stable step: the fastest ripple must not pass an edge within it.
float capillary_step(const GasBox& box, float ratio);

}  // namespace gyre
