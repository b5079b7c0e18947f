// The pressure of a liquid: makes its velocity free of divergence with the bodies in it, and spreads particles where they crowd.
#pragma once

#include "fluid/liquid/liquid_pass.h"
#include "fluid/liquid/liquid_settings.h"
#include "fluid/solver/pressure_solve.h"

namespace gyre {

// Velocity, pressure and the motions of bodies after the sub-step. Adds to the impulses.
PressureReport project_liquid(const LiquidPass& pass, const LiquidSettings& settings,
                              std::span<GasImpulse> impulses);
// The velocity with which particles move: besides that of the liquid what makes room full but not fuller. Layers are those of the velocity.
PressureReport find_carrier(const LiquidPass& pass);
// The largest net outflow of a liquid cell over its volume, 1/s.
float largest_liquid_divergence(const LiquidPass& pass);

}  // namespace gyre
