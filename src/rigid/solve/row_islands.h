// Divides the constraints of a batch into islands for the solvers that treat an island's rows as one problem (solver/rows/row.h).
//
// In: a batch with its gathered constraints and joints. Out: islands in the order of their lowest body. Bodies ascend; joints and contacts
// are in the order of their slots. No bit depends on which worker solves an island, or when.
#pragma once

#include "math/block_ldlt.h"
#include "rigid/batch/solve_batch.h"
#include "solver/contact/contact_block.h"
#include "solver/rows/solve_direct.h"

namespace gyre {

struct RowIsland {
  std::span<const std::uint32_t> bodies;       // slots of bodies that rows move
  std::span<const std::uint32_t> constraints;  // indices in the batch
  std::span<const std::uint32_t> joints;       // indices in the batch's list
  DirectSize size;                             // upper bounds for its rows
  BlockPlan plan;                              // a node for each body; empty if not planned
};

struct RowIslands {
  std::span<RowIsland> islands;
  std::span<const std::int32_t> place;  // by body: index in its island; kNoRowBody if no row moves it
};

// Plans the elimination of each island's bodies for Newton's method, if a factorisation takes at most `max_work` multiplications.
void plan_row_islands(const RigidWorld& w, std::span<const ContactConstraint> constraints,
                      const SolveBatch& batch, std::uint64_t max_work, Arena& arena, RowIslands& islands);

RowIslands find_row_islands(const RigidWorld& w, std::span<const ContactConstraint> constraints,
                            const SolveBatch& batch, std::span<const JointConstraint> work, Arena& arena);

}  // namespace gyre
