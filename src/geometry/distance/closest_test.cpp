// Closest features against the condition for the closest point of a convex set: no corner is farther towards the query
// point than the closest point is. Random, degenerate and far-away input.
#include "geometry/distance/closest.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

namespace gyre::closest_test {
namespace {

using oracle::Random;

DVec3 random_point(Random& random, double scale) { return scale * DVec3(random.in_cube()); }

// How far corners extend towards `p` beyond `nearest`, relative to the scale: 0 for the true closest point.
double excess(DVec3 p, DVec3 nearest, const DVec3* corners, int count) {
  double worst = 0.0, scale = 0.0;
  for (int i = 0; i < count; ++i) {
    worst = max(worst, dot(p - nearest, corners[i] - nearest));
    scale = max(scale, length_squared(corners[i] - nearest) + length_squared(p - nearest));
  }
  return scale > 0.0 ? worst / scale : 0.0;
}

// Corners at random, sometimes equal, on a line or in a plane.
void random_corners(Random& random, DVec3* corners, int count, double scale) {
  for (int i = 0; i < count; ++i) corners[i] = random_point(random, scale);
  switch (random.below(8)) {
    case 0:
      corners[1] = corners[0];
      break;
    case 1:
      corners[count - 1] = 0.5 * (corners[0] + corners[1]);
      break;
    case 2:
      for (int i = 1; i < count; ++i) corners[i] = corners[0];
      break;
    case 3:
      corners[count - 1] = corners[0] + 0.3 * (corners[1] - corners[0]) + 1.0e-7 * corners[count - 1];
      break;
    default:
      break;
  }
}

TEST(Closest, TriangleMeetsTheNearestPointCondition) {
  Random random(1);
  for (int i = 0; i < 40000; ++i) {
    const double scale = i % 3 == 0 ? 1.0e-3 : i % 3 == 1 ? 1.0 : 1.0e3;
    DVec3 q[3];
    random_corners(random, q, 3, scale);
    const DVec3 p = random_point(random, 2.0 * scale);
    const SimplexPoint near = closest_on_triangle(p, q[0], q[1], q[2]);
    EXPECT_LT(excess(p, near.point, q, 3), 1.0e-9) << i;
    DVec3 mixed;
    double sum = 0.0;
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(near.weights[k], 0.0);
      EXPECT_EQ(near.weights[k] > 0.0, (near.corners & (1u << k)) != 0);
      mixed += near.weights[k] * q[k];
      sum += near.weights[k];
    }
    EXPECT_NEAR(sum, 1.0, 1.0e-12);
    EXPECT_LT(length(mixed - near.point), 1.0e-8 * scale) << i;
  }
}

TEST(Closest, TetrahedronMeetsTheNearestPointCondition) {
  Random random(2);
  int inside = 0;
  for (int i = 0; i < 40000; ++i) {
    DVec3 q[4];
    random_corners(random, q, 4, 1.0);
    const DVec3 p = random_point(random, 0.6);
    const SimplexPoint near = closest_on_tetrahedron(p, q[0], q[1], q[2], q[3]);
    EXPECT_LT(excess(p, near.point, q, 4), 1.0e-9) << i;
    DVec3 mixed;
    for (int k = 0; k < 4; ++k) mixed += near.weights[k] * q[k];
    EXPECT_LT(length(mixed - near.point), 1.0e-8) << i;
    if (near.corners == 15) ++inside;
  }
  EXPECT_GT(inside, 100);
}

TEST(Closest, SegmentPointsAndEnds) {
  EXPECT_EQ(closest_on_segment({0, 1, 0}, {-1, 0, 0}, {1, 0, 0}).t, 0.5);
  EXPECT_EQ(closest_on_segment({-3, 1, 0}, {-1, 0, 0}, {1, 0, 0}).t, 0.0);
  EXPECT_EQ(closest_on_segment({3, 1, 0}, {-1, 0, 0}, {1, 0, 0}).t, 1.0);
  EXPECT_EQ(closest_on_segment({3, 1, 0}, {2, 2, 2}, {2, 2, 2}).point, (DVec3{2, 2, 2}));
}

TEST(Closest, SegmentsMeetTheNearestPointConditionBothWays) {
  Random random(3);
  for (int i = 0; i < 40000; ++i) {
    DVec3 a[2] = {random_point(random, 1.0), random_point(random, 1.0)};
    DVec3 b[2] = {random_point(random, 1.0), random_point(random, 1.0)};
    switch (random.below(8)) {
      case 0:
        b[1] = b[0] + 0.7 * (a[1] - a[0]);
        break;  // parallel
      case 1:
        b[1] = b[0] - 1.7 * (a[1] - a[0]);
        break;  // antiparallel
      case 2:
        b[1] = b[0] + (a[1] - a[0]) + 1.0e-7 * b[1];
        break;
      case 3:
        b[0] = a[0] + 0.3 * (a[1] - a[0]), b[1] = a[0] + 2.0 * (a[1] - a[0]);
        break;  // on one line
      case 4:
        a[1] = a[0];
        break;
      case 5:
        a[1] = a[0], b[1] = b[0];
        break;
      default:
        break;
    }
    const SegmentPair near = closest_of_segments(a[0], a[1], b[0], b[1]);
    // Parallel segments may lean by a microradian.
    const double tolerance = near.parallel ? 1.0e-6 : 1.0e-9;
    EXPECT_LT(excess(near.on_b, near.on_a, a, 2), tolerance) << i;
    EXPECT_LT(excess(near.on_a, near.on_b, b, 2), tolerance) << i;
    EXPECT_LT(length(a[0] + near.s * (a[1] - a[0]) - near.on_a), 1.0e-12) << i;
    EXPECT_LT(length(b[0] + near.t * (b[1] - b[0]) - near.on_b), 1.0e-12) << i;
  }
}

TEST(Closest, ParallelSegmentsTakeTheStretchNearestToTheStart) {
  const SegmentPair near = closest_of_segments({0, 0, 0}, {4, 0, 0}, {3, 1, 0}, {1, 1, 0});
  EXPECT_TRUE(near.parallel);
  EXPECT_DOUBLE_EQ(near.on_a.x, 1.0);
  EXPECT_DOUBLE_EQ(near.on_b.x, 1.0);
}

}  // namespace
}  // namespace gyre::closest_test
