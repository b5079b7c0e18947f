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
// True if particles go ahead of the velocity, see below: where no body moves by the pressure, since that gets its impulse at once, and viscosity
// is weak, since it has no part in what is ahead.
bool leads(const LiquidPass& pass, const LiquidSettings& settings);
// Adds half a step of weight and pressure to the velocity that particles take with them, as the next sub-step would; that one adds the rest. So they
// have what acts on them in the middle of their way, and a liquid that turns goes on turning. Of the pressure counts what the sub-step
// before had too, so that a blow does not act twice. The carrier is without it.
void lead_velocity(const LiquidPass& pass, const LiquidSettings& settings);
PressureReport find_carrier(const LiquidPass& pass);
// The largest net outflow of a liquid cell over its volume, 1/s.
float largest_liquid_divergence(const LiquidPass& pass);

}  // namespace gyre
