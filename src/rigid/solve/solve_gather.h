// Gathers the constraints of a batch.
//
// In: a batch of whole islands (rigid/batch/solve_batches.h). Out: its contacts and joints in lists, and between which bodies they are.
#pragma once

#include "rigid/solve/solve.h"

namespace gyre {

// The batch's contacts as constraints, and what colouring needs to know of them; marks the bodies as touched.
void gather_contacts(BatchContext& solve, Arena& arena, TaskSystem& tasks);
// What all joints of the batch are; marks their bodies.
void look_at_joints(BatchContext& solve, Arena& arena, TaskSystem& tasks);
// Those that are in no linkage, as contacts.
void gather_joints(BatchContext& solve);

}  // namespace gyre
