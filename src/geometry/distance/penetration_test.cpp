// EPA against its own proof (moving by the depth separates the shapes; no other direction separates them sooner),
// against the axis search on boxes, and on all kinds of degenerate input.
#include "geometry/distance/penetration.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

#include <string>

namespace gyre::penetration_test {
namespace {

using namespace oracle;

TEST(Penetration, NoDirectionPartsThemSooner) {
  Random random(21);
  Hulls hulls;
  int deep = 0;
  for (float scale : {1.0f, 1.0e-3f, 1.0e3f}) {
    for (int i = 0; i < 4000; ++i) {
      const int kind_a = 1 + random.below(5), kind_b = 1 + random.below(5);
      const Shape a = random_shape(random, hulls, kind_a, scale),
                  b = random_shape(random, hulls, kind_b, scale);
      Transform t = random_pose(random, scale);
      t.position = 0.7f * t.position;
      const CorePair pair(a, b, t);
      const CoreDistance start = core_distance(pair, 1.0e30, {});
      if (!start.overlap) continue;
      ++deep;
      const CorePenetration found = core_penetration(pair, start);
      const std::string what =
          std::string(kind_name(kind_a)) + " " + kind_name(kind_b) + " " + std::to_string(i);
      const double size = pair.size();
      ASSERT_NEAR(length(found.normal), 1.0, 1.0e-6) << what;
      // The depth is what it says along its own normal ...
      EXPECT_NEAR(separation(a, b, pair, found.normal), -found.depth, 1.0e-6 * size) << what;
      // ... and no sampled direction does better.
      EXPECT_LT(sampled_separation(a, b, pair, random, 150), -found.depth + 5.0e-4 * size) << what;
      EXPECT_LT(length(found.on_a - found.on_b - found.depth * found.normal), 1.0e-3 * size) << what;
    }
  }
  EXPECT_GT(deep, 4000);
}

TEST(Penetration, BoxesEqualTheAxisSearchByBruteForce) {
  Random random(22);
  for (int i = 0; i < 4000; ++i) {
    const Shape a = make_box({random(0.1f, 1), random(0.1f, 1), random(0.1f, 1)});
    const Shape b = make_box({random(0.1f, 1), random(0.1f, 1), random(0.1f, 1)});
    const Transform t{random.in_cube(0.8f), random.rotation()};
    const CorePair pair(a, b, t);
    const DVec3 axes_a[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double best = -1.0e300;
    const auto look = [&](DVec3 n) {
      if (length(n) < 1.0e-6) return;
      n = n / length(n);
      best = max(best, max(separation(a, b, pair, n), separation(a, b, pair, -n)));
    };
    for (const DVec3& axis : axes_a) {
      look(axis);
      look(pair.from_b(axis));
      for (const DVec3& other : axes_a) look(cross(axis, pair.from_b(other)));
    }
    const CoreDistance start = core_distance(pair, 1.0e30, {});
    EXPECT_EQ(start.overlap, best <= 0.0) << i;
    if (!start.overlap) continue;
    EXPECT_NEAR(core_penetration(pair, start).depth, -best, 1.0e-7) << i;
  }
}

TEST(Penetration, ClosedForms) {
  // A cylinder standing in a box, and lying across an edge-parallel one.
  const Shape box = make_box({1, 1, 1}), cylinder = make_along_y(ShapeKind::cylinder, 0.5f, 0.25f);
  const auto deep = [](const Shape& a, const Shape& b, const Transform& t) {
    const CorePair pair(a, b, t);
    return core_penetration(pair, core_distance(pair, 1.0e30, {}));
  };
  const CorePenetration standing = deep(box, cylinder, {{0.1f, 1.2f, 0.3f}, {}});
  EXPECT_NEAR(standing.depth, 0.05, 1.0e-6);
  EXPECT_LT(length(standing.normal - DVec3{0, 1, 0}), 1.0e-6);
  const CorePenetration lying =
      deep(box, cylinder, {{0.1f, 1.45f, 0.3f}, from_axis_angle({1, 0, 0}, 0.5f * kPi)});
  EXPECT_NEAR(lying.depth, 0.05, 1.0e-6);
  EXPECT_LT(length(lying.normal - DVec3{0, 1, 0}), 2.0e-4);
  // Two crossed cylinders: along both axes' cross product.
  const Shape rod = make_along_y(ShapeKind::cylinder, 0.5f, 2.0f);
  const CorePenetration crossed =
      deep(rod, rod, {{0.95f, 0.2f, 0.1f}, from_axis_angle({1, 0, 0}, 0.5f * kPi)});
  EXPECT_NEAR(crossed.depth, 0.05, 1.0e-6);
  EXPECT_LT(length(crossed.normal - DVec3{1, 0, 0}), 2.0e-4);
}

TEST(Penetration, DegenerateCoresStillHaveAWayOut) {
  const Shape point = make_sphere(0.5f), segment = make_along_y(ShapeKind::capsule, 0.2f, 1.0f);
  const Shape square = make_box({1, 0.2f, 1}, 0.2f), line = make_box({0.3f, 1.0f, 0.3f}, 0.3f);
  const Shape all[4] = {point, segment, square, line};
  for (const Shape& a : all) {
    for (const Shape& b : all) {
      for (const Quat& q :
           {Quat{}, from_axis_angle({0, 0, 1}, 0.5f * kPi), from_axis_angle({1, 2, 3}, 1.0f)}) {
        const CorePair pair(a, b, {{}, q});
        const CoreDistance start = core_distance(pair, 1.0e30, {});
        ASSERT_TRUE(start.overlap);
        const CorePenetration found = core_penetration(pair, start);
        EXPECT_NEAR(length(found.normal), 1.0, 1.0e-9);
        EXPECT_TRUE(is_finite(found.on_a) && is_finite(found.on_b));
        EXPECT_GE(found.depth, -1.0e-6);
        EXPECT_LE(found.depth, 1.5);
      }
    }
  }
}

}  // namespace
}  // namespace gyre::penetration_test
