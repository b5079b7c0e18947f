// Solves the complementarity problem of a small island to the last digits by Dantzig's or Lemke's pivoting.
//
// Lemke's method solves the problem with friction polygons as one (the formulation of Stewart and Trinkle: one variable per corner
// and one for how fast the point slides). Dantzig's needs limits that are numbers: it solves with those that the loads of
// the last round give, until loads and limits agree. The two share no code but A and q. What either finds is polished by Newton's
// method (solver/rows/solve_newton.h), which also says how good it is; with Coulomb's disc the polygon only leads there.
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

enum class DirectMethod : unsigned char {
  dantzig,
  lemke,
};

struct DirectResult {
  double residual = 0.0;  // N s or N m s, largest of all rows
  int pivots = 0;
  int rounds = 0;  // of limits from loads
  int newton_steps = 0;
  bool is_solved = false;
};

// What a problem's memory depends on; each may be more than there will be.
struct DirectSize {
  std::size_t rows = 0;
  std::size_t equations = 0, cones = 0;  // of the rows; a cone is two rows
};
DirectSize count_direct(std::span<const RowLimits> limits);
// How much memory a problem needs, in numbers. `set`: the polygon, also where the disc is wanted.
std::size_t direct_room(const DirectSize& size, const FrictionSet& set, DirectMethod method);

// `polygon`: what pivoting uses in the place of problem.friction if that is the disc; else the same.
DirectResult solve_direct(const DenseProblem& problem, const FrictionSet& polygon, DirectMethod method,
                          double tolerance, std::span<double> x, NumberRoom room);

}  // namespace gyre
