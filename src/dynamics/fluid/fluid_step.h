// The step of all fluids, before that of bodies: shapes cut the cells, fluids move, and the pressure gives its force to bodies for the whole
// step. A fluid is stepped once a step; it divides its step where it moves more than some cells.
//
// In: fluids, shapes and the motion of bodies. Out: fluids at the end of the step, forces on bodies, bodies that wake.
#pragma once

#include "base/container/array.h"
#include "dynamics/fluid/fluid_solids.h"
#include "fluid/store/fluid_store.h"
#include "rigid/store/rigid_world.h"
#include "soft/store/soft_store.h"

#include <vector>

namespace gyre {

struct FluidReport {
  int substeps = 0;
  int iterations = 0;       // of the pressure
  float divergence = 0.0f;  // 1/s
  float residual = 0.0f;    // 1
  double heat_rate = 0.0;   // W, of combustion
  bool failed = false;      // the fluid stopped being finite and was stilled
  bool full = false;        // sources gave nothing, since there are as many particles as may be
};

// Memory, solids and the report of a fluid: kept from step to step, and no state. With a new one the results have the same bits.
struct FluidScratch {
  FluidSolids solids;
  GasMemory gas;
  LiquidMemory liquid;
  Array<GasImpulse> impulses;  // by label
  Array<FluidBody> bodies;     // by label
  Array<LiquidEmitter> sources;
  FluidReport report;
};

// `scratch`: by slot. Cleared by whoever replaces the state.
void step_fluids(RigidWorld& w, const SoftStore& soft, FluidStore& fluids, std::vector<FluidScratch>& scratch,
                 const GasKernels& kernels, TaskSystem& tasks, double time, float seconds);

// The fluid at a point: false if there is none. A liquid counts within its surface, and before gases; else the one that was added first.
struct FluidStream {
  Vec3 velocity{};       // m/s
  float density = 0.0f;  // kg/m^3
  bool is_liquid = false;
  float edge = 0.0f;  // m, the shortest of a cell
};
// The slot of the fluid at a point, by the same choice; -1: there is none.
int find_fluid(const FluidStore& fluids, DVec3 point);
bool find_stream(const FluidStore& fluids, DVec3 point, FluidStream& out);

}  // namespace gyre
