// Overlap of surfaces against a test of all pairs of triangles: an edge of one passes through the other.
#include "geometry/query/surface_overlap.h"

#include "geometry/query/cast_surface.h"
#include "geometry/shape/cooked.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace gyre::surface_overlap_test {
namespace {

struct Random {
  std::mt19937 engine{7};
  float operator()(float low, float high) { return low + (high - low) * float(engine() >> 8) / 16777216.0f; }
  Vec3 in_box(float half) {
    const float x = (*this)(-half, half), y = (*this)(-half, half), z = (*this)(-half, half);
    return {x, y, z};
  }
  Quat turn() {
    const Vec3 v = in_box(1.0f);
    return normalized(Quat{v.x, v.y, v.z, (*this)(-1, 1)});
  }
};

using Triangles = std::vector<std::array<DVec3, 3>>;

struct Surface {
  Geometry geometry;
  Triangles triangles;
};

Surface random_mesh(Random& random, int count) {
  std::vector<Vec3> v;
  std::vector<std::uint32_t> t;
  Triangles all;
  for (int i = 0; i < count; ++i) {
    const Vec3 middle = random.in_box(2.0f);
    for (int k = 0; k < 3; ++k) {
      t.push_back(std::uint32_t(v.size()));
      v.push_back(middle + random.in_box(0.5f));
    }
    const std::size_t n = v.size();
    all.push_back({DVec3(v[n - 3]), DVec3(v[n - 2]), DVec3(v[n - 1])});
  }
  return {*cook_mesh({.vertices = v, .indices = t}), all};
}

Surface random_field(Random& random, std::uint32_t columns, std::uint32_t rows) {
  std::vector<float> heights;
  for (std::uint32_t i = 0; i < columns * rows; ++i)
    heights.push_back(random(0, 1) < 0.2f ? std::numeric_limits<float>::quiet_NaN() : random(-0.5f, 0.5f));
  heights[0] = heights[1] = heights[columns] = heights[columns + 1] = 0.2f;  // at least one cell is no hole
  const Result<Geometry> cooked =
      cook_height_field({.heights = heights, .columns = columns, .rows = rows, .spacing = 0.7f});
  if (!cooked) ADD_FAILURE() << cooked.error().message;
  Surface out{*cooked, {}};
  const Shape shape = make_shape(out.geometry);
  for (std::uint32_t row = 0; row + 1 < rows; ++row) {
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      const std::size_t corner = row * columns + column;
      const float sum =
          heights[corner] + heights[corner + 1] + heights[corner + columns] + heights[corner + columns + 1];
      for (int half = 0; half < 2 && std::isfinite(sum); ++half) {
        const SurfaceTriangle t = surface_triangle(*shape.field, column, row, half);
        out.triangles.push_back({DVec3(t.a), DVec3(t.b), DVec3(t.c)});
      }
    }
  }
  return out;
}

// True if the segment passes through the triangle, by the signs of volumes (in general position).
bool runs_through(DVec3 p, DVec3 q, const std::array<DVec3, 3>& t) {
  const auto volume = [](DVec3 a, DVec3 b, DVec3 c, DVec3 d) { return dot(a - d, cross(b - d, c - d)); };
  if ((volume(t[0], t[1], t[2], p) > 0) == (volume(t[0], t[1], t[2], q) > 0)) return false;
  const bool one = volume(p, q, t[0], t[1]) > 0;
  return one == (volume(p, q, t[1], t[2]) > 0) && one == (volume(p, q, t[2], t[0]) > 0);
}

bool cut(const Triangles& a, const Triangles& b, const Transform& a_from_b) {
  const DQuat turn = normalized(to_double(a_from_b.orientation));
  for (const auto& t : b) {
    std::array<DVec3, 3> moved;
    for (std::size_t k = 0; k < 3; ++k) moved[k] = DVec3(a_from_b.position) + rotate(turn, t[k]);
    for (const auto& s : a) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (runs_through(moved[k], moved[(k + 1) % 3], s) || runs_through(s[k], s[(k + 1) % 3], moved))
          return true;
      }
    }
  }
  return false;
}

