// The context of a batch: those of contacts, joints and bodies, which the stages of `rigid` work on, and the data that only the program
// of the batch needs.
#pragma once

#include "dynamics/fused_stages.h"
#include "dynamics/island_batches.h"
#include "dynamics/worker_partition.h"
#include "rigid/solve/body_motion_solve.h"
#include "rigid/solve/contact_solve.h"
#include "rigid/solve/hit_events.h"
#include "rigid/solve/joint_solve.h"
#include "rigid/solve/row_stages.h"
#include "task/coloring.h"

namespace gyre {

// What is counted of the batches of a step.
struct SolveCounts {
  std::size_t manifolds = 0;
  std::size_t joints = 0;
  std::size_t swept_joints = 0;
  std::uint64_t colors_used = 0;  // bits
};

// Of the present batch; kept from step to step only for its memory.
struct BatchScratch {
  ContactLists contacts;
  JointLists joints;
  Coloring contact_colors;
  Coloring joint_colors;
  // Of all batches that were solved with it in this step:
  Array<SlotHit> hits;
  SolveCounts counts;
  StepStats report;
  RowStats rows;  // of solvers that work on rows
};

struct BatchContext {
  RigidWorld& w;
  BatchScratch& scratch;
  const SolverKernels& kernels;
  SolveBatch members{};
  std::span<const std::uint32_t> local_index{};  // by body: its index in its batch
  ContactSolve contacts;
  JointSolve joints;
  BodyMotionSolve motion;
  std::span<ContactGroup> contact_groups{};
  WorkerPartition partition{};
  std::span<int> group_bounds{};      // where there are several workers: for kMaxGroups groups
  const int* moved_bounds = nullptr;  // of blocks of bodies, by worker: where contacts act on nearly all
  std::size_t moved_in_contact = 0;   // of the moved bodies, the first: contacts act on them
  FusedRuns fused_runs[2] = {};       // if bodies are moved run by run: of other bodies, and of articulations
  RowSolve* rows = nullptr;           // if constraints are solved as rows

  // All that is between the contacts of one half-step and those of the next is done run by run.
  bool is_fused() const { return !fused_runs[1].runs.empty(); }
};

}  // namespace gyre
