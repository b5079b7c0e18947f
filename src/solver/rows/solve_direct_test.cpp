// Direct solvers against each other, against an enumeration of all combinations of limits, and against
// iterative solvers.
#include "solver/rows/solve_direct.h"

#include "math/dense.h"
#include "solver/rows/body_newton.h"
#include "solver/rows/lcp_dantzig.h"
#include "solver/rows/lcp_lemke.h"
#include "solver/rows/rows_test_kit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::solve_direct_test {
namespace {

// A positive semi-definite matrix G G^T of rank at most `rank`.
std::vector<double> random_psd(Chance& chance, int n, int rank) {
  std::vector<double> g(std::size_t(n * rank)), a(std::size_t(n * n));
  for (double& v : g) v = chance.in(-1.0, 1.0);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < rank; ++k)
        a[std::size_t(i * n + j)] += g[std::size_t(i * rank + k)] * g[std::size_t(j * rank + k)];
  return a;
}

// Solves all 3^n choices of (low, between, high) as linear equations and returns the first that fits; w is
// unique, x need not be.
bool enumerate(const std::vector<double>& a, const std::vector<double>& q, const std::vector<double>& low,
               const std::vector<double>& high, std::vector<double>& w) {
  const int n = int(q.size());
  int all = 1;
  for (int i = 0; i < n; ++i) all *= 3;
  for (int choice = 0; choice < all; ++choice) {
    std::vector<double> x(q.size(), 0.0), k, right;
    std::vector<int> open;
    bool possible = true;
    for (int i = 0, rest = choice; i < n; ++i, rest /= 3) {
      if (rest % 3 == 1) open.push_back(i);
      if (rest % 3 == 0) x[std::size_t(i)] = low[std::size_t(i)];
      if (rest % 3 == 2) x[std::size_t(i)] = high[std::size_t(i)];
      possible = possible && std::abs(x[std::size_t(i)]) < 1.0e200;
    }
    if (!possible) continue;
    for (const int i : open) {
      double sum = -q[std::size_t(i)];
      for (int j = 0; j < n; ++j) sum -= a[std::size_t(i * n + j)] * x[std::size_t(j)];
      right.push_back(sum);
      for (const int j : open) k.push_back(a[std::size_t(i * n + j)]);
    }
    factor_ldlt(k, int(open.size()));
    solve_ldlt(k, int(open.size()), right);
    for (std::size_t i = 0; i < open.size(); ++i) x[std::size_t(open[i])] = right[i];
    bool fits = true;
    for (int i = 0, rest = choice; i < n && fits; ++i, rest /= 3) {
      double sum = q[std::size_t(i)];
      for (int j = 0; j < n; ++j) sum += a[std::size_t(i * n + j)] * x[std::size_t(j)];
      w[std::size_t(i)] = sum;
      if (rest % 3 == 0) fits = sum >= -1.0e-9;
      if (rest % 3 == 2) fits = sum <= 1.0e-9;
      if (rest % 3 == 1)
        fits = std::abs(sum) < 1.0e-9 && x[std::size_t(i)] >= low[std::size_t(i)] - 1.0e-9 &&
               x[std::size_t(i)] <= high[std::size_t(i)] + 1.0e-9;
    }
    if (fits) return true;
  }
  return false;
}

