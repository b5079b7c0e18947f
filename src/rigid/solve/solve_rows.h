// The sub-steps of a batch with the solvers that see constraints as rows (solver/rows/row.h): sequential impulses, and the
// complementarity problem of each island. Bodies, forces, fields, bounces and moves are those of the default solver
// (rigid/solve/solve_step.h); between forces and moves each island is solved by one worker:
//   watch impacts, predict, strike impacts, fields; for each island: rows, solve, velocities; advance, release impacts, joints at the
//   new place.
// A sub-step is one part, not two. When the step is over overlap is pushed apart in displacements, by the same solver.
#pragma once

#include "rigid/solve/solve.h"
#include "rigid/store/solver_settings.h"

namespace gyre {

// The settings of the world's solver; null: the default one.
inline const SolverSettings* row_solver_of(const RigidWorld& w) {
  return w.solver.empty() ? nullptr : &w.solver[0];
}

// Solves the batch. Adds to scratch.rows what its islands had to say.
void solve_batch_as_rows(BatchContext& solve, const SolverSettings& settings, Arena& arena, TaskSystem& tasks,
                         float warm_scale);

}  // namespace gyre
