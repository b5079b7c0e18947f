// The reaction of ropes, cloths and solids on fluids: after a step each fluid gets the opposite of the impulses that its drag and its lift gave to
// their particles, at the places of these. So the momentum of both together is kept.
//
// In: the impulses that soft_forces.h has noted. Out: the velocities of gases on faces and of the particles of liquids. A gas gets an impulse on
// the faces around by linear weights; of a liquid the particles around get it in proportion to theirs. Where all of that is closed or
// empty the impulse is lost.
#pragma once

#include "dynamics/fluid/fluid_step.h"
#include "soft/store/soft_store.h"

#include <vector>

namespace gyre {

// Forgets the impulses of the step before.
void clear_fluid_impulses(SoftStore& soft);
void push_fluids_back(SoftStore& soft, FluidStore& fluids, std::vector<FluidScratch>& scratch);

}  // namespace gyre