TEST(Dantzig, FindsWhatTryingAllLimitsFinds) {
  int solvable = 0;
  for (int seed = 0; seed < 400; ++seed) {
    Chance chance{std::uint64_t(seed)};
    const int n = 1 + chance.below(6);
    const std::vector<double> a = random_psd(chance, n, 1 + chance.below(n + 1));
    std::vector<double> q, low, high, w(std::size_t(n), 0.0);
    for (int i = 0; i < n; ++i) {
      q.push_back(chance.in(-1.0, 1.0));
      const bool one_sided = chance.below(2) == 0;
      low.push_back(one_sided ? 0.0 : -chance.in(0.0, 2.0));
      high.push_back(one_sided ? kNoLimit : chance.in(0.0, 2.0));
    }
    if (!enumerate(a, q, low, high, w)) continue;
    ++solvable;
    std::vector<double> numbers(Dantzig::room_for(std::size_t(n)));
    NumberRoom room(numbers);
    Dantzig dantzig(a, q, 1.0e-9, room);
    for (int i = 0; i < n; ++i) dantzig.set_limits(i, low[std::size_t(i)], high[std::size_t(i)]);
    ASSERT_TRUE(dantzig.solve(1.0e-12, 1000)) << seed;
    for (int i = 0; i < n; ++i) {
      double speed = q[std::size_t(i)];
      for (int j = 0; j < n; ++j) speed += a[std::size_t(i * n + j)] * dantzig.x(j);
      EXPECT_NEAR(speed, w[std::size_t(i)], 1.0e-5) << seed << " row " << i;
      EXPECT_GE(dantzig.x(i), low[std::size_t(i)]) << seed;
      EXPECT_LE(dantzig.x(i), high[std::size_t(i)]) << seed;
    }
  }
  EXPECT_GT(solvable, 200);
}

TEST(Lemke, FindsWhatTryingAllLimitsFinds) {
  int solvable = 0;
  for (int seed = 0; seed < 400; ++seed) {
    Chance chance{std::uint64_t(seed) + 5000};
    const int n = 1 + chance.below(7);
    const std::vector<double> a = random_psd(chance, n, 1 + chance.below(n + 1));
    std::vector<double> q, low(std::size_t(n), 0.0), high(std::size_t(n), kNoLimit), w(std::size_t(n), 0.0),
        z(std::size_t(n), 0.0);
    for (int i = 0; i < n; ++i) q.push_back(chance.in(-1.0, 1.0));
    std::vector<double> numbers(lemke_room(std::size_t(n)));
    NumberRoom room(numbers);
    const LemkeResult found = solve_lemke(a, q, 1.0e-11, 1000, z, room);
    if (!enumerate(a, q, low, high, w)) {
      EXPECT_NE(found.end, LemkeEnd::solved) << seed;
      continue;
    }
    ++solvable;
    ASSERT_EQ(found.end, LemkeEnd::solved) << seed;
    for (int i = 0; i < n; ++i) {
      double speed = q[std::size_t(i)];
      for (int j = 0; j < n; ++j) speed += a[std::size_t(i * n + j)] * z[std::size_t(j)];
      EXPECT_NEAR(speed, w[std::size_t(i)], 1.0e-6) << seed << " row " << i;
    }
  }
  EXPECT_GT(solvable, 200);
}

std::vector<double> solve_by(const Dense& dense, const FrictionSet& polygon, DirectMethod method,
                             DirectResult& result, double tolerance = 1.0e-9) {
  std::vector<double> x(dense.q.size(), 0.0),
      numbers(direct_room(count_direct(dense.limits), polygon, method));
  result = solve_direct(dense.problem, polygon, method, tolerance, x, NumberRoom(numbers));
  return x;
}

TEST(SolveDirect, DantzigLemkeAndNncgAgreeOnHeapsWithFriction) {
  for (const int sides : {4, 6, 8}) {
    const FrictionSet polygon = make_friction_set(sides);
    int ended = 0;
    for (int seed = 0; seed < 60; ++seed) {
      const Island island = make_heap(std::uint64_t(seed), 2 + seed % 4, 3 + seed % 9, seed % 3, 0.4);
      const Dense dense(island, polygon);
      DirectResult by_dantzig, by_lemke;
      const std::vector<RowBody> dantzig =
          pushed(island, solve_by(dense, polygon, DirectMethod::dantzig, by_dantzig, 1.0e-11));
      const std::vector<RowBody> lemke =
          pushed(island, solve_by(dense, polygon, DirectMethod::lemke, by_lemke, 1.0e-11));
      EXPECT_LT(by_dantzig.residual, 1.0e-8) << sides << " sides, seed " << seed;
      EXPECT_LT(by_lemke.residual, 1.0e-8) << sides << " sides, seed " << seed;
      EXPECT_LT(apart(dantzig, lemke), 1.0e-6) << sides << " sides, seed " << seed;
      Island iterated = island;
      std::vector<double> numbers(nncg_room(iterated.rows.size()));
      const GaussSeidelResult nncg =
          solve_nncg(iterated.rows, iterated.bodies, polygon, 1.0e-9, 20000, NumberRoom(numbers));
      if (nncg.residual > 1.0e-8) continue;
      ++ended;
      EXPECT_LT(apart(dantzig, iterated.bodies), 1.0e-5) << sides << " sides, seed " << seed;
    }
    // Redundant joints may make a heap so ill-conditioned that iterations do not converge.
    EXPECT_GE(ended, 58) << sides;
  }
}

