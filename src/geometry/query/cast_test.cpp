// Rays against convex shapes and planes: a hit lies on the surface and everything before it is outside, from any
// distance.
#include "geometry/query/cast.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

namespace gyre::cast_test {
namespace {

using oracle::Random;

// A function of each kind's definition: negative inside, positive outside, zero on the surface, with a slope of about
// one there.
double height_above(const Shape& shape, DVec3 p) {
  const double r = double(shape.radius), h = double(shape.extents.y);
  const double radial = std::sqrt(p.x * p.x + p.z * p.z);
  switch (shape.kind) {
    case ShapeKind::cylinder:
      return max(radial - r, absolute(p.y) - h);
    case ShapeKind::cone: {
      const double slant = std::sqrt(4.0 * h * h + r * r);
      return max(-h - p.y, (radial * 2.0 * h + (p.y - h) * r) / slant);
    }
    case ShapeKind::hull: {
      double highest = -1.0e300;
      for (const HullPlane& plane : shape.hull->planes)
        highest = max(highest, dot(DVec3(plane.normal), p) - double(plane.offset));
      return highest;
    }
    case ShapeKind::plane:
      return dot(DVec3(shape.extents), p) - double(shape.offset);
    default: {
      const DVec3 e(shape.kind == ShapeKind::sphere ? Vec3{} : shape.extents);
      const DVec3 over{absolute(p.x) - e.x, absolute(p.y) - e.y, absolute(p.z) - e.z};
      const DVec3 out{max(over.x, 0.0), max(over.y, 0.0), max(over.z, 0.0)};
      return length(out) + min(max(over.x, max(over.y, over.z)), 0.0) - r;
    }
  }
}

// Checks one ray against samples along it. Returns whether it hits.
bool expect_right(const Shape& shape, const LocalRay& ray, double size, const char* what) {
  LocalHit hit;
  const bool hits = cast_ray(shape, ray, 1.0, false, hit);
  const double precision = 1.0e-12 * (length(ray.origin) + length(ray.translation)) + 2.0e-7 * size;
  constexpr int kSamples = 400;
  const double end = hits ? hit.fraction : 1.0;
  for (int i = 0; i < kSamples; ++i) {
    const double t = end * (i + 0.5) / kSamples;
    if (hits && hit.inside) break;
    EXPECT_GT(height_above(shape, ray.origin + t * ray.translation), -precision)
        << what << " passed through at " << t;
    if (::testing::Test::HasFailure()) return hits;
  }
  if (!hits) return false;
  EXPECT_GE(hit.fraction, 0.0);
  EXPECT_LE(hit.fraction, 1.0);
  if (hit.inside) {
    EXPECT_LE(height_above(shape, ray.origin), precision) << what;
    EXPECT_EQ(hit.fraction, 0.0);
    return true;
  }
  EXPECT_NEAR(height_above(shape, hit.point), 0.0, precision) << what;
  EXPECT_LE(length(hit.point - (ray.origin + hit.fraction * ray.translation)), precision) << what;
  EXPECT_NEAR(length(hit.normal), 1.0, 1.0e-6) << what;
  EXPECT_LE(dot(hit.normal, ray.translation), 1.0e-6 * length(ray.translation)) << what;
  // Out along the normal is outside; in against it is not.
  EXPECT_GT(height_above(shape, hit.point + 1.0e-3 * size * hit.normal), 0.0) << what;
  return true;
}

TEST(CastRay, MeetsEveryConvexKindWhereSamplesSay) {
  Random random(1);
  for (int kind = 0; kind < oracle::kKinds; ++kind) {
    int hits = 0;
    for (int i = 0; i < 1500 && !HasFailure(); ++i) {
      oracle::Hulls hulls;
      const Shape shape = oracle::random_shape(random, hulls, kind, 1.0f);
      const double far_away = random.below(3) == 0 ? 1000.0 : 2.0;
      const DVec3 origin = far_away * DVec3(random.direction());
      DVec3 way = 2.0 * (DVec3(random.in_cube(0.7f)) - origin);
      if (random.below(6) == 0) way = {0.0, way.y, 0.0};
      if (random.below(6) == 0) way = {way.x, 0.0, way.z};
      hits += expect_right(shape, {origin, way}, 1.0, oracle::kind_name(kind)) ? 1 : 0;
    }
    EXPECT_GT(hits, 200) << oracle::kind_name(kind);
  }
}

TEST(CastRay, MeetsPlanes) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Shape plane = oracle::make_plane(random.direction(), random(-1, 1));
    const DVec3 origin = 3.0 * DVec3(random.direction());
    expect_right(plane, {origin, DVec3(5.0f * random.direction())}, 1.0, "plane");
  }
}

TEST(CastRay, StartsInsideAtOnce) {
  Random random(3);
  for (int kind = 0; kind < oracle::kKinds; ++kind) {
    oracle::Hulls hulls;
    const Shape shape = oracle::random_shape(random, hulls, kind, 1.0f);
    const DVec3 middle = kind == 5 ? DVec3(shape.hull->centroid) : DVec3{};
    LocalHit hit;
    const DVec3 way(random.direction());
    ASSERT_TRUE(cast_ray(shape, {middle, way}, 1.0, false, hit)) << oracle::kind_name(kind);
    EXPECT_TRUE(hit.inside);
    EXPECT_EQ(hit.fraction, 0.0);
    EXPECT_EQ(hit.point, middle);
    EXPECT_NEAR(dot(hit.normal, way), -length(way), 1.0e-6);
    // A ray without length hits inside and misses outside.
    ASSERT_TRUE(cast_ray(shape, {middle, {}}, 1.0, false, hit));
    EXPECT_TRUE(hit.inside);
    EXPECT_EQ(hit.normal, DVec3{});
    EXPECT_FALSE(cast_ray(shape, {{5, 5, 5}, {}}, 1.0, false, hit));
  }
}

