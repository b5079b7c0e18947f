// Solves what is awake in one step: batches of islands (solve_batches.h), each gathered (solve_gather.h, solve_bodies.h), coloured and
// laid out (solve_layout.h) once for all its sub-steps, which are a program (solve_program.h). Small batches are solved side by side, each by one worker;
// large ones one after the other by all workers. docs/step.md has the stages.
#pragma once

#include "base/arena/arena.h"
#include "rigid/articulation/articulations.h"
#include "rigid/store/rigid_world.h"
#include "solver/contact/contact_block.h"
#include "solver/contact/impact.h"
#include "task/coloring.h"
#include "task/task_system.h"

#include <memory>
#include <vector>

namespace gyre {

// A hit, before those of all batches are put into the order of their contacts.
struct SlotHit {
  std::uint32_t slot = 0;
  ContactHit hit;
};

// What is counted of the batches of a step.
struct SolveCounts {
  std::size_t manifolds = 0;
  std::size_t joints = 0;
  std::size_t swept_joints = 0;
  std::uint64_t colors_used = 0;  // bits
};

// Of the present batch; kept from step to step only for its memory.
struct BatchScratch {
  Array<ContactConstraint> constraints;
  Array<std::uint32_t> constraint_contact;  // contact slot of each constraint
  Array<ImpactContact> impacts;
  Array<ColoringPair> pairs;
  Coloring contact_colors;
  Coloring joint_colors;
  Array<std::uint32_t> swept_joints;  // those of the batch's that are in no linkage: places in its list
  Array<ColoringPair> joint_pairs;    // theirs
  DenseGraphCache dense_graphs;
  Array<std::uint32_t> order;  // constraint indices, W a block
  // Of all batches that were solved with it in this step:
  Array<SlotHit> hits;
  SolveCounts counts;
  StepReport report;
  RowStats rows;  // of solvers that work on rows
};

// What a worker needs that solves batches by itself.
struct WorkerContext {
  BatchScratch scratch;
  Arena arena;
  TaskSystem tasks;
};

struct SolveScratch {
  BatchScratch together;                          // of batches that all workers solve together
  std::vector<std::unique_ptr<WorkerContext>> lone;  // by worker; none where there is one worker
  Array<SlotHit> hits;
  SolveCounts counts;  // of all batches
  StepReport report;
  RowStats rows;
  int colors = 0;
};

// How constraints are shared among groups.
constexpr ColoringOptions kColoringOptions{.max_colors = 32, .statics_last = true};
static_assert(kColoringOptions.max_colors < 64, "colors_used has a bit for each, and one for the rest");

// Solves one step of `seconds` in `substeps` sub-steps: velocities, `moved`, `turned` and orientations of awake bodies,
// impulses in manifolds and joints.
void solve_step(RigidWorld& w, SolveScratch& scratch, Arena& arena, TaskSystem& tasks,
                const ContactKernels& kernels, float seconds);

}  // namespace gyre
