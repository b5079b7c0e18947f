// Casts of shapes against every kind: the impact is where dense steps with GJK's distance find it, and the result
// touches.
#include "geometry/query/cast.h"

#include "geometry/query/cast_surface.h"
#include "geometry/query/closest_points.h"
#include "geometry/shape/cooked.h"
#include "geometry/testing/convex_oracle.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

namespace gyre::cast_shape_test {
namespace {

using oracle::Random;

PosedShape placed(const MovingShape& moving, double t) {
  return {moving.shape, moving.position + t * moving.translation, moving.orientation};
}

// The distance by a plain test of everything: no trees, no stepwise search.
double plain_distance(const Shape& target, const PosedShape& convex) {
  ClosestPair near;
  if (is_convex(target.kind) || target.kind == ShapeKind::plane) {
    find_closest_points(target, convex, 1.0e30, near);
    return near.distance;
  }
  double least = 1.0e300;
  const std::uint32_t count = target.mesh->triangle_count();
  for (std::uint32_t id = 0; id < count; ++id) {
    const SurfaceTriangle t = surface_triangle(*target.mesh, id);
    const DVec3 corners[3] = {DVec3(t.a), DVec3(t.b), DVec3(t.c)};
    const CorePair pair(corners, *convex.shape, convex.position, convex.orientation);
    const CoreDistance d = core_distance(pair, 1.0e30, {});
    least = min(least, d.overlap ? 0.0 : max(d.distance - double(core_radius(*convex.shape)), 0.0));
  }
  return least;
}

void expect_right(const Shape& target, const MovingShape& moving, double size, const char* what) {
  LocalHit hit;
  const bool hits = cast_shape(target, moving, 1.0, true, hit);
  const double precision = 1.0e-6 * size + 1.0e-8 * length(moving.position);
  if (plain_distance(target, placed(moving, 0.0)) == 0.0) {
    EXPECT_TRUE(hits && hit.inside && hit.fraction == 0.0) << what;
    return;
  }
  constexpr int kSteps = 60;
  const double end = hits ? hit.fraction : 1.0;
  for (int i = 0; i < kSteps; ++i) {
    // A contact within rounding during the cast may count as a hit or not.
    const double t = end * double(i) / kSteps;
    EXPECT_GT(plain_distance(target, placed(moving, t)), 0.0) << what << " at " << t << " of " << end;
    if (::testing::Test::HasFailure()) return;
  }
  if (!hits) return;
  EXPECT_FALSE(hit.inside);
  EXPECT_LE(plain_distance(target, placed(moving, hit.fraction)), precision) << what;
  EXPECT_NEAR(length(hit.normal), 1.0, 1.0e-6) << what;
  EXPECT_LE(dot(hit.normal, moving.translation), 0.0) << what;
  // The point lies on both.
  Shape point;
  point.radius = 0.0f;
  ClosestPair near;
  ASSERT_TRUE(find_closest_points(target, {&point, hit.point, {}}, 1.0, near)) << what;
  EXPECT_LE(near.distance, 50.0 * precision) << what;
  const DVec3 in_moving =
      rotate_inverse(moving.orientation, hit.point - placed(moving, hit.fraction).position);
  ASSERT_TRUE(find_closest_points(*moving.shape, {&point, in_moving, {}}, 1.0, near)) << what;
  EXPECT_LE(near.distance, 50.0 * precision) << what;
}

MovingShape random_way(Random& random, const Shape& shape, double size) {
  MovingShape moving;
  moving.shape = &shape;
  moving.orientation = normalized(to_double(random.rotation()));
  const double away = random.below(4) == 0 ? 200.0 : 3.0;
  moving.position = away * size * DVec3(random.direction());
  moving.translation = 1.6 * (size * DVec3(random.in_cube(0.8f)) - moving.position);
  return moving;
}

TEST(CastShape, MeetsEveryConvexPairWhereDenseStepsDo) {
  Random random(1);
  for (int a = 0; a < oracle::kKinds; ++a) {
    for (int b = 0; b < oracle::kKinds; ++b) {
      for (int i = 0; i < 60 && !HasFailure(); ++i) {
        oracle::Hulls hulls;
        const Shape target = oracle::random_shape(random, hulls, a, 1.0f),
                    shape = oracle::random_shape(random, hulls, b, 1.0f);
        const std::string what = std::string(oracle::kind_name(b)) + " at " + oracle::kind_name(a);
        expect_right(target, random_way(random, shape, 1.0), 1.0, what.c_str());
      }
    }
  }
}

TEST(CastShape, MeetsPlanesAndMeshes) {
  Random random(2);
  test::Random rough{5};
  const Geometry mesh =
      test::grid(3.0f, 0.4f, [&](float, float) { return rough.between(-0.4f, 0.4f); }).cook();
  const Shape surface = make_shape(AnyShape(mesh));
  for (int kind = 0; kind < oracle::kKinds; ++kind) {
    for (int i = 0; i < 60 && !HasFailure(); ++i) {
      oracle::Hulls hulls;
      const Shape shape = oracle::random_shape(random, hulls, kind, 0.5f);
      const MovingShape moving = random_way(random, shape, 1.5);
      expect_right(oracle::make_plane(random.direction(), random(-1, 1)), moving, 1.0,
                   oracle::kind_name(kind));
      expect_right(surface, moving, 1.0, oracle::kind_name(kind));
    }
  }
}

TEST(CastShape, OfAHeightFieldIsThatOfTheSameMesh) {
  Random random(3);
  constexpr std::uint32_t kSide = 12;
  std::vector<float> heights(kSide * kSide);
  for (float& h : heights) h = random(-0.4f, 0.4f);
  const Geometry field =
      *cook_height_field({.heights = heights, .columns = kSide, .rows = kSide, .spacing = 0.5f});
  test::Triangles triangles;
  const HeightField& data = *field.data()->field;
  for (std::uint32_t id = 0; id < 2 * (kSide - 1) * (kSide - 1); ++id) {
    const TriangleView view = view_triangle(data, id);
    const std::uint32_t first = triangles.vertex(view.v[0]);
    triangles.vertex(view.v[1]), triangles.vertex(view.v[2]);
    triangles.triangle(first, first + 1, first + 2);
  }
  const Geometry mesh = triangles.cook();
  const Shape a = make_shape(AnyShape(field)), b = make_shape(AnyShape(mesh));
  int hits = 0;
  for (int i = 0; i < 700; ++i) {
    oracle::Hulls hulls;
    const Shape shape = oracle::random_shape(random, hulls, i % oracle::kKinds, 0.4f);
    const MovingShape moving = random_way(random, shape, 1.5);
    LocalHit on_field, on_mesh;
    const bool hit = cast_shape(a, moving, 1.0, i % 2 == 0, on_field);
    ASSERT_EQ(hit, cast_shape(b, moving, 1.0, i % 2 == 0, on_mesh)) << i;
    if (!hit) continue;
    ++hits;
    EXPECT_EQ(on_field.fraction, on_mesh.fraction);
    EXPECT_EQ(on_field.triangle, on_mesh.triangle);
  }
  EXPECT_GT(hits, 300);
}

TEST(CastShape, KnowsTheExactFractionOfSimplePairs) {
  LocalHit hit;
  const Shape ball = oracle::make_sphere(0.5f), box = oracle::make_box({0.5f, 0.5f, 0.5f});
  ASSERT_TRUE(cast_shape(box, {&ball, {0, 6, 0}, {}, {0, -10, 0}}, 1.0, false, hit));
  EXPECT_NEAR(hit.fraction, 0.5, 1e-9);
  EXPECT_NEAR(hit.normal.y, 1.0, 1e-9);
  EXPECT_NEAR(hit.point.y, 0.5, 1e-9);
  ASSERT_TRUE(cast_shape(box, {&box, {0.1, 6, 0.2}, {}, {0, -10, 0}}, 1.0, false, hit));
  EXPECT_NEAR(hit.fraction, 0.5, 1e-9);
  // From six kilometres, and a thousand.
  for (const double far_away : {6.0e3, 1.0e6}) {
    ASSERT_TRUE(
        cast_shape(box, {&ball, {0, far_away + 1.0, 0}, {}, {0, -2.0 * far_away, 0}}, 1.0, false, hit));
    EXPECT_NEAR(hit.fraction, 0.5, 1e-9 * 6.0e3 / far_away);
  }
  // Two balls that pass at a distance of exactly, just below and just above the sum of their radii.
  EXPECT_TRUE(cast_shape(ball, {&ball, {-5, 0.999999, 0}, {}, {10, 0, 0}}, 1.0, false, hit));
  EXPECT_FALSE(cast_shape(ball, {&ball, {-5, 1.000001, 0}, {}, {10, 0, 0}}, 1.0, false, hit));
}

TEST(CastShape, StartsInOverlap) {
  LocalHit hit;
  const Shape box = oracle::make_box({0.5f, 0.5f, 0.5f});
  MovingShape moving{&box, {0, 0.9, 0}, {}, {3, 0, 0}};
  ASSERT_TRUE(cast_shape(box, moving, 1.0, false, hit));
  EXPECT_TRUE(hit.inside);
  EXPECT_EQ(hit.fraction, 0.0);
  EXPECT_NEAR(hit.depth, 0.1, 1e-6);
  EXPECT_NEAR(hit.normal.y, 1.0, 1e-6);
  // Within its skin it may slide and leave, but not go deeper.
  moving.skin = 0.11f;
  EXPECT_FALSE(cast_shape(box, moving, 1.0, false, hit));
  moving.translation = {0, 3, 0};
  EXPECT_FALSE(cast_shape(box, moving, 1.0, false, hit));
  moving.translation = {0, -3, 0};
  EXPECT_TRUE(cast_shape(box, moving, 1.0, false, hit));
  moving.skin = 0.09f;
  moving.translation = {3, 0, 0};
  EXPECT_TRUE(cast_shape(box, moving, 1.0, false, hit));
  // The exit from a one-sided surface is through its front.
  const Geometry floor = test::flat_grid(3.0f, 1.0f).cook();
  const Shape ground = make_shape(AnyShape(floor));
  ASSERT_TRUE(cast_shape(ground, {&box, {0.2, -0.3, 0.1}, {}, {0.1, -1, 0}}, 1.0, false, hit));
  EXPECT_TRUE(hit.inside);
  EXPECT_NEAR(hit.depth, 0.8, 1e-6);
  EXPECT_NEAR(hit.normal.y, 1.0, 1e-6);
  EXPECT_FALSE(
      cast_shape(ground, {&box, {0.2, -0.3, 0.1}, {}, {0.1, 1, 0}}, 1.0, false, hit));  // out by the front
  EXPECT_FALSE(cast_shape(ground, {&box, {0.2, -3, 0.1}, {}, {0, 6, 0}}, 1.0, false, hit));  // up from below
  EXPECT_TRUE(cast_shape(ground, {&box, {0.2, -3, 0.1}, {}, {0, 6, 0}}, 1.0, true, hit));
  EXPECT_NEAR(hit.fraction, 2.5 / 6.0, 1e-9);
}

}  // namespace
}  // namespace gyre::cast_shape_test
