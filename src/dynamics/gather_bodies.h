// Gathers the bodies of a batch.
//
// In: its bodies, and those that constraints act on (dynamics/gather_constraints.h). Out: BodyMotionSolve::moved and free_bodies.
#pragma once

#include "dynamics/batch_context.h"

namespace gyre {

// Parts the bodies of a batch into those that constraints act on and free ones. Of the former those in contact come first; those of a
// worker's share and those whose rotation is integrated alike lie side by side.
void gather_bodies(BatchContext& batch, Arena& arena, TaskSystem& tasks);

}  // namespace gyre
