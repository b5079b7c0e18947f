// The window of a gas with an adaptive domain before a step: what moves in the gas, and what will move it.
//
// In: the gas, bodies, soft matter, emitters. Out: a gas whose arrays hold the tiles around all of these.
#pragma once

#include "dynamics/fluid/fluid_solids.h"
#include "soft/store/soft_store.h"

namespace gyre {

// For a gas with an adaptive domain, whose near shapes are listed. `gravity`: in the axes of the box; `time`: at the beginning of the step, s.
void adapt_domain(const RigidWorld& w, const SoftStore& soft, const FluidSolids& solids, Vec3 gravity,
                  double time, float seconds, TaskSystem& tasks, FluidEntry& entry);

// True if all of a body that lies in the box of a gas lies in the window.
bool is_within_window(const GasGrid& gas, const FluidSolids& solids, std::uint32_t body);

}  // namespace gyre
