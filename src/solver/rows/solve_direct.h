// Solves the complementarity problem of a small island to rounding by Dantzig's or Lemke's pivoting.
//
// Lemke's method solves the problem with friction polygons as one (the formulation of Stewart and Trinkle:
// one variable for each corner and one for the slip speed of the point). Dantzig's needs numbers as bounds:
// it takes those of the last round's loads, until loads and bounds agree. The two share no code but A and q.
// Newton's method (solver/rows/solve_newton.h) polishes the result and measures its residual; with Coulomb's
// disc the polygon only gives the start.
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

enum class DirectMethod : unsigned char {
  dantzig,
  lemke,
};

struct DirectResult {
  double residual = 0.0;  // N s or N m s, the largest of all rows
  int pivots = 0;
  int rounds = 0;  // updates of the bounds from the loads
  int newton_steps = 0;
  bool is_solved = false;
};

// Counts from which the memory of a problem follows; upper bounds suffice.
struct DirectSize {
  std::size_t rows = 0;
  std::size_t equations = 0, cones = 0;  // of the rows; a cone is two rows
};
DirectSize count_direct(std::span<const RowLimits> limits);
// Size of the memory of a problem, in numbers. `set`: the polygon, also for a problem with the disc.
std::size_t direct_room(const DirectSize& size, const FrictionSet& set, DirectMethod method);

// `polygon`: replaces problem.friction in pivoting if that is the disc; else the same.
DirectResult solve_direct(const DenseProblem& problem, const FrictionSet& polygon, DirectMethod method,
                          double tolerance, std::span<double> x, NumberRoom room);

}  // namespace gyre
