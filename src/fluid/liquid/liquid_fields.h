// The fields of a step of a liquid: their window, and their way from the state and back to it.
#pragma once

#include "fluid/liquid/liquid_pass.h"
#include "fluid/liquid/liquid_step.h"

namespace gyre {

// The cells of all particles, now and `ahead` seconds later if they fly on as they do.
CellBox cells_of_particles(const LiquidGrid& grid, float ahead, TaskSystem& tasks);
// The window of these cells, with those of sources that give liquid at this time, and of bodies that move by the pressure and are near: the
// cells of such a body count together. All of the box if it is not known how far a body reaches.
FluidWindow find_window(const LiquidGrid& grid, CellBox cells, std::span<const FluidBody> bodies,
                        std::span<const LiquidEmitter> emitters, double time);
// Makes the arrays those of memory.window, with the pressure of the state.
void begin_fields(const LiquidPass& pass);
// Gives velocity, surface and pressure to the state.
void store_fields(const LiquidPass& pass);

}  // namespace gyre
