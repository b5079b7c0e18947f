// Newton's method (solver/rows/newton_search.h) on the rows of an island of any size. The unknowns are
// changes of body velocities, six a body, instead of the impulses of rows, of which a contact has a dozen.
//
// The equation of a row, own dx + speed (J dv + compliance dx) + load dL = right, gives dx = c - G dv from
// the rows of its own constraint alone, because rows at rest are regularised by a share of their diagonal.
// The rest, dv = M^-1 J^T dx, is a matrix with one 6 x 6 block a body and two for each connected pair. Blocks
// are factored in an order with little fill-in (math/block_lu.h). The matrix is stiff where rows hold, so a
// step leaves about a millionth of its error, which the next one removes. Speeds are computed from impulses
// anew each time.
//
// In: rows with their gains, bodies with velocities without the impulses of the rows, the plan of the matrix.
// Out: impulses.
#pragma once

#include "math/block_lu.h"
#include "solver/rows/newton_search.h"

namespace gyre {

struct RowProblem {
  std::span<const Row> rows;
  std::span<const RowBody> bodies;
  const FrictionSet* friction = nullptr;
  const BlockPlan* plan = nullptr;  // a node of kLuBlock rows for each body, an edge for each row with two
                                    // bodies
};

// Size of the memory of a solve, in numbers.
std::size_t body_newton_room(std::size_t rows, const BlockPlan& plan);

// Improves the impulses `x` until the residual is at most `tolerance`, and returns the best impulses found.
NewtonResult solve_body_newton(const RowProblem& problem, double tolerance, int max_steps,
                               std::span<double> x, NumberRoom room);

}  // namespace gyre
