// Closest points against every kind: as far apart as sampled directions say, and on both surfaces.
#include "geometry/query/closest_points.h"

#include "geometry/distance/closest.h"
#include "geometry/query/cast_surface.h"
#include "geometry/shape/cooked.h"
#include "geometry/testing/convex_oracle.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

namespace gyre::closest_points_test {
namespace {

using oracle::Random;

// The distance of a point outside a shape along sampled directions: positive only outside.
double sampled_height(const Shape& shape, DVec3 p, Random& random) {
  double highest = -1.0e300;
  for (int i = 0; i < 40; ++i) {
    const DVec3 d(random.direction());
    highest = max(highest, dot(p, d) - oracle::extent(shape, d) - double(core_radius(shape)) * length(d));
  }
  return highest;
}

// No two points are closer than the separation along any direction, and the distance is no more than that of any two
// points. If both bounds are equal, the distance is proven.
TEST(FindNearest, IsProvenForConvexPairs) {
  Random random(1);
  int apart = 0;
  for (int a = 0; a < oracle::kKinds; ++a) {
    for (int b = 0; b < oracle::kKinds; ++b) {
      for (int i = 0; i < 60; ++i) {
        oracle::Hulls hulls;
        const Shape target = oracle::random_shape(random, hulls, a, 1.0f),
                    shape = oracle::random_shape(random, hulls, b, 1.0f);
        const Transform t{2.0f * random.in_cube(), random.rotation()};
        const CorePair pair(target, shape, t);
        const PosedShape convex{&shape, DVec3(t.position), normalized(to_double(t.orientation))};
        const double radii = double(core_radius(target)) + double(core_radius(shape));
        const std::string what = std::string(oracle::kind_name(a)) + " and " + oracle::kind_name(b);
        ClosestPair near, none;
        ASSERT_TRUE(find_closest_points(target, convex, 1.0e30, near));
        if (near.overlap) {
          EXPECT_LE(oracle::sampled_separation(target, shape, pair, random, 100) - radii, 1.0e-6) << what;
          EXPECT_TRUE(find_closest_points(target, convex, 0.0, none));
          continue;
        }
        ++apart;
        EXPECT_NEAR(oracle::separation(target, shape, pair, near.normal) - radii, near.distance, 1.0e-6)
            << what;
        EXPECT_NEAR(length(near.on_convex - near.on_target), near.distance, 1.0e-6) << what;
        EXPECT_LE(sampled_height(target, near.on_target, random), 1.0e-6) << what;
        EXPECT_LE(sampled_height(shape, pair.to_b(near.on_convex - convex.position), random), 1.0e-6) << what;
        EXPECT_FALSE(find_closest_points(target, convex, 0.999 * near.distance, none));
        EXPECT_TRUE(find_closest_points(target, convex, 1.001 * near.distance, none));
      }
    }
  }
  EXPECT_GT(apart, 1000);
}

// Points, for which the nearest of a triangle is known in closed form.
TEST(FindNearest, OfAPointOnAMeshIsThatOfAllTriangles) {
  Random random(2);
  test::Random rough{7};
  const test::Triangles triangles =
      test::grid(4.0f, 0.3f, [&](float, float) { return rough.between(-0.5f, 0.5f); });
  const Geometry mesh = triangles.cook();
  const Shape surface = make_shape(AnyShape(mesh));
  Shape point;
  point.radius = 0.0f;
  for (int i = 0; i < 600; ++i) {
    const DVec3 p(random.in_cube(i % 3 == 0 ? 40.0f : 4.0f));
    double least = 1.0e300;
    for (std::size_t k = 0; k < triangles.indices.size(); k += 3) {
      const auto corner = [&](std::size_t c) { return DVec3(triangles.vertices[triangles.indices[k + c]]); };
      least = min(least, length(closest_on_triangle(p, corner(0), corner(1), corner(2)).point - p));
    }
    ClosestPair near;
    ASSERT_TRUE(find_closest_points(surface, {&point, p, {}}, 1.0e30, near));
    EXPECT_NEAR(near.distance, least, 1.0e-8 * (1.0 + least));
    ASSERT_TRUE(find_closest_points(surface, {&point, p, {}}, 1.001 * least, near));
    EXPECT_NEAR(near.distance, least, 1.0e-8 * (1.0 + least));
    EXPECT_FALSE(find_closest_points(surface, {&point, p, {}}, 0.999 * least, near));
  }
}

TEST(FindNearest, OfAnyShapeOnAHeightFieldIsThatOfAllTriangles) {
  Random random(3);
  constexpr std::uint32_t kColumns = 30, kRows = 17;
  std::vector<float> heights(kColumns * kRows);
  for (float& h : heights) h = random.below(30) == 0 ? __builtin_nanf("") : random(-0.5f, 0.5f);
  const Geometry made =
      *cook_height_field({.heights = heights, .columns = kColumns, .rows = kRows, .spacing = 0.4f});
  const HeightField& field = *made.data()->field;
  const Shape surface = make_shape(AnyShape(made));
  int overlaps = 0;
  for (int i = 0; i < 500; ++i) {
    oracle::Hulls hulls;
    const Shape shape = oracle::random_shape(random, hulls, i % oracle::kKinds, 0.5f);
    const PosedShape convex{&shape, DVec3(random.in_cube(i % 3 == 0 ? 12.0f : 3.0f)),
                            normalized(to_double(random.rotation()))};
    double least = 1.0e300;
    for (std::uint32_t cell = 0; cell < field.cell_rows() * field.cell_columns(); ++cell) {
      if (!is_solid_cell(field, cell % field.cell_columns(), cell / field.cell_columns())) continue;
      for (int half = 0; half < 2; ++half) {
        const SurfaceTriangle t =
            surface_triangle(field, cell % field.cell_columns(), cell / field.cell_columns(), half);
        const DVec3 corners[3] = {DVec3(t.a), DVec3(t.b), DVec3(t.c)};
        const CoreDistance d =
            core_distance(CorePair(corners, shape, convex.position, convex.orientation), 1.0e30, {});
        least = min(least, d.overlap ? 0.0 : max(d.distance - double(core_radius(shape)), 0.0));
      }
    }
    ClosestPair near;
    ASSERT_TRUE(find_closest_points(surface, convex, 1.0e30, near));
    EXPECT_NEAR(near.distance, least, 1.0e-7 * (1.0 + least));
    EXPECT_EQ(near.overlap, least == 0.0);
    overlaps += near.overlap ? 1 : 0;
    EXPECT_EQ(find_closest_points(surface, convex, 0.0, near), least == 0.0);
  }
  EXPECT_GT(overlaps, 30);
}

TEST(FindNearest, OfPlanesIsExact) {
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    oracle::Hulls hulls;
    const Shape shape = oracle::random_shape(random, hulls, i % oracle::kKinds, 1.0f);
    const Shape plane = oracle::make_plane({0, 1, 0}, 0.25f);
    const Quat turn = random.rotation();
    const Transform t{{0, random(-1.5f, 3.0f), 0}, turn};
    const double lowest = double(t.position.y) - double(core_radius(shape)) -
                          oracle::extent(shape, rotate_inverse(normalized(to_double(turn)), DVec3{0, -1, 0}));
    ClosestPair near;
    ASSERT_TRUE(
        find_closest_points(plane, {&shape, DVec3(t.position), normalized(to_double(turn))}, 1.0e30, near));
    EXPECT_NEAR(near.distance, max(lowest - 0.25, 0.0), 1.0e-6);
    EXPECT_EQ(near.normal, (DVec3{0, 1, 0}));
  }
}

}  // namespace
}  // namespace gyre::closest_points_test
