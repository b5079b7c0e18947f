// Solves one step of all awake bodies. Each batch of islands (dynamics/island_batches.h) is gathered, coloured, laid out and prepared once
// for all its sub-steps, which are a program (dynamics/substep_program.h). Small batches are solved in parallel, each by one worker; large
// ones one after the other by all workers. docs/step.md has the stages.
#pragma once

#include "base/arena/arena.h"
#include "dynamics/batch_context.h"
#include "task/task_system.h"

#include <memory>
#include <vector>

namespace gyre {

// The memory of a worker that solves batches by itself.
struct WorkerContext {
  BatchScratch scratch;
  Arena arena;
  TaskSystem tasks;
};

struct SolveScratch {
  BatchScratch together;                                // for batches that all workers solve together
  std::vector<std::unique_ptr<WorkerContext>> workers;  // empty if there is one worker
  Array<SlotHit> hits;
  SolveCounts counts;  // sums over all batches
  StepStats report;
  RowStats rows;
  int colors = 0;
  SoftScratch soft;
  CouplingSolve couplings;
  Array<std::uint32_t> united;  // bodies that soft matter or couplings unite
};

// The options of graph colouring.
constexpr ColoringOptions kColoringOptions{.max_colors = 32, .statics_last = true};
static_assert(kColoringOptions.max_colors < 64, "colors_used has a bit for each, and one for the rest");

// Solves one step of `seconds`. Writes velocities, delta positions, delta rotations and orientations of awake bodies, and impulses in
// manifolds and joints.
// Soft matter, if there is any, moves in the batch of all bodies that it touches.
void solve_step(RigidWorld& w, SoftStore& soft, const FluidStore& fluids, SolveScratch& scratch, Arena& arena, TaskSystem& tasks,
                const SolverKernels& kernels, float seconds);

}  // namespace gyre
