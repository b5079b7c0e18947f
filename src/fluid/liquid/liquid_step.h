// The step of a liquid: particles to faces, forces, viscosity, pressure, and back to particles, which then move.
//
// In: the state, what solids leave open of the grid as the step begins, the bodies they belong to, sources. Out: the state at the end, the
// impulses on bodies.
// Sources: C. Jiang et al., 2015, for the transfer; F. Gibou et al., "A Second-Order-Accurate Symmetric Discretization of the Poisson Equation on
// Irregular Domains", 2002, for the pressure at the surface; C. Batty, F. Bertails, R. Bridson, 2007, for solids and bodies.
// docs/derive/liquid.md has the equations.
#pragma once

#include "fluid/grid/fluid_body.h"
#include "fluid/liquid/liquid_grid.h"
#include "fluid/liquid/liquid_memory.h"
#include "fluid/liquid/liquid_settings.h"

#include <span>

namespace gyre {

// In every step that begins in [start, end) the ball is full of liquid of this velocity.
struct LiquidEmitter {
  DVec3 position{};  // m, in the world
  float radius = 0.1f;
  Vec3 velocity{};
  double start = 0.0, end = 1.0e9;  // s
};

struct LiquidReport {
  int substeps = 0;
  int iterations = 0;  // of all sub-steps
  float divergence =
      0.0f;  // 1/s: largest net outflow of a liquid cell over its volume after the last projection
  float residual = 0.0f;  // 1: of the last solve, over its right side
};

// `cut` makes `solids` those of a window of the grid, with the same labels in each; it is called once a step, and again where particles are about to
// leave the window. `bodies` and `impulses`: one for each label of the solids, or none. Impulses are added to. Without bodies, solids move as told.
LiquidReport step_liquid(LiquidGrid& grid, const GasSolids& solids, FunctionRef<void(const FluidWindow&)> cut,
                         std::span<const FluidBody> bodies, std::span<const LiquidEmitter> emitters,
                         const LiquidSettings& settings, double time, float step, LiquidMemory& memory,
                         const GasKernels& kernels, TaskSystem& tasks, std::span<GasImpulse> impulses);

}  // namespace gyre
