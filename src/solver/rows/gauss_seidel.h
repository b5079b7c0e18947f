// Solvers that go from row to row through the velocities of the bodies, without a matrix.
//
// Sequential impulses (projected Gauss-Seidel with accumulated impulses: E. Catto, "Iterative Dynamics with
// Temporal Coherence", 2005) solve one row after the other, in the order of the list, and clamp its
// accumulated impulse. Later rows have the last word. Both tangents of a point are one step, so their bound
// is the disc or polygon, not a square.
//
// NNCG (M. Silcowitz-Hansen, S. Niebe, K. Erleben, "A nonsmooth nonlinear conjugate gradient method for
// interactive contact force problems", 2010) takes the change of a whole iteration as a gradient and adds
// Fletcher and Reeves' conjugate direction. An iteration costs the same; errors fall with the root of the
// condition number. It ends when the natural residual (solver/rows/complementarity.h) is small enough.
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

struct GaussSeidelResult {
  double residual = 0.0;
  int iterations = 0;
};

// Adds the initial impulses of the rows to the velocities.
void warm_start_rows(std::span<const Row> rows, std::span<RowBody> bodies);
// One iteration. Returns the sum of squared changes, each weighted by the diagonal of its row (a kinetic
// energy).
double iterate_rows_once(std::span<Row> rows, std::span<RowBody> bodies, const FrictionSet& friction);
double find_row_residual(std::span<const Row> rows, std::span<const RowBody> bodies,
                         const FrictionSet& friction);

constexpr std::size_t nncg_room(std::size_t rows) { return 2 * rows; }
// The velocities contain the impulses of the rows, before and after.
GaussSeidelResult solve_nncg(std::span<Row> rows, std::span<RowBody> bodies, const FrictionSet& friction,
                             double tolerance, int max_iterations, NumberRoom room);

}  // namespace gyre
