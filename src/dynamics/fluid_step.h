// The step of all fluids, before that of bodies: shapes cut the cells, fluids move, and the pressure gives its force to bodies for the whole
// step. A fluid is stepped once a step; it divides its step where it moves more than some cells.
//
// In: fluids, shapes and the motion of bodies. Out: fluids at the end of the step, forces on bodies, bodies that wake.
#pragma once

#include "base/container/array.h"
#include "dynamics/fluid_solids.h"
#include "fluid/store/fluid_store.h"
#include "rigid/store/rigid_world.h"

#include <vector>

namespace gyre {

// What a fluid keeps from step to step but does not need: solids, memory, the report.
struct FluidScratch {
  FluidSolids solids;
  GasMemory memory;
  Array<GasImpulse> impulses;
  GasReport report;
  bool failed = false;  // the fluid stopped being finite and was stilled
};

// `scratch`: by slot. Cleared by whoever replaces the state.
void step_fluids(RigidWorld& w, FluidStore& fluids, std::vector<FluidScratch>& scratch,
                 const GasKernels& kernels, TaskSystem& tasks, double time, float seconds);

// Settings of the step of a gas.
GasSettings gas_settings(const GasDef& def, Vec3 gravity);

// The velocity of the gas at a point: true if there is one. The gas that was added first counts.
bool find_wind(const FluidStore& fluids, DVec3 point, Vec3& velocity, float& density);

}  // namespace gyre
