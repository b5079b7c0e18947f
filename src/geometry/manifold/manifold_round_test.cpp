// Round shapes: closed forms against each other and against GJK, exact normals, and all positions of a centre inside.
#include "geometry/manifold/manifold_round.h"

#include "geometry/testing/convex_oracle.h"

#include <gtest/gtest.h>

namespace gyre::manifold_round_test {
namespace {

using namespace oracle;

LocalManifold collide(const Shape& a, const Shape& b, const Transform& t, float max_separation) {
  PairCache cache;
  LocalManifold out;
  collide_round(a, b, t, max_separation, cache, out);
  return out;
}

TEST(ManifoldRound, Spheres) {
  const Shape a = make_sphere(0.5f), b = make_sphere(0.25f);
  const LocalManifold m = collide(a, b, {{0, 0.6f, 0}, {}}, 0.0f);
  ASSERT_EQ(m.count, 1);
  EXPECT_EQ(m.normal, (Vec3{0, 1, 0}));
  EXPECT_NEAR(m.points[0].separation, -0.15f, 1.0e-7f);
  EXPECT_NEAR(m.points[0].position.y, 0.425f, 1.0e-7f);
  EXPECT_EQ(collide(a, b, {{0, 0.76f, 0}, {}}, 0.0f).count, 0);
  EXPECT_EQ(collide(a, b, {{0, 0.76f, 0}, {}}, 0.02f).count, 1);
  // Concentric: some unit normal, the depth of both radii.
  const LocalManifold same = collide(a, b, {}, 0.0f);
  ASSERT_EQ(same.count, 1);
  EXPECT_NEAR(length(same.normal), 1.0f, 1.0e-6f);
  EXPECT_NEAR(same.points[0].separation, -0.75f, 1.0e-6f);
}

TEST(ManifoldRound, SpheresAgainstEverythingEqualGjkOutsideAndEpaInside) {
  Random random(71);
  Hulls hulls;
  int inside = 0, near = 0;
  for (int i = 0; i < 12000; ++i) {
    const float scale = i % 3 == 0 ? 1.0f : i % 3 == 1 ? 1.0e-3f : 1.0e3f;
    const int kind = 1 + random.below(6);
    const Shape shape = random_shape(random, hulls, kind, scale),
                sphere = make_sphere(scale * random(0.05f, 0.3f));
    const Transform t = random_pose(random, scale);
    const double distance = signed_distance(shape, sphere, t);
    const LocalManifold m = collide(shape, sphere, t, 0.1f * scale);
    const double tolerance = 4.0e-6 * double(size_of(shape, sphere, t));
    if (absolute(distance - 0.1 * double(scale)) < tolerance) continue;
    ASSERT_EQ(m.count, distance < 0.1 * double(scale) ? 1 : 0) << kind_name(kind) << " " << i;
    if (m.count == 0) continue;
    ++near;
    const CorePair pair(shape, sphere, t);
    const CoreDistance core = core_distance(pair, 1.0e30, {});
    if (core.overlap) {
      ++inside;
      // EPA is exact on flat sides. For a centre on a cylinder's axis it finds only one of a ring of equal exits.
      EXPECT_NEAR(double(m.points[0].separation), distance, 2.0e-2 * pair.size())
          << kind_name(kind) << " " << i;
      EXPECT_NEAR(
          separation(shape, sphere, pair, DVec3(m.normal)) - double(sphere.radius + core_radius(shape)),
          double(m.points[0].separation), tolerance)
          << kind_name(kind) << " " << i;
      continue;
    }
    EXPECT_NEAR(double(m.points[0].separation), distance, tolerance) << kind_name(kind) << " " << i;
    // The normal is exact; only the distance has a rounding error of float.
    EXPECT_LT(length(DVec3(m.normal) - core.normal), 1.0e-4 + tolerance / core.distance)
        << kind_name(kind) << " " << i;
    // The same with the sphere first.
    const LocalManifold swapped = collide(sphere, shape, inverse(t), 0.1f * scale);
    ASSERT_EQ(swapped.count, 1);
    EXPECT_NEAR(swapped.points[0].separation, m.points[0].separation, float(2.0 * tolerance))
        << kind_name(kind) << " " << i;
  }
  EXPECT_GT(inside, 300);
  EXPECT_GT(near, 2000);
}

TEST(ManifoldRound, ASphereOnAFlatSideHasThatSidesNormal) {
  // Exactly: nothing may push a rolling ball sideways.
  Random random(72);
  for (int i = 0; i < 500; ++i) {
    const Vec3 at{random(-0.3f, 0.3f), 1.0f, random(-0.3f, 0.3f)};
    const Shape ball = make_sphere(0.505f);
    EXPECT_EQ(collide(make_box({1, 0.5f, 1}), ball, {at, {}}, 0.0f).normal, (Vec3{0, 1, 0}));
    EXPECT_EQ(collide(make_along_y(ShapeKind::cylinder, 1, 0.5f), ball, {at, {}}, 0.0f).normal,
              (Vec3{0, 1, 0}));
  }
}

TEST(ManifoldRound, CapsulesSideBySideTouchTwice) {
  const Shape a = make_along_y(ShapeKind::capsule, 0.2f, 0.5f),
              b = make_along_y(ShapeKind::capsule, 0.3f, 0.7f);
  const LocalManifold m = collide(a, b, {{0.49f, 0.1f, 0}, {}}, 0.02f);
  ASSERT_EQ(m.count, 2);
  EXPECT_LT(distance(m.normal, {1, 0, 0}), 1.0e-6f);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(m.points[i].separation, -0.01f, 1.0e-6f);
    EXPECT_NEAR(absolute(m.points[i].position.y), 0.5f, 1.0e-6f);
    EXPECT_NEAR(m.points[i].position.x, 0.195f, 1.0e-6f);
  }
  EXPECT_NE(m.points[0].feature, m.points[1].feature);
  // Crossed, end to end, and through each other.
  EXPECT_EQ(collide(a, b, {{0.49f, 0.1f, 0}, from_axis_angle({1, 0, 0}, 1.0f)}, 0.02f).count, 1);
  EXPECT_EQ(collide(a, b, {{0, 1.69f, 0}, {}}, 0.02f).count, 1);
  const LocalManifold through = collide(a, b, {{}, from_axis_angle({1, 0, 0}, 1.0f)}, 0.02f);
  ASSERT_EQ(through.count, 1);
  EXPECT_NEAR(absolute(through.normal.x), 1.0f, 1.0e-5f);
  EXPECT_NEAR(through.points[0].separation, -0.5f, 1.0e-5f);
}

TEST(ManifoldRound, CapsulesEqualTheirSegmentsDistance) {
  Random random(73);
  Hulls hulls;
  for (int i = 0; i < 5000; ++i) {
    const Shape a = random_shape(random, hulls, 2, 1.0f), b = random_shape(random, hulls, 2, 1.0f);
    const Transform t = random_pose(random, 1.0f);
    const double distance = signed_distance(a, b, t);
    const LocalManifold m = collide(a, b, t, 0.05f);
    if (absolute(distance - 0.05) < 1.0e-5) continue;
    ASSERT_EQ(m.count > 0, distance < 0.05) << i;
    if (m.count == 0) continue;
    float deepest = kUnbounded;
    for (int k = 0; k < m.count; ++k) deepest = min(deepest, m.points[k].separation);
    EXPECT_NEAR(double(deepest), distance,
                m.count == 1 ? 2.0e-6 : 1.0e-2 * double(min(a.radius, b.radius)) + 2.0e-6)
        << i;
  }
}

// A ball whose middle lay on a cylinder's rim, to rounding, was pushed along that rounding: deeper in, not out.
TEST(ManifoldRound, ABallWithItsMiddleOnARimIsPushedOut) {
  const Shape cylinder = make_along_y(ShapeKind::cylinder, 0.664687872f, 0.206659272f),
              ball = make_sphere(1.0f);
  const Transform t{{-0.53012538f, 0.206659377f, 0.400970191f}, {}};
  const LocalManifold m = collide(cylinder, ball, t, 0.02f);
  ASSERT_EQ(m.count, 1);
  const CorePair pair(cylinder, ball, t);
  EXPECT_NEAR(separation(cylinder, ball, pair, DVec3(m.normal)) - 1.0, double(m.points[0].separation),
              1.0e-5);
}

// Capsules one behind the other, on one axis but for rounding, were given two points that lay far too shallow.
TEST(ManifoldRound, CapsulesEndToEndTouchInOnePoint) {
  const Shape a = make_along_y(ShapeKind::capsule, 0.5f, 0.35f),
              b = make_along_y(ShapeKind::capsule, 0.5f, 0.45f);
  for (const float x : {0.0f, -2.3e-8f, 6.7e-7f, 1.0e-5f}) {
    const LocalManifold m = collide(a, b, {{0, -1.7f, 0}, normalized(Quat{x, 0, 0.5f * x, 1})}, 0.02f);
    ASSERT_EQ(m.count, 1) << x;
    EXPECT_NEAR(m.points[0].separation, -0.1f, 1.0e-4f) << x;
    EXPECT_LT(length(m.normal - Vec3{0, -1, 0}), 1.0e-3f) << x;
  }
}

}  // namespace
}  // namespace gyre::manifold_round_test
