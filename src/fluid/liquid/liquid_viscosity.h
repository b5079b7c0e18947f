// The viscosity of a liquid, implicit: the velocity that costs least, its difference from the one before and the heat of a step together. The
// heat is that of the whole strain, so a liquid that turns as a whole is not slowed, and nothing drags at the surface (C. Batty, R. Bridson,
// "Accurate Viscous Free Surfaces for Buckling, Coiling, and Rotating Liquids", 2008).
//
// Walls that hold the liquid (no_slip) have their velocity half a cell beyond the faces next to them; along others and along solids it slips.
#pragma once

#include "fluid/liquid/liquid_pass.h"

namespace gyre {

// Returns the number of iterations.
int add_liquid_viscosity(const LiquidPass& pass, float kinematic_viscosity);

}  // namespace gyre
