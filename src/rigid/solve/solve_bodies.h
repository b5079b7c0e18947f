// Gathers the bodies of a batch.
//
// In: its bodies, and those that constraints act on (solve_gather.h). Out: Solve::moved and Solve::flying.
#pragma once

#include "rigid/solve/solve.h"

namespace gyre {

// Parts the bodies of a batch into those that constraints act on and those that fly. Of the former those in contact come first;
// those of a domain and those that turn alike lie side by side.
void gather_motion(BatchContext& solve, Arena& arena, TaskSystem& tasks);

}  // namespace gyre
