// Builds the program of a batch: its sub-steps as a table of stages (task/program.h). A sub-step of the settings is two half-steps, each of
// which is solved once; add_half_step in the source is their order.
//
// In: a gathered and laid out batch (dynamics/batch_context.h). Out: velocities, delta positions, delta rotations and orientations of its
// bodies, impulses of its manifolds and joints.
#pragma once

#include "dynamics/batch_context.h"

namespace gyre {

void run_substeps(BatchContext& batch, Arena& arena, TaskSystem& tasks);

}  // namespace gyre
