// The context of a batch: the contexts of contacts, joints and bodies for the stages of `rigid`, and data that only the program of the
// batch needs.
#pragma once

#include "dynamics/fused_stages.h"
#include "dynamics/island_batches.h"
#include "dynamics/soft/soft_solve.h"
#include "dynamics/worker_partition.h"
#include "rigid/solve/body_motion_solve.h"
#include "rigid/solve/contact_solve.h"
#include "rigid/solve/coupling_solve.h"
#include "rigid/solve/hit_events.h"
#include "rigid/solve/joint_solve.h"
#include "rigid/solve/row_stages.h"
#include "task/coloring.h"

namespace gyre {

// Statistics of the batches of a step.
struct SolveCounts {
  std::size_t manifolds = 0;
  std::size_t joints = 0;
  std::size_t swept_joints = 0;
  std::uint64_t colors_used = 0;  // bits
};

// Data of the present batch. It persists between steps only to reuse its memory.
struct BatchScratch {
  ContactLists contacts;
  JointLists joints;
  Coloring contact_colors;
  Coloring joint_colors;
  // Results of all batches that were solved with this memory in the step:
  Array<SlotHit> hits;
  SolveCounts counts;
  StepStats report;
  RowStats rows;  // from solvers that work on rows
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
  std::span<int> group_bounds{};      // for kMaxGroups groups, if there are several workers
  const int* moved_bounds = nullptr;  // of blocks of bodies, by worker, if contacts act on nearly all
  std::size_t moved_in_contact = 0;   // number of first moved bodies that contacts act on
  FusedRuns fused_runs[2] = {};       // if bodies move run by run: of other bodies; of articulations
  RowSolve* rows = nullptr;           // if constraints are solved as rows
  CouplingSolve* couplings = nullptr;  // if the batch has all couplings of the world
  SoftSolve soft{};                   // with members if the batch has all soft matter of the world

  bool has_soft() const { return !soft.members.empty(); }
  // True if all stages from the contacts of one half-step to those of the next are fused run by run.
  bool is_fused() const { return !fused_runs[1].runs.empty(); }
};

}  // namespace gyre
