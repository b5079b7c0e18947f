// A semi-smooth Newton method on the natural map of an island's complementarity problem: each step looks at which limits hold
// where (rows at rest, at a limit, sticking, sliding), solves the linear equations that go with that, and looks again. Friction
// sets are polygons or Coulomb's disc, whose rim bends: its derivative is in the equations.
//
// From impulses that are near, as those of the last sub-step or of a pivoting method are, it needs a few steps and leaves
// only rounding; from afar it may wander, and says so. Each step is a dense factorisation, 2/3 n^3 operations. Where rows are
// redundant, the step is the smallest that does (a proximal term of the size of rounding).
//
// Sources: P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to Newton like solution methods",
// 1991; S. Hueeber, B. Wohlmuth, "A primal-dual active set strategy for non-linear multibody contact problems", 2005.
#pragma once

#include "solver/complementarity.h"

namespace gyre {

constexpr std::size_t newton_room(std::size_t size) { return size * size + 5 * size; }

struct NewtonResult {
  double residual = 0.0;
  int steps = 0;
};

// Improves `x` until the residual is at most `tolerance`; leaves the best that was found.
NewtonResult solve_newton(const DenseProblem& problem, double tolerance, int most_steps, std::span<double> x,
                          NumberRoom room);

}  // namespace gyre
