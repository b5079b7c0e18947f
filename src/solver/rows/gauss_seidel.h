// Solvers that go from row to row through the bodies' velocities, without a matrix.
//
// Sequential impulses (projected Gauss-Seidel with accumulated impulses: E. Catto, "Iterative Dynamics with Temporal Coherence",
// 2005) take one row after the other, in the order of the list: each brings its own speed to what is asked and brings its
// accumulated impulse back within its limits. The order matters: what comes later has the last word. Both tangents of a point are
// one step, so that its limit is the disc or polygon, not a square.
//
// NNCG (M. Silcowitz-Hansen, S. Niebe, K. Erleben, "A nonsmooth nonlinear conjugate gradient method for interactive contact force
// problems", 2010) takes what a whole sweep changes as a gradient and adds Fletcher and Reeves' conjugate direction. The cost of
// an iteration is that of a sweep; errors fall with the root of the condition number. It ends when the residual of the natural map
// (solver/rows/complementarity.h) is small enough.
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

struct GaussSeidelResult {
  double residual = 0.0;
  int iterations = 0;
};

// Velocities with the impulses that the rows begin with.
void warm_start_rows(std::span<const Row> rows, std::span<RowBody> bodies);
// One pass. Returns the sum of squared changes, each weighted by its row's diagonal (a kinetic energy).
double iterate_rows_once(std::span<Row> rows, std::span<RowBody> bodies, const FrictionSet& friction);
double find_row_residual(std::span<const Row> rows, std::span<const RowBody> bodies,
                         const FrictionSet& friction);

constexpr std::size_t nncg_room(std::size_t rows) { return 2 * rows; }
// From the velocities with the rows' impulses in them to the same.
GaussSeidelResult solve_nncg(std::span<Row> rows, std::span<RowBody> bodies, const FrictionSet& friction,
                             double tolerance, int max_iterations, NumberRoom room);

}  // namespace gyre
