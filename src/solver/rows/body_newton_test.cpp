// Newton's method by bodies against pivoting, against the method by rows, and on islands too large for dense
// methods.
#include "solver/rows/body_newton.h"

#include "solver/rows/rows_test_kit.h"
#include "solver/rows/solve_newton.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::body_newton_test {
namespace {

struct Solved {
  NewtonResult result;
  std::vector<double> x;
};

Solved solve_by_bodies(const Island& island, const FrictionSet& friction, double tolerance, int steps) {
  Arena arena;
  const BlockPlan plan = plan_of(island, arena);
  std::vector<double> x(island.rows.size(), 0.0), numbers(body_newton_room(island.rows.size(), plan));
  const NewtonResult result = solve_body_newton({island.rows, island.bodies, &friction, &plan}, tolerance,
                                                steps, x, NumberRoom(numbers));
  return {result, x};
}

TEST(BodyNewton, MakesTheStepsOfTheDenseMethod) {
  // Both start from the same impulses and follow the same rules, so equal numbers of steps agree to rounding.
  for (const int sides : {0, 8}) {
    const FrictionSet set = make_friction_set(sides);
    for (int seed = 0; seed < 40; ++seed) {
      const Island island = make_heap(std::uint64_t(seed) + 300, 3 + seed % 4, 4 + seed % 9, seed % 3, 0.4);
      const Dense dense(island, set);
      std::vector<double> by_rows(dense.q.size(), 0.0), numbers(newton_room(dense.q.size()));
      solve_newton(dense.problem, 0.0, 2, by_rows, NumberRoom(numbers));
      const std::vector<double> by_bodies = solve_by_bodies(island, set, 0.0, 2).x;
      double largest = 1.0;
      for (const double x : by_rows) largest = std::max(largest, std::abs(x));
      for (std::size_t i = 0; i < by_rows.size(); ++i)
        EXPECT_NEAR(by_bodies[i], by_rows[i], 1.0e-7 * largest) << sides << " sides, seed " << seed;
    }
  }
}

TEST(BodyNewton, AgreesWithPivotingOnHeaps) {
  const FrictionSet polygon = make_friction_set(8);
  int ended = 0;
  for (int seed = 0; seed < 60; ++seed) {
    const Island island = make_heap(std::uint64_t(seed), 2 + seed % 4, 3 + seed % 9, seed % 3, 0.4);
    const Solved solved = solve_by_bodies(island, polygon, 1.0e-9, 60);
    if (solved.result.residual > 1.0e-9) continue;
    ++ended;
    const Dense dense(island, polygon);
    std::vector<double> x(dense.q.size(), 0.0),
        numbers(direct_room(count_direct(dense.limits), polygon, DirectMethod::dantzig));
    solve_direct(dense.problem, polygon, DirectMethod::dantzig, 1.0e-9, x, NumberRoom(numbers));
    EXPECT_LT(apart(pushed(island, solved.x), pushed(island, x)), 1.0e-6) << seed;
  }
  EXPECT_GE(ended, 54);  // from zero; a world starts from the last impulses and some iterations
}

TEST(BodyNewton, ATowerOfTwentyBoxesStands) {
  const double kick = 9.81 / 240.0;
  const Island island = make_stack(std::vector<double>(20, 1.0), kick);
  const Solved solved = solve_by_bodies(island, make_friction_set(0), 1.0e-9, 30);
  EXPECT_LE(solved.result.residual, 1.0e-9);
  for (const RowBody& body : pushed(island, solved.x)) EXPECT_LT(length(body.linear), 1.0e-7);
}

TEST(BodyNewton, WhatALockedBodyCannotDoItDoesNot) {
  Island island = make_stack({1, 1}, 0.1);
  island.bodies[0].inverse_mass.x = 0.0;
  for (RowBody& body : island.bodies) body.linear.x = 1.0;
  for (Row& row : island.rows) finish_row(row, island.bodies);
  const Solved solved = solve_by_bodies(island, make_friction_set(0), 1.0e-10, 30);
  EXPECT_LE(solved.result.residual, 1.0e-10);
  const std::vector<RowBody> bodies = pushed(island, solved.x);
  EXPECT_EQ(bodies[0].linear.x, 1.0);
  EXPECT_NEAR(bodies[0].linear.y, 0.0, 1.0e-9);
}

}  // namespace
}  // namespace gyre::body_newton_test
