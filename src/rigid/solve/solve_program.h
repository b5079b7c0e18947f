// The program of a batch: its sub-steps as a table of stages (task/program.h).
//
// In: a batch, gathered and laid out (solve.h). Out: velocities, `moved`, `turned` and orientations of its bodies, impulses
// of its manifolds and joints.
#pragma once

#include "rigid/solve/solve.h"

namespace gyre {

void run_substeps(BatchContext& solve, std::span<Group> contacts, std::span<Group> joints, Arena& arena,
                  TaskSystem& tasks);

}  // namespace gyre
