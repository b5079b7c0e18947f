// Visitors of a fluid: bodies with a point inside it, and soft matter with a vertex inside it. The region of a liquid is the room within its
// surface, that of a gas its box.
//
// In: the fluid, shapes at their poses, vertices. Out: a list by index. A body is found where the point of it that is nearest to the centre of a
// wet cell lies within the surface, so the moment is right within a fraction of a cell; in a gas, by alternate projections on the body and the
// box (W. Cheney, A. Goldstein, "Proximity maps for convex sets", 1959).
#pragma once

#include "base/container/array.h"
#include "fluid/store/fluid_store.h"
#include "rigid/store/rigid_world.h"
#include "soft/store/soft_store.h"

namespace gyre {

struct FoundVisitor {
  FluidVisitor who;
  int vertex = -1;  // of soft matter: the first inside
};

// Bodies, then soft matter, each ascending by index. Fixed bodies and sensors do not count.
void find_fluid_visitors(const RigidWorld& w, const SoftStore& soft, const FluidEntry& entry,
                         Array<FoundVisitor>& out);

// After a step: compares with the visitors of the step before, which are state, and adds the events to the store.
void update_fluid_visitors(const RigidWorld& w, const SoftStore& soft, FluidStore& fluids);
// All visitors of a fluid that is about to be removed leave.
void end_fluid_touches(const RigidWorld& w, FluidStore& fluids, std::uint32_t slot);

}  // namespace gyre
