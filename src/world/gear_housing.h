// The housing of a gear: the body that carries both shafts on hinges, against which the gear counts its turns.
//
// In: a gear and the hinges of its wheels. Out: the gear's anchors and the frame that it counts in.
#pragma once

#include "rigid/store/rigid_world.h"

namespace gyre {

// A gear counts turns against the body that carries both shafts on hinges, from now on, and its anchors are where the shafts are nearest.
// Shafts on one line stay as they are: two wheels alone bear no torque against a third body.
void find_housing(RigidWorld& w, std::uint32_t slot);

}  // namespace gyre
