// Newton's method (solver/rows/newton_search.h) on an island's rows, for islands of any size: the equations of a step are solved for what
// bodies' velocities do, six numbers a body, not for the rows' impulses, of which a contact has a dozen.
//
// A row's equation own dx + speed (J dv + give dx) + load dL = right gives dx = c - G dv with the rows of its own constraint alone, because
// rows at rest resist by a share of their diagonal. What is left, dv = M^-1 J^T dx, is a matrix of one 6 x 6 block a body and
// two for each pair of bodies that touch or are joined: factored by blocks in an order of few new ones (math/block_lu.h). The
// matrix is stiff where rows hold, so a step leaves about a millionth of its error, which the next one takes; speeds are found
// from impulses anew each time.
//
// In: rows with their gains, bodies with the velocities that they have without the rows' impulses, the plan of their pattern.
#pragma once

#include "math/block_lu.h"
#include "solver/rows/newton_search.h"

namespace gyre {

struct RowProblem {
  std::span<const Row> rows;
  std::span<const RowBody> bodies;
  const FrictionSet* friction = nullptr;
  const BlockPlan* plan = nullptr;  // a node of kLuBlock rows for each body, an edge where a row acts on two
};

// How much memory it takes, in numbers.
std::size_t body_newton_room(std::size_t rows, const BlockPlan& plan);

// Improves `x`, the rows' impulses, until the residual is at most `tolerance`; leaves the best that was found.
NewtonResult solve_body_newton(const RowProblem& problem, double tolerance, int max_steps,
                               std::span<double> x, NumberRoom room);

}  // namespace gyre
