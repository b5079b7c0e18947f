// Newton's method (solver/rows/newton_search.h) on a dense problem, to polish the result of pivoting. A step
// is Gaussian elimination, 2/3 n^3 operations.
#pragma once

#include "solver/rows/newton_search.h"

namespace gyre {

constexpr std::size_t newton_room(std::size_t size) { return size * size + newton_search_room(size); }

// Improves `x` until the residual is at most `tolerance`, and returns the best impulses found.
NewtonResult solve_newton(const DenseProblem& problem, double tolerance, int max_steps, std::span<double> x,
                          NumberRoom room);

}  // namespace gyre
