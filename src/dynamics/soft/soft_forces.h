// Force fields and gases on soft matter in a sub-step: wind and drag on faces and segments, attraction on particles. A fluid is wind of its own
// velocity and density at each place, of the coefficient 1, and a liquid carries what it displaces.
//
// A face feels F = 1/2 rho C A |w . n| |w| w for the flow w past it, once, whichever side it shows; a solid's face only where the flow meets
// it from outside; a segment of a rope 1/2 rho C 2 r l |w'| w' with the flow w' across it. Drag cannot turn the flow round within a
// sub-step: it is scaled by 1 / (1 + h |F| / (m |w|)), which is backward Euler of its present size. Nor can it turn round
// a layer of cells of a fluid within the step.
#pragma once

#include "fluid/store/fluid_store.h"
#include "rigid/store/rigid_world.h"
#include "soft/store/soft_store.h"

namespace gyre {

// Sets the forces from outside of all particles. `time`: s, for gusts; `h`: s; `again`: the sub-step is tried once more. Notes what fluids give to
// each particle, which they get back at the end of the step (fluid_reaction.h).
void set_field_forces(const RigidWorld& w, const FluidStore& fluids, SoftEntry& entry, double time, float h,
                      bool again);

}  // namespace gyre