TEST(SolveDirect, TrueConesAreSolvedToo) {
  const FrictionSet disc = make_friction_set(0), polygon = make_friction_set(8);
  for (int seed = 0; seed < 60; ++seed) {
    const Island island = make_heap(std::uint64_t(seed) + 900, 2 + seed % 4, 3 + seed % 9, seed % 3, 0.4);
    const Dense dense(island, disc);
    DirectResult result;
    const std::vector<double> x = solve_by(dense, polygon, DirectMethod::dantzig, result);
    EXPECT_LT(result.residual, 1.0e-6) << seed;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (dense.limits[i].kind != RowKind::cone) continue;
      const double load = x[std::size_t(dense.limits[i].load_first)];
      EXPECT_LE(std::sqrt(x[i] * x[i] + x[i + 1] * x[i + 1]), dense.limits[i].friction * load + 1.0e-6)
          << seed;
    }
    Island iterated = island;
    std::vector<double> numbers(nncg_room(iterated.rows.size()));
    solve_nncg(iterated.rows, iterated.bodies, disc, 1.0e-9, 20000, NumberRoom(numbers));
    EXPECT_LT(apart(pushed(island, x), iterated.bodies), 1.0e-5) << seed;
  }
}

TEST(SolveDirect, RedundantCornersBearAThousandfoldLoad) {
  // Each face has four corners where three would do; every box carries a thousand times its weight.
  const double kick = 9.81 / 240.0;
  const Island island = make_stack({1, 1, 1, 1, 1000}, kick);
  const FrictionSet polygon = make_friction_set(4);
  const Dense dense(island, polygon);
  // A residual of r leaves speeds of r times the largest diagonal, and in the impulse of the ground that
  // times the total mass.
  double stiffest = 0.0;
  for (const Row& row : island.rows) stiffest = std::max(stiffest, row.diagonal);
  const auto check = [&](const char* method, double residual, const std::vector<double>& x) {
    EXPECT_LT(residual, 1.0e-11) << method;
    for (const RowBody& body : pushed(island, x))
      EXPECT_LT(length(body.linear), stiffest * 1.0e-11) << method;
    double ground = 0.0;
    for (std::size_t i = 0; i < 12; i += 3) ground += x[i];
    EXPECT_NEAR(ground, 1004.0 * kick, 1004.0 * stiffest * 1.0e-11) << method;
  };
  for (const DirectMethod method : {DirectMethod::dantzig, DirectMethod::lemke}) {
    DirectResult result;
    const std::vector<double> x = solve_by(dense, polygon, method, result, 1.0e-11);
    check(method == DirectMethod::dantzig ? "Dantzig" : "Lemke", result.residual, x);
  }
  Arena arena;
  const BlockPlan plan = plan_of(island, arena);
  std::vector<double> x(island.rows.size(), 0.0), numbers(body_newton_room(x.size(), plan));
  const NewtonResult newton =
      solve_body_newton({island.rows, island.bodies, &polygon, &plan}, 1.0e-11, 10, x, NumberRoom(numbers));
  check("Newton", newton.residual, x);
  // The same by many iterations.
  Island iterated = island;
  for (int i = 0; i < 50; ++i) iterate_rows_once(iterated.rows, iterated.bodies, polygon);
  EXPECT_GT(length(iterated.bodies.back().linear), 0.5 * kick);
}

