// The sub-steps of a rigid step as a program: constraints are gathered and coloured once, then for each sub-step
//   watch impacts, predict, strike impacts, prepare joints, warm start, solve, advance, release impacts, relax.
// Workers meet at a barrier between stages; within one, blocks share no moving body.
#pragma once

#include "base/arena.h"
#include "rigid/rigid_world.h"
#include "solver/contact_block.h"
#include "solver/impact.h"
#include "task/coloring.h"
#include "task/task_system.h"

namespace gyre {

// Kept from step to step only for its memory.
struct SolveScratch {
  Array<ContactConstraint> constraints;
  Array<std::uint32_t> constraint_contact;  // contact slot of each constraint
  Array<ImpactContact> impacts;
  Array<ColoringPair> pairs;
  Coloring contact_colors;
  Coloring joint_colors;
  Array<std::uint32_t> joints;       // slots of joints that act in this step
  Array<ColoringPair> joint_pairs;
  Array<std::uint64_t> immovable;    // bits by body
  Array<std::uint32_t> order;        // constraint indices, W a block
  int colors = 0;
};

// How constraints are shared among groups.
constexpr ColoringOptions kColoringOptions{.max_colors = 32, .statics_last = true};

// Solves one step of `seconds` in `substeps` sub-steps: velocities, `moved`, `turned` and orientations of awake bodies,
// impulses in manifolds and joints.
void solve_step(RigidWorld& w, SolveScratch& scratch, Arena& arena, TaskSystem& tasks, const ContactKernels& kernels,
                float seconds);

}  // namespace gyre
