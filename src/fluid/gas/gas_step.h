// The step of a gas: transport, forces, viscosity, pressure.
//
// In: the state, what solids leave open of the grid, emitters. Out: the state at the end, the impulses of pressure on solids.
// Sources: J. Stam, "Stable Fluids", 1999, for the order; each stage names its own. docs/derive/gas.md has the equations.
#pragma once

#include "fluid/solver/gas_forces.h"
#include "fluid/solver/projection.h"

#include <span>

namespace gyre {

struct GasSettings {
  float density = 1.2f;    // kg/m^3, of the gas
  float buoyancy = 1.0f;   // 1: of gas that expands as an ideal one
  float vorticity = 0.0f;  // 1: strength of confinement
  float viscosity = 0.0f;  // Pa s
  Advection advection = Advection::maccormack;
  Vec3 gravity{0.0f, -9.81f, 0.0f};
  FrameMotion motion{};
  float max_cells = 4.0f;  // of displacement in a sub-step
  int max_substeps = 32;
  ProjectionSettings projection{};
  std::optional<Combustion> combustion{};  // then the grid has fuel
  std::span<const float> emitter_fuel{};   // kg/m^3, one for each emitter, with combustion
};

struct GasReport {
  int substeps = 0;
  int iterations = 0;       // of all sub-steps
  float divergence = 0.0f;  // 1/s: largest net outflow of a cell over its volume after the last projection
  float residual = 0.0f;    // 1: of the last solve, over its right side
  double burned = 0.0;      // kg, of fuel in this step
};

// `bodies`: by label; those that are free to move do so within the pressure equation, the others as told. `impulses`: one for each label of
// the solids, added to. `time`: at the beginning of the step, s.
GasReport step_gas(GasGrid& grid, const GasSolids& solids, std::span<const FluidBody> bodies,
                   std::span<const GasEmitter> emitters, const GasSettings& settings, double time, float step,
                   GasMemory& memory, const GasKernels& kernels, TaskSystem& tasks,
                   std::span<GasImpulse> impulses);

// The velocity made free of divergence without a step, as the start of a flow.
GasReport settle_gas(GasGrid& grid, const GasSolids& solids, const GasSettings& settings, GasMemory& memory,
                     const GasKernels& kernels, TaskSystem& tasks);

}  // namespace gyre
