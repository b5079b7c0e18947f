// Parts the constraints of a batch into islands for the solvers that see an island's rows as one problem (solver/rows/row.h).
//
// In: a batch, its constraints and joints as gathered. Out: islands in the order of their lowest body; the bodies of each
// ascending, its joints and contacts in the order of their slots. Who works on an island, and when, changes no bit of it.
#pragma once

#include "math/block_ldlt.h"
#include "rigid/batch/solve_batches.h"
#include "rigid/solve/solve_step.h"
#include "solver/rows/solve_direct.h"

namespace gyre {

struct RowIsland {
  std::span<const std::uint32_t> bodies;       // slots of those that rows move
  std::span<const std::uint32_t> constraints;  // places in BatchScratch::constraints
  std::span<const std::uint32_t> joints;       // places in the batch's list
  DirectSize size;                             // of its rows, at most
  BlockPlan plan;                              // of its bodies, a node for each; empty if not planned
};

struct RowIslands {
  std::span<RowIsland> islands;
  std::span<const std::int32_t> place;  // by body: in its island's list; kNoRowBody if no row moves it
};

// The pattern of an island's bodies, for Newton's method: planned where a factorisation takes at most `max_work` multiplications.
void plan_row_islands(const RigidWorld& w, const BatchScratch& scratch, const SolveBatch& batch,
                      std::uint64_t max_work, Arena& arena, RowIslands& islands);

RowIslands find_row_islands(const RigidWorld& w, const BatchScratch& scratch, const SolveBatch& batch,
                            std::span<const JointConstraint> work, Arena& arena);

}  // namespace gyre
