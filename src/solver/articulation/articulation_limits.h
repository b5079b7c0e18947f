// Stops of the joints of a linkage (limits that do not give way), solved together with its equations.
//
// A sweep finds a stop's impulse as if two bodies were alone; where a whole limb hangs on them, it takes many, and the equations
// that come after undo most of it. So what an impulse at each stop in question makes of all of the linkage, equations included, is found
// from the factors that are there anyway (math/block_ldlt.h), and the impulses are those of the complementarity problem that is
// left: no impulse pulls, no stop that bears one is left, none is passed. Sources: as of solver/articulation/articulation.h; R. W. Cottle, J.-S. Pang, R. E. Stone,
// "The Linear Complementarity Problem", 1992 (projected Gauss-Seidel on its few rows).
#pragma once

#include "solver/articulation/articulation.h"
#include "solver/core/error_bounds.h"

namespace gyre {

// Stops that are solved together, at most: more take turns.
constexpr std::size_t kMaxLimits = 32;

inline bool has_hard_limit(const AxisConstraint& axis) {
  return !axis.is_rod && axis.axis.limit_frequency <= 0.0f && (axis.has_low || axis.has_high);
}
// How many numbers solve_limits() needs for a linkage.
std::size_t limits_room(std::size_t rows, std::size_t bodies);

// Changes velocities and impulses, so that stops hold and equations hold as they did. `bounds`: none where only the speed counts, not how they bend either.
void solve_limits(const Articulation& articulation, const ArticulationSolve& solve, ErrorBounds bounds);

}  // namespace gyre
