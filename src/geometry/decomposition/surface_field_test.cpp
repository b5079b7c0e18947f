// Distances and winding numbers against plain loops over all triangles.
#include "geometry/decomposition/surface_field.h"

#include "geometry/decomposition/decomposition_test_meshes.h"
#include "geometry/distance/closest.h"

#include <gtest/gtest.h>

#include <random>

namespace gyre::surface_field_test {
namespace {

struct Plain {
  std::vector<DVec3> vertices;
  std::vector<std::uint32_t> indices;

  explicit Plain(const TestMesh& mesh) : indices(mesh.indices) {
    for (const Vec3& v : mesh.vertices) vertices.push_back(DVec3(0.4f * v + Vec3{0.5f, 0.5f, 0.5f}));
  }
  double winding(DVec3 p) const {
    double sum = 0.0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const DVec3 a = vertices[indices[i]] - p, b = vertices[indices[i + 1]] - p,
                  c = vertices[indices[i + 2]] - p;
      const double la = length(a), lb = length(b), lc = length(c);
      sum += 2.0 *
             std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
    }
    return sum / (4.0 * kPiDouble);
  }
  double distance(DVec3 p) const {
    double best = 1.0e300;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
      const SimplexPoint near =
          closest_on_triangle(p, vertices[indices[i]], vertices[indices[i + 1]], vertices[indices[i + 2]]);
      best = std::min(best, length(near.point - p));
    }
    return best;
  }
};

void expect_equal_to_loops(const TestMesh& mesh) {
  const Plain plain(mesh);
  const SurfaceField field(plain.vertices, plain.indices);
  std::mt19937 random(1);
  const auto number = [&] { return double(random() >> 8) / 16777216.0; };
  for (int i = 0; i < 400; ++i) {
    DVec3 p{number(), number(), number()};
    if (i % 2 == 0) {
      // Close to the surface.
      const std::size_t t = random() % (plain.indices.size() / 3);
      p = plain.vertices[plain.indices[3 * t]] + 0.01 * (p - DVec3{0.5, 0.5, 0.5});
    }
    EXPECT_NEAR(field.distance(p, 10.0), plain.distance(p), 1.0e-9);
    // Distant groups are dipoles: the error falls with the square of radius over distance.
    EXPECT_NEAR(field.winding(p), plain.winding(p), 0.06);
  }
  EXPECT_EQ(field.distance({0.5, 0.5, 9.0}, 0.25), 0.25);
}

TEST(SurfaceField, EqualsLoopsOverAllTriangles) {
  expect_equal_to_loops(torus_mesh(0.8f, 0.3f));
  expect_equal_to_loops(mug_mesh());
  expect_equal_to_loops(bowl_sheet());
  expect_equal_to_loops(gear_mesh(12));
}

TEST(SurfaceField, NamesTheNearestTriangle) {
  const Plain plain(torus_mesh(0.8f, 0.3f));
  const SurfaceField field(plain.vertices, plain.indices);
  std::mt19937 random(2);
  const auto number = [&] { return double(random() >> 8) / 16777216.0; };
  for (int i = 0; i < 300; ++i) {
    const DVec3 p{number(), number(), number()};
    const SurfaceField::Nearest nearest = field.nearest(p, 10.0);
    const std::size_t t = 3 * std::size_t(nearest.triangle);
    const SimplexPoint on =
        closest_on_triangle(p, plain.vertices[plain.indices[t]], plain.vertices[plain.indices[t + 1]],
                            plain.vertices[plain.indices[t + 2]]);
    EXPECT_NEAR(length(on.point - p), plain.distance(p), 1.0e-12);
    EXPECT_EQ(field.nearest(p, 0.5 * nearest.distance).triangle, SurfaceField::kNoTriangle);
  }
}

// Marching along a segment meets the surface first where the crossing is, and segments without a crossing stay on one side.
TEST(SurfaceField, FindsTheFirstCrossing) {
  for (const TestMesh& mesh : {torus_mesh(0.8f, 0.3f), gear_mesh(12)}) {
    const Plain plain(mesh);
    const SurfaceField field(plain.vertices, plain.indices);
    std::mt19937 random(3);
    const auto number = [&] { return double(random() >> 8) / 16777216.0; };
    int crossings = 0;
    for (int i = 0; i < 400; ++i) {
      const DVec3 p{number(), number(), number()}, q{number(), number(), number()};
      const SurfaceField::Crossing first = field.first_crossing(p, q);
      const bool crosses = first.triangle != SurfaceField::kNoTriangle;
      crossings += crosses ? 1 : 0;
      if (crosses) {
        EXPECT_LT(plain.distance(p + first.fraction * (q - p)), 1.0e-9);
      }
      const double end = crosses ? first.fraction : 1.0;
      for (const double before : {0.1, 0.35, 0.6, 0.85, 0.999})
        EXPECT_EQ(field.inside(p + before * end * (q - p)), field.inside(p));
    }
    EXPECT_GT(crossings, 50);
  }
}

// Segments through edges and vertices meet a triangle too.
TEST(SurfaceField, NoSegmentSlipsThroughAnEdge) {
  const Plain plain(box_mesh({0, 0, 0}, {0.5f, 0.5f, 0.5f}));
  const SurfaceField field(plain.vertices, plain.indices);
  for (int i = 1; i < 20; ++i) {
    for (int j = 1; j < 20; ++j) {
      const DVec3 from{0.3 + 0.02 * i, 0.3 + 0.02 * j, 0.1}, to{0.3 + 0.02 * i, 0.3 + 0.02 * j, 0.5};
      const SurfaceField::Crossing first = field.first_crossing(from, to);
      ASSERT_NE(first.triangle, SurfaceField::kNoTriangle) << i << ' ' << j;
      EXPECT_NEAR(first.fraction, 0.5, 1.0e-6);
    }
  }
}

TEST(SurfaceField, WindingCountsHowOftenAPointIsInside) {
  TestMesh mesh = box_mesh({0, 0, 0}, {0.5f, 0.5f, 0.5f});
  mesh.add(box_mesh({0.3f, 0, 0}, {0.5f, 0.4f, 0.4f}));
  const Plain plain(mesh);
  const SurfaceField field(plain.vertices, plain.indices);
  EXPECT_NEAR(field.winding({0.5, 0.5, 0.5}), 2.0, 0.06);
  EXPECT_NEAR(field.winding({0.35, 0.5, 0.5}), 1.0, 0.06);
  EXPECT_NEAR(field.winding({0.95, 0.5, 0.5}), 0.0, 0.06);
}

}  // namespace
}  // namespace gyre::surface_field_test
