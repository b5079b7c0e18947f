// A semi-smooth Newton method on the natural map of an island's complementarity problem. Each step finds the
// active limits (rows at rest, at a bound, sticking, sliding) and solves the linear equations for them
// (solver/rows/natural_map.h). A step is shortened until the sum of squared residuals falls. If no share of
// it does, the whole step is taken, since the path sometimes leads over a hill. Friction sets are polygons or
// Coulomb's disc, whose curvature is in the equations.
//
// From nearby impulses, as of the last sub-step or a pivoting method, the search takes a few steps and leaves
// only rounding. From far away it may wander; the result says so. Where rows are redundant the step is the
// smallest possible, because rows at rest are regularised by a share of their diagonal. That share falls with
// every good step and rises with every bad one, as in the method of Levenberg and Marquardt. It falls quickly
// where a whole step changes almost nothing, so that redundant rows that cannot all be at rest reach another
// limit.
//
// The problem solves the equations: densely by rows (solver/rows/solve_newton.h) or sparsely by bodies
// (solver/rows/body_newton.h).
//
// Sources: P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to Newton like
// solution methods", 1991; S. Hueeber, B. Wohlmuth, "A primal-dual active set strategy for non-linear
// multibody contact problems", 2005.
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

struct NewtonResult {
  double residual = 0.0;
  int steps = 0;
};

constexpr std::size_t newton_search_room(std::size_t size) { return 6 * size; }

// Improves `x` until the residual is at most `tolerance`; leaves the best that was found. The problem has
//   rows()                    how many
//   find_speeds(x, w)         w of all rows
//   residual_of(i, x, w)      of the natural map
//   find_step(x, w, near, dx) solves the equations; false if they are singular
//   find_change(dx, dw)       what dx makes of w, after find_step
template <class Problem>
NewtonResult newton_search(Problem& problem, double tolerance, int max_steps, std::span<double> x,
                           NumberRoom& room) {
  constexpr double kFirstDamping = 1.0e-4, kMaxDamping = 1.0e-3, kMinDamping = 1.0e-10;  // MapPoint::damping
  constexpr double kGood = 0.3, kSlow = 0.1, kBad = 10.0;  // factors on the damping after a step
  constexpr double kFall = 0.1;  // required relative fall of the sum of squares, for a whole step
  constexpr double kShares[] = {1.0, 0.5, 0.25, 0.1, 0.03};
  // Steps without progress before the search ends.
  constexpr int kPatience = 12;
  const std::size_t n = problem.rows();
  const std::span<double> now = room.take(n), w = room.take(n), dx = room.take(n), dw = room.take(n),
                          next = room.take(n), next_w = room.take(n);
  double squares = 0.0, residual = 0.0;
  const auto measure = [&](std::span<const double> impulses, std::span<const double> speeds) {
    squares = residual = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      const double own = problem.residual_of(int(i), impulses, speeds);
      squares += own * own;
      residual = max(residual, own);
    }
  };
  for (std::size_t i = 0; i < n; ++i) now[i] = x[i];
  problem.find_speeds(now, w);
  measure(now, w);
  NewtonResult result{residual, 0};
  double damping = kFirstDamping;
  for (int idle = 0; result.residual > tolerance && result.steps < max_steps && idle < kPatience;) {
    if (!problem.find_step(now, w, damping, dx)) break;
    problem.find_change(dx, dw);
    ++result.steps;
    const double before = squares;
    double taken = 1.0, whole = 0.0;  // whole: factor of the sum of squares for a whole step
    bool is_good = false;
    for (const double share : kShares) {
      for (std::size_t i = 0; i < n; ++i) next[i] = now[i] + share * dx[i], next_w[i] = w[i] + share * dw[i];
      measure(next, next_w);
      if (share == 1.0) whole = squares / before;
      if (!(squares < (1.0 - kFall * share) * before)) continue;
      taken = share;
      is_good = share >= 0.5;
      break;
    }
    damping *= whole > 0.8 && whole < 1.001 ? kSlow : is_good ? kGood : kBad;
    damping = clamp(damping, kMinDamping, kMaxDamping);
    for (std::size_t i = 0; i < n; ++i) now[i] += taken * dx[i];
    problem.find_speeds(now, w);
    measure(now, w);
    if (!(residual < 1.0e300)) break;
    if (residual < result.residual) {
      result.residual = residual;
      for (std::size_t i = 0; i < n; ++i) x[i] = now[i];
      idle = 0;
    } else {
      ++idle;
    }
  }
  return result;
}

}  // namespace gyre
