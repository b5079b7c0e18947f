// Gathers the bodies of a batch.
//
// In: its bodies, with their constraint use (dynamics/gather_constraints.h). Out: BodyMotionSolve::moved and free_bodies.
#pragma once

#include "dynamics/batch_context.h"

namespace gyre {

// Divides the bodies of a batch into constrained and free ones. Among the constrained bodies those in contact come first; bodies of one
// worker's share and of one rotation mode are adjacent.
void gather_bodies(BatchContext& batch, Arena& arena, TaskSystem& tasks);

}  // namespace gyre