TEST(SolveDirect, TheOrderOfRowsDoesNotMatter) {
  const double kick = 9.81 / 240.0;
  Island island = make_stack({1, 3, 2, 5}, kick);
  for (std::size_t i = 0; i < island.bodies.size(); ++i) island.bodies[i].linear.x = 0.3 * double(i);
  Island turned{island.bodies, {}};
  for (int i = int(island.bodies.size()); i-- > 0;)
    add_corners(turned.rows, turned.bodies, i - 1, i, 1.0, 0.5);
  const FrictionSet polygon = make_friction_set(4);
  DirectResult first, second;
  const std::vector<double> x = solve_by(Dense(island, polygon), polygon, DirectMethod::dantzig, first);
  const std::vector<double> y = solve_by(Dense(turned, polygon), polygon, DirectMethod::dantzig, second);
  EXPECT_LT(first.residual, 1.0e-6);
  EXPECT_LT(second.residual, 1.0e-6);
  EXPECT_LT(apart(pushed(island, x), pushed(turned, y)), 1.0e-7);
}

TEST(SolveDirect, FrictionOfAPolygonIsBetweenItsInnerAndItsOuterCircle) {
  const double kick = 0.1, friction = 0.5;
  for (const int sides : {4, 8, 16}) {
    const FrictionSet polygon = make_friction_set(sides);
    double smallest = 1.0, largest = 0.0;
    for (int k = 0; k < 64; ++k) {
      const double angle = 2.0 * double(kPi) * k / 64.0;
      Island island;
      // A point without lever arm: the lowest of a ball with almost no inertia.
      add_body(island.bodies, 1.0, 1.0, {std::cos(angle), -kick, std::sin(angle)});
      for (double& v : island.bodies[0].inverse_inertia) v = 0.0;
      add_contact(island.rows, island.bodies, -1, 0, {}, {}, {0, 1, 0}, friction);
      DirectResult result;
      const std::vector<double> x = solve_by(Dense(island, polygon), polygon, DirectMethod::dantzig, result);
      const double size = std::sqrt(x[1] * x[1] + x[2] * x[2]) / (friction * x[0]);
      smallest = std::min(smallest, size), largest = std::max(largest, size);
    }
    EXPECT_LE(largest, 1.0 + 1.0e-9);
    EXPECT_GE(smallest, std::cos(double(kPi) / sides) - 1.0e-9);
    EXPECT_NEAR(largest, 1.0, 0.02) << sides;
  }
}

TEST(FrictionSet, NearestPointsAreNearest) {
  for (const int sides : {0, 4, 6, 8, 32}) {
    const FrictionSet set = make_friction_set(sides);
    Chance chance{std::uint64_t(sides) + 77};
    for (int i = 0; i < 500; ++i) {
      const double x = chance.in(-3, 3), y = chance.in(-3, 3), radius = chance.in(0.1, 2);
      const FrictionPoint p = nearest_friction(set, radius, x, y);
      const double distance = std::hypot(x - p.x, y - p.y);
      EXPECT_LE(std::hypot(p.x, p.y), radius + 1.0e-12);
      // No other point of the set is nearer: points of the rim and the centre.
      for (int k = 0; k < 200; ++k) {
        double ox = 0, oy = 0;
        if (sides == 0) {
          ox = radius * std::cos(0.0314159 * k), oy = radius * std::sin(0.0314159 * k);
        } else {
          const int c = k % sides;
          const double t = chance.in(0, 1);
          ox = radius * ((1 - t) * set.corner[c][0] + t * set.corner[(c + 1) % sides][0]);
          oy = radius * ((1 - t) * set.corner[c][1] + t * set.corner[(c + 1) % sides][1]);
        }
        EXPECT_LE(distance, std::hypot(x - ox, y - oy) + 1.0e-9) << sides;
      }
    }
  }
}

}  // namespace
}  // namespace gyre::solve_direct_test