TEST(SurfacesOverlap, LikeAllPairsOfTriangles) {
  Random random;
  int together = 0, apart = 0;
  for (int i = 0; i < 4000; ++i) {
    const auto surface = [&](int kind) {
      return kind == 0 ? random_mesh(random, 1 + int(random.engine() % 12))
                       : random_field(random, 2 + std::uint32_t(random.engine() % 5), 4);
    };
    const Surface a = surface(i % 2), b = surface(i / 2 % 2);
    const Transform a_from_b{random.in_box(1.0f), random.turn()};
    const bool expected = cut(a.triangles, b.triangles, a_from_b);
    const Shape shape_a = make_shape(a.geometry), shape_b = make_shape(b.geometry);
    EXPECT_EQ(surfaces_overlap(shape_a, shape_b, a_from_b), expected) << i;
    EXPECT_EQ(surfaces_overlap(shape_b, shape_a, inverse(a_from_b)), expected) << i;
    (expected ? together : apart) += 1;
  }
  EXPECT_GT(together, 300);
  EXPECT_GT(apart, 300);
}

TEST(SurfacesOverlap, PlanesAreSolidBelow) {
  Random random;
  int together = 0;
  for (int i = 0; i < 1000; ++i) {
    const Surface s = i % 2 == 0 ? random_mesh(random, 6) : random_field(random, 4, 5);
    const Plane plane{normalized(random.in_box(1.0f)), random(-2, 2)};
    const Transform plane_from_s{random.in_box(2.5f), random.turn()};
    const DQuat turn = normalized(to_double(plane_from_s.orientation));
    bool expected = false;
    for (const auto& t : s.triangles) {
      for (const DVec3& corner : t) {
        const DVec3 p = DVec3(plane_from_s.position) + rotate(turn, corner);
        expected = expected || dot(DVec3(plane.normal), p) <= double(plane.offset);
      }
    }
    together += expected ? 1 : 0;
    const Shape solid = make_shape(AnyShape(plane)), surface = make_shape(s.geometry);
    EXPECT_EQ(surfaces_overlap(solid, surface, plane_from_s), expected) << i;
    EXPECT_EQ(surfaces_overlap(surface, solid, inverse(plane_from_s)), expected) << i;
  }
  EXPECT_GT(together, 200);
  EXPECT_LT(together, 900);
  // Two half-spaces: apart only back to back.
  const Shape up = make_shape(AnyShape(Plane{{0, 1, 0}, 0})),
              down = make_shape(AnyShape(Plane{{0, -1, 0}, 0}));
  EXPECT_TRUE(surfaces_overlap(up, up, {{0, 5, 0}, {}}));
  EXPECT_FALSE(surfaces_overlap(up, down, {{0, 5, 0}, {}}));
  EXPECT_TRUE(surfaces_overlap(up, down, {{0, -5, 0}, {}}));
  EXPECT_TRUE(surfaces_overlap(up, down, {{0, 5, 0}, normalized(Quat{0.1f, 0, 0, 1})}));
}

// Triangles that only touch, lie in one plane, or lie in one plane apart.
TEST(SurfacesOverlap, FlushAndTouching) {
  const Vec3 v[3] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
  const std::uint32_t t[3] = {0, 1, 2};
  const Geometry mesh = *cook_mesh({.vertices = v, .indices = t});
  const Shape shape = make_shape(mesh);
  EXPECT_TRUE(surfaces_overlap(shape, shape, {}));
  EXPECT_TRUE(surfaces_overlap(shape, shape, {{0.25f, 0, 0.25f}, {}}));
  EXPECT_TRUE(surfaces_overlap(shape, shape, {{1, 0, 0}, {}}));
  EXPECT_FALSE(surfaces_overlap(shape, shape, {{0.75f, 0, 0.75f}, {}})) << "in one plane, boxes meet";
  EXPECT_FALSE(surfaces_overlap(shape, shape, {{0, 0.001f, 0}, {}}));
  // In one plane, and only the long edge of the first parts the two.
  const Vec3 w[3] = {{0.6f, 0, 0.6f}, {0.7f, 0, 3.0f}, {10.0f, 0, 0.7f}};
  const Geometry corner = *cook_mesh({.vertices = w, .indices = t});
  EXPECT_FALSE(surfaces_overlap(shape, make_shape(corner), {}));
  EXPECT_FALSE(surfaces_overlap(make_shape(corner), shape, {}));
  EXPECT_TRUE(surfaces_overlap(shape, make_shape(corner), {{-0.2f, 0, -0.2f}, {}}));
}

}  // namespace
}  // namespace gyre::surface_overlap_test
