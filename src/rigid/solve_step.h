// The sub-steps of a rigid step as a program, one for each batch of islands (solve_batches.h), one after the other:
// constraints are gathered and coloured once, then for each sub-step
//   watch impacts, predict, strike impacts, prepare joints, warm start, solve, advance, release impacts, relax joints
// (docs/step.md has the table);
// at the end contacts are relaxed and overlap is pushed apart.
// Workers meet at a barrier between stages; within one, blocks share no moving body.
#pragma once

#include "base/arena.h"
#include "rigid/linkages.h"
#include "rigid/rigid_world.h"
#include "solver/contact_block.h"
#include "solver/impact.h"
#include "task/coloring.h"
#include "task/task_system.h"

namespace gyre {

// A hit, before those of all batches are put into the order of their contacts.
struct SlotHit {
  std::uint32_t slot = 0;
  ContactHit hit;
};

// Of the present batch; kept from step to step only for its memory.
struct SolveScratch {
  Array<ContactConstraint> constraints;
  Array<std::uint32_t> constraint_contact;  // contact slot of each constraint
  Array<ImpactContact> impacts;
  Array<ColoringPair> pairs;
  Coloring contact_colors;
  Coloring joint_colors;
  Array<std::uint32_t> swept_joints;  // those of the batch's that are in no linkage: places in its list
  Array<ColoringPair> joint_pairs;    // theirs
  DenseNets dense_nets;
  Array<std::uint32_t> order;         // constraint indices, W a block
  Array<SlotHit> hits;                // of all batches
  std::size_t manifold_count = 0;     // of all batches
  std::size_t joint_count = 0;
  std::size_t swept_joint_count = 0;
  StepReport report;
  std::uint64_t colors_used = 0;     // bits
  int colors = 0;
  RowReport rows;                    // of solvers that work on rows
};

// How constraints are shared among groups.
constexpr ColoringOptions kColoringOptions{.max_colors = 32, .statics_last = true};
static_assert(kColoringOptions.max_colors < 64, "colors_used has a bit for each, and one for the rest");

// Solves one step of `seconds` in `substeps` sub-steps: velocities, `moved`, `turned` and orientations of awake bodies,
// impulses in manifolds and joints.
void solve_step(RigidWorld& w, SolveScratch& scratch, Arena& arena, TaskSystem& tasks, const ContactKernels& kernels,
                float seconds);

}  // namespace gyre