// A ray that continues away from the shape from another ray's hit must not hit again.
TEST(CastRay, LeavesTheSurfaceThatItStartsOn) {
  Random random(4);
  for (int i = 0; i < 7000; ++i) {
    oracle::Hulls hulls;
    const Shape shape = oracle::random_shape(random, hulls, i % oracle::kKinds, 1.0f);
    const DVec3 origin = 3.0 * DVec3(random.direction());
    LocalHit hit, again;
    if (!cast_ray(shape, {origin, -1.5 * origin}, 1.0, false, hit)) continue;
    const DVec3 away = hit.normal + 0.5 * DVec3(random.direction());
    EXPECT_FALSE(cast_ray(shape, {hit.point, away}, 1.0, false, again))
        << oracle::kind_name(i % oracle::kKinds);
  }
}

TEST(CastRay, TouchesWhatItGrazes) {
  LocalHit hit;
  EXPECT_TRUE(cast_ray(oracle::make_sphere(1.0f), {{-3, 1, 0}, {6, 0, 0}}, 1.0, false, hit));
  EXPECT_DOUBLE_EQ(hit.fraction, 0.5);
  EXPECT_FALSE(cast_ray(oracle::make_sphere(1.0f), {{-3, 1.000001, 0}, {6, 0, 0}}, 1.0, false, hit));
  // Along a face, an edge and a mantle.
  EXPECT_TRUE(cast_ray(oracle::make_box({1, 1, 1}), {{-3, 1, 0}, {6, 0, 0}}, 1.0, false, hit));
  EXPECT_NEAR(hit.fraction, 1.0 / 3.0, 1e-15);
  EXPECT_TRUE(cast_ray(oracle::make_box({1, 1, 1}), {{-3, 1, 1}, {6, 0, 0}}, 1.0, false, hit));
  EXPECT_FALSE(cast_ray(oracle::make_box({1, 1, 1}), {{-3, 1.000001, 1}, {6, 0, 0}}, 1.0, false, hit));
  const Shape cylinder = oracle::make_along_y(ShapeKind::cylinder, 0.5f, 1.0f);
  EXPECT_TRUE(cast_ray(cylinder, {{0.5, 4, 0}, {0, -6, 0}}, 1.0, false, hit));
  EXPECT_DOUBLE_EQ(hit.fraction, 0.5);
  const Shape cone = oracle::make_along_y(ShapeKind::cone, 1.0f, 1.0f);
  EXPECT_TRUE(cast_ray(cone, {{0, 4, 0}, {0, -6, 0}}, 1.0, false, hit));  // the apex
  EXPECT_DOUBLE_EQ(hit.fraction, 0.5);
  EXPECT_EQ(hit.normal, (DVec3{0, 1, 0}));
  // Neither the mirror image of the cone above the apex nor the space below the base is part of it.
  EXPECT_FALSE(cast_ray(cone, {{-3, 1.5, 0}, {6, 0, 0}}, 1.0, false, hit));
  EXPECT_FALSE(cast_ray(cone, {{-3, -1.5, 0}, {6, 0, 0}}, 1.0, false, hit));
  EXPECT_TRUE(cast_ray(cone, {{-3, -0.5, 0}, {6, 0, 0}}, 1.0, false, hit));
  EXPECT_NEAR(hit.point.x, -0.75, 1e-12);
  // Parallel to the mantle: from above through the mantle's far side, and along it.
  EXPECT_TRUE(cast_ray(cone, {{-1, 2, 0}, {1.5, -3, 0}}, 1.0, false, hit));
  EXPECT_NEAR(height_above(cone, hit.point), 0.0, 1e-12);
}

// Ends at the surface exactly, or a hair short of it.
TEST(CastRay, EndsWhereItEnds) {
  LocalHit hit;
  EXPECT_TRUE(cast_ray(oracle::make_box({1, 1, 1}), {{0, 3, 0}, {0, -2, 0}}, 1.0, false, hit));
  EXPECT_DOUBLE_EQ(hit.fraction, 1.0);
  EXPECT_FALSE(cast_ray(oracle::make_box({1, 1, 1}), {{0, 3, 0}, {0, -1.999999, 0}}, 1.0, false, hit));
  EXPECT_FALSE(cast_ray(oracle::make_box({1, 1, 1}), {{0, 3, 0}, {0, -4, 0}}, 0.49, false, hit));
  EXPECT_FALSE(cast_ray(oracle::make_box({1, 1, 1}), {{0, 3, 0}, {0, 4, 0}}, 1.0, false, hit));
}

TEST(CastRay, KeepsItsPrecisionFromAThousandKilometres) {
  Random random(5);
  for (int kind = 0; kind < oracle::kKinds; ++kind) {
    for (int i = 0; i < 200; ++i) {
      oracle::Hulls hulls;
      const Shape shape = oracle::random_shape(random, hulls, kind, 1.0f);
      const DVec3 direction(random.direction()), target(random.in_cube(0.2f));
      const DVec3 near_origin = target + 4.0 * direction, far_origin = target + 1.0e6 * direction;
      LocalHit from_near, from_far;
      const bool hits = cast_ray(shape, {near_origin, -8.0 * direction}, 1.0, false, from_near);
      const bool far_hits = cast_ray(shape, {far_origin, -1.000004e6 * direction}, 1.0, false, from_far);
      if (hits != far_hits) continue;  // at an edge
      if (!hits) continue;
      EXPECT_LT(length(from_far.point - from_near.point), 1.0e-5) << oracle::kind_name(kind);
    }
  }
}

}  // namespace
}  // namespace gyre::cast_test
