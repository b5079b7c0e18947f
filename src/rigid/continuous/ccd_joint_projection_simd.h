// Leads groups along side by side: those that are whole linkages of ball, cone and hinge joints with hard stops, as limbs of ragdolls
// are, by the kernels that solve these in the sub-steps (solver/articulation/articulation_lanes.h). A short step's speeds stand for displacements: the
// equations are solved directly, stops with them, and both take errors back wholly. Joints are measured and placed anew for each
// motion, as in closing_rows.h, but one solution after another takes the place of Newton's steps.
//
// In: groups, of which some may be others. Out: where the bodies of those that fit have come, and which groups these are.
#pragma once

#include "rigid/continuous/ccd_projection_path.h"
#include "solver/contact/contact_block.h"
#include "task/task_system.h"

namespace gyre {

// Returns by group whether it was led.
std::span<const std::uint8_t> project_batched(RigidWorld& w, std::span<const ProjectionGroup> groups,
                                              const ProjectionBodies& bodies, bool stop_at_impact,
                                              const ContactKernels& kernels, TaskSystem& tasks, Arena& arena);

}  // namespace gyre
