// Hard limits of an articulation, solved together with its equations.
//
// An iteration finds the impulse of a limit as if two bodies were alone. With a whole limb on them it takes
// many, and the equations that follow undo most of it. So the response of the whole articulation, equations
// included, to an impulse at each active limit is found from the factors of the equations
// (math/block_ldlt.h). The impulses then solve a small complementarity problem: no impulse is negative, no
// limit with an impulse is left, none is violated. Sources: as of solver/articulation/articulation.h; R. W.
// Cottle, J.-S. Pang, R. E. Stone, "The Linear Complementarity Problem", 1992 (projected Gauss-Seidel on its
// few rows).
#pragma once

#include "solver/articulation/articulation.h"
#include "solver/core/error_bounds.h"

namespace gyre {

// Largest number of limits that are solved together; more take turns.
constexpr std::size_t kMaxLimits = 32;

inline bool has_hard_limit(const AxisConstraint& axis) {
  return !axis.is_rod && axis.axis.limit_frequency <= 0.0f && (axis.has_low || axis.has_high);
}
// Size of the memory of solve_limits() for an articulation, in numbers.
std::size_t limits_room(std::size_t rows, std::size_t bodies);

// Changes velocities and impulses so that limits hold, without violating equations. `bounds`: kNoErrors for
// speeds only, without second-order bias.
void solve_limits(const Articulation& articulation, const ArticulationSolve& solve, ErrorBounds bounds);

}  // namespace gyre
