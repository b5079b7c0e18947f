// Projects groups side by side, by the kernels of the sub-steps (solver/articulation/articulation_lanes.h).
// Only for groups that are whole articulations of ball, cone and hinge joints with hard limits, as limbs of
// ragdolls. The speeds of a short step stand for displacements: equations are solved directly, limits with
// them, and both remove whole errors. Joints are measured and prepared anew for each motion, as in
// ccd_joint_projection_rows.h, but repeated solves replace Newton's steps.
//
// In: groups, some of which may not fit. Out: poses of the bodies of those that fit, and which groups these
// are.
#pragma once

#include "rigid/continuous/ccd_projection_path.h"
#include "solver/kernels/solver_kernels.h"
#include "task/task_system.h"

namespace gyre {

// Returns by group whether it was projected.
std::span<const std::uint8_t> project_batched(RigidWorld& w, std::span<const ProjectionGroup> groups,
                                              const ProjectionBodies& bodies, bool stop_at_impact,
                                              const SolverKernels& kernels, TaskSystem& tasks, Arena& arena);

}  // namespace gyre
