// Casts of balls in closed form against steps of the remaining distance, which never pass the impact.
#include "geometry/query/cast_ball.h"

#include "geometry/distance/closest.h"
#include "random.h"

#include <gtest/gtest.h>

namespace gyre::cast_ball_test {
namespace {

using testing_random::Mixed;

DVec3 vector(Mixed& random, double most) {
  const double x = random.between(-most, most), y = random.between(-most, most);
  return {x, y, random.between(-most, most)};
}

// The fraction at which the distance to the core falls to the radii, by steps of the remaining distance; `least`: the
// smallest remaining distance of a miss.
template <class OnCore>
bool step_to_impact(const OnCore& on_core, double radii, const LocalRay& middle, double reach,
                    double& fraction, double& least) {
  const double way = length(middle.translation);
  least = 1.0e300;
  fraction = 0.0;
  for (int step = 0; step < 20000; ++step) {
    const DVec3 at = middle.origin + fraction * middle.translation;
    const double gap = length(at - on_core(at)) - radii;
    least = min(least, gap);
    if (gap < 1.0e-10) return true;
    if (way == 0.0) return false;
    fraction += gap / way;
    if (fraction > reach) return false;
  }
  return true;
}

struct Counts {
  int hits = 0, misses = 0, unknown = 0;
};

template <class OnCore>
void expect_right(const OnCore& on_core, double radii, const LocalRay& middle, double reach, BallCast cast,
                  const BallImpact& impact, Counts& counts) {
  const double at_start = length(middle.origin - on_core(middle.origin)) - radii;
  if (cast == BallCast::unknown) {
    ++counts.unknown;
    EXPECT_LE(at_start, 1.0e-12);
    return;
  }
  EXPECT_GT(at_start, -1.0e-12);
  double fraction, least;
  const bool hits = step_to_impact(on_core, radii, middle, reach, fraction, least);
  if (cast == BallCast::misses) {
    ++counts.misses;
    // The smallest distance may be as small as rounding, and the end may just be reached.
    if (hits && fraction < reach * (1.0 - 1.0e-7)) {
      // Grazing: from there on it does not come nearer.
      const DVec3 later = middle.origin + (fraction + 1.0e-4) * middle.translation;
      EXPECT_GT(length(later - on_core(later)), radii - 1.0e-6 * length(middle.translation));
    }
    return;
  }
  ++counts.hits;
  EXPECT_GE(impact.fraction, 0.0);
  EXPECT_LE(impact.fraction, reach);
  const DVec3 at = middle.origin + impact.fraction * middle.translation;
  EXPECT_NEAR(length(at - on_core(at)), radii, 1.0e-9);
  EXPECT_NEAR(length(impact.on_core - on_core(at)), 0.0, 1.0e-5);
  EXPECT_NEAR(length(impact.on_core + radii * impact.normal - at), 0.0, 1.0e-7);
  EXPECT_LE(dot(impact.normal, middle.translation), 1.0e-9 * length(middle.translation));
  // Nothing was passed on the way. The steps end at most 1e-10 before.
  EXPECT_TRUE(hits || least < 1.0e-8);
  for (int i = 0; i < 50; ++i) {
    const DVec3 before = middle.origin + (impact.fraction * double(i) / 50.0) * middle.translation;
    EXPECT_GT(length(before - on_core(before)), radii - 1.0e-9);
  }
}

LocalRay random_way(Mixed& random, int i) {
  LocalRay ray{vector(random, 3.0), {}};
  ray.translation = vector(random, 1.2) - ray.origin;
  if (i % 5 == 0) ray.translation = 0.3 * ray.translation;
  if (i % 7 == 0) (i % 2 == 0 ? ray.translation.x : ray.translation.y) = 0.0;
  if (i % 11 == 0) ray.translation.z = ray.translation.y = 0.0;
  if (i % 97 == 0) ray.translation = {};
  return ray;
}

TEST(CastBall, MeetsBoxesSegmentsAndPoints) {
  Mixed random{5};
  Counts counts;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    DVec3 core{random.between(0.1, 1.0), random.between(0.1, 1.0), random.between(0.1, 1.0)};
    if (i % 4 == 1) core = {0, core.y, 0};
    if (i % 4 == 2) core = {};
    if (i % 8 == 3) core.z = 0.0;
    const double radii = random.between(0.01, 0.8), reach = i % 3 == 0 ? 0.6 : 1.0;
    const auto on_core = [&](DVec3 p) {
      return DVec3{clamp(p.x, -core.x, core.x), clamp(p.y, -core.y, core.y), clamp(p.z, -core.z, core.z)};
    };
    const LocalRay middle = random_way(random, i);
    BallImpact impact;
    const BallCast cast = cast_ball_at_box(core, radii, middle, reach, impact);
    expect_right(on_core, radii, middle, reach, cast, impact, counts);
  }
  EXPECT_GT(counts.hits, 4000);
  EXPECT_GT(counts.misses, 3000);
  EXPECT_GT(counts.unknown, 200);
}

TEST(CastBall, MeetsTriangles) {
  Mixed random{6};
  Counts counts;
  for (int i = 0; i < 20000 && !HasFailure(); ++i) {
    const DVec3 corners[3] = {vector(random, 1.0), vector(random, 1.0), vector(random, 1.0)};
    const double radius = random.between(0.01, 0.8), reach = i % 3 == 0 ? 0.6 : 1.0;
    const auto on_core = [&](DVec3 p) {
      return closest_on_triangle(p, corners[0], corners[1], corners[2]).point;
    };
    LocalRay middle = random_way(random, i);
    if (i % 13 == 0) {
      // Along the plane, beside the triangle.
      const DVec3 normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
      middle.origin = corners[0] + 3.0 * (corners[1] - corners[2]) + (0.5 * radius / length(normal)) * normal;
      middle.translation = -4.0 * (corners[1] - corners[2]);
    }
    BallImpact impact;
    const BallCast cast = cast_ball_at_triangle(corners, radius, middle, reach, impact);
    expect_right(on_core, radius, middle, reach, cast, impact, counts);
  }
  EXPECT_GT(counts.hits, 4000);
  EXPECT_GT(counts.misses, 3000);
  EXPECT_GT(counts.unknown, 200);
}

TEST(CastBall, KeepsItsPrecisionFromFarAway) {
  Mixed random{7};
  for (int i = 0; i < 200; ++i) {
    const DVec3 core{0.5, 0.5, 0.5}, corners[3] = {{-1, 0, -1}, {0, 0, 1}, {1, 0, -1}};
    const DVec3 far{1.0e6 * random.between(-1, 1), 1.0e6, 1.0e6 * random.between(-1, 1)};
    const LocalRay middle{far, 1.5 * (vector(random, 0.4) - far)};
    BallImpact impact;
    ASSERT_EQ(cast_ball_at_box(core, 0.25, middle, 1.0, impact), BallCast::hits);
    const DVec3 at = middle.origin + impact.fraction * middle.translation;
    EXPECT_NEAR(length(at - impact.on_core), 0.25, 1.0e-8);
    ASSERT_EQ(cast_ball_at_triangle(corners, 0.25, middle, 1.0, impact), BallCast::hits);
    EXPECT_NEAR(length(middle.origin + impact.fraction * middle.translation - impact.on_core), 0.25, 1.0e-8);
  }
}

TEST(CastBall, LeavesOverlapsAndSliversToASearch) {
  BallImpact impact;
  EXPECT_EQ(cast_ball_at_box({1, 1, 1}, 0.5, {{1.4, 0, 0}, {1, 0, 0}}, 1.0, impact), BallCast::unknown);
  EXPECT_EQ(cast_ball_at_box({1, 1, 1}, 0.5, {{1.6, 0, 0}, {1, 0, 0}}, 1.0, impact), BallCast::misses);
  // Inside the corner of the rounded box's bounding box, but beside the rounded corner.
  EXPECT_EQ(cast_ball_at_box({1, 1, 1}, 0.5, {{1.4, 1.4, 0}, {-1, 0, 0}}, 1.0, impact), BallCast::hits);
  const DVec3 sliver[3] = {{}, {1, 0, 0}, {2, 0, 0}};
  EXPECT_EQ(cast_ball_at_triangle(sliver, 0.5, {{0, 2, 0}, {0, -2, 0}}, 1.0, impact), BallCast::unknown);
}

}  // namespace
}  // namespace gyre::cast_ball_test
