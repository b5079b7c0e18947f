// Rays against meshes and height fields: the same hits as a plain test of all triangles, and no leak at shared edges.
#include "geometry/query/cast_surface.h"

#include "geometry/shape/cooked.h"
#include "geometry/testing/mesh_test_scenes.h"

#include <gtest/gtest.h>

namespace gyre::cast_surface_test {
namespace {

using test::Random;
using test::Triangles;

Shape shape_of(const Geometry& geometry) { return make_shape(AnyShape(geometry)); }

// Möller and Trumbore's test in double, of every triangle: another method than the one under test.
bool cast_plainly(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices, const LocalRay& ray,
                  bool both_sides, LocalHit& hit) {
  bool found = false;
  for (std::size_t i = 0; i < indices.size(); i += 3) {
    const DVec3 a(vertices[indices[i]]), u = DVec3(vertices[indices[i + 1]]) - a,
                                         v = DVec3(vertices[indices[i + 2]]) - a;
    const DVec3 p = cross(ray.translation, v);
    const double det = dot(u, p);
    if (both_sides ? det == 0.0 : det <= 0.0) continue;
    const DVec3 from = ray.origin - a, q = cross(from, u);
    const double s = dot(from, p) / det, t = dot(ray.translation, q) / det, fraction = dot(v, q) / det;
    if (s < 0.0 || t < 0.0 || s + t > 1.0 || fraction < 0.0 || fraction > 1.0) continue;
    if (found && fraction >= hit.fraction) continue;
    found = true;
    hit.fraction = fraction;
    hit.triangle = std::uint32_t(i / 3);
  }
  return found;
}

// A closed ball of rough triangles.
Triangles rough_ball(Random& random, int rings, int sectors) {
  Triangles out;
  const auto place = [&](int ring, int sector) {
    const float polar = kPi * float(ring) / float(rings), turn = 2.0f * kPi * float(sector) / float(sectors);
    const SinCos a = sin_cos(polar), b = sin_cos(turn);
    return random.between(0.8f, 1.2f) * Vec3{a.sin * b.cos, a.cos, a.sin * b.sin};
  };
  const std::uint32_t top = out.vertex(place(0, 0));
  for (int ring = 1; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) out.vertex(place(ring, sector));
  }
  const std::uint32_t bottom = out.vertex(place(rings, 0));
  const auto at = [&](int ring, int sector) {
    if (ring == 0) return top;
    if (ring == rings) return bottom;
    return std::uint32_t(1 + (ring - 1) * sectors + sector % sectors);
  };
  for (int ring = 0; ring < rings; ++ring) {
    for (int sector = 0; sector < sectors; ++sector) {
      if (ring > 0) out.triangle(at(ring, sector), at(ring, sector + 1), at(ring + 1, sector));
      if (ring + 1 < rings)
        out.triangle(at(ring, sector + 1), at(ring + 1, sector + 1), at(ring + 1, sector));
    }
  }
  return out;
}

TEST(CastRayAtMesh, FindsWhatAPlainTestOfAllTrianglesFinds) {
  Random random{1};
  int hits = 0, differ = 0;
  for (int mesh = 0; mesh < 20; ++mesh) {
    Triangles triangles;
    if (mesh % 2 == 0) {
      triangles = rough_ball(random, 12, 20);
    } else {
      triangles = test::grid(5.0f, 0.5f, [&](float, float) { return random.between(-0.5f, 0.5f); });
    }
    const bool double_sided = mesh % 4 >= 2;
    const Geometry geometry = triangles.cook(double_sided);
    const Shape shape = shape_of(geometry);
    for (int i = 0; i < 2000; ++i) {
      const bool back_faces = i % 3 == 0;
      const DVec3 origin(random.in_box(4.0f));
      DVec3 way(random.in_box(8.0f));
      if (i % 7 == 0) way = {0.0, way.y, 0.0};
      LocalHit hit, plain;
      const bool found = cast_ray(shape, {origin, way}, 1.0, back_faces, hit);
      const bool expected = cast_plainly(triangles.vertices, triangles.indices, {origin, way},
                                         double_sided || back_faces, plain);
      // The two may decide differently for a ray through an edge of the border.
      if (found != expected) {
        ++differ;
        continue;
      }
      if (!found) continue;
      ++hits;
      EXPECT_NEAR(hit.fraction, plain.fraction, 1.0e-12);
      EXPECT_TRUE(hit.fraction != plain.fraction || hit.triangle == plain.triangle);
      EXPECT_LE(dot(hit.normal, way), 1.0e-6 * length(way));
    }
  }
  EXPECT_GT(hits, 4000);
  EXPECT_EQ(differ, 0);
}

// No ray leaves a closed surface from inside: neither in random directions nor exactly at corners and along edges.
TEST(CastRayAtMesh, LetsNothingThroughSharedEdgesAndCorners) {
  Random random{2};
  for (int mesh = 0; mesh < 4; ++mesh) {
    const Triangles triangles = rough_ball(random, 16, 24);
    const Geometry geometry = triangles.cook();
    const Shape shape = shape_of(geometry);
    const DVec3 origin = mesh == 0 ? DVec3{} : DVec3(random.in_box(0.3f));
    long leaks = 0, rays = 0;
    const auto shoot = [&](DVec3 at) {
      LocalHit hit;
      ++rays;
      leaks += cast_ray(shape, {origin, 3.0 * (at - origin)}, 1.0, true, hit) ? 0 : 1;
      // And from outside, past the surface, seen from the front.
      const DVec3 outside = origin + 3.0 * (at - origin);
      leaks += cast_ray(shape, {outside, origin - outside}, 1.0, false, hit) ? 0 : 1;
    };
    for (const Vec3 vertex : triangles.vertices) shoot(DVec3(vertex));
    for (std::size_t i = 0; i < triangles.indices.size(); i += 3) {
      for (int edge = 0; edge < 3; ++edge) {
        const DVec3 a(triangles.vertices[triangles.indices[i + std::size_t(edge)]]);
        const DVec3 b(triangles.vertices[triangles.indices[i + std::size_t(next_corner(edge))]]);
        for (int k = 1; k < 12; ++k) shoot(a + (k / 12.0) * (b - a));
      }
    }
    for (int i = 0; i < 20000; ++i) shoot(DVec3(random.direction()));
    EXPECT_EQ(leaks, 0) << "of " << rays;
  }
}

TEST(CastRayAtMesh, PassesBackFacesUnlessAsked) {
  const Geometry one = test::flat_grid(2.0f, 1.0f).cook(false), both = test::flat_grid(2.0f, 1.0f).cook(true);
  const LocalRay up{{0.3, -1, 0.2}, {0, 2, 0}}, down{{0.3, 1, 0.2}, {0, -2, 0}},
      along{{-5, 0, 0.2}, {10, 0, 0}};
  LocalHit hit;
  EXPECT_FALSE(cast_ray(shape_of(one), up, 1.0, false, hit));
  ASSERT_TRUE(cast_ray(shape_of(one), up, 1.0, true, hit));
  EXPECT_EQ(hit.normal, (DVec3{0, -1, 0}));
  ASSERT_TRUE(cast_ray(shape_of(both), up, 1.0, false, hit));
  EXPECT_EQ(hit.normal, (DVec3{0, -1, 0}));
  ASSERT_TRUE(cast_ray(shape_of(one), down, 1.0, false, hit));
  EXPECT_EQ(hit.normal, (DVec3{0, 1, 0}));
  EXPECT_DOUBLE_EQ(hit.fraction, 0.5);
  EXPECT_FALSE(cast_ray(shape_of(both), along, 1.0, true, hit));
  EXPECT_FALSE(cast_ray(shape_of(both), {{0.3, 0, 0.2}, {}}, 1.0, true, hit));  // no length
}

TEST(CastRayAtHeightField, FindsWhatAPlainTestOfAllTrianglesFinds) {
  Random random{3};
  for (int k = 0; k < 8; ++k) {
    const std::uint32_t columns = 3 + std::uint32_t(random.unit() * 40.0f),
                        rows = 3 + std::uint32_t(random.unit() * 40.0f);
    std::vector<float> heights(columns * rows);
    for (float& h : heights) h = random.unit() < 0.02f ? __builtin_nanf("") : random.between(-1.0f, 1.0f);
    const Result<Geometry> made =
        cook_height_field({.heights = heights, .columns = columns, .rows = rows, .spacing = 0.7f});
    ASSERT_TRUE(made.has_value());
    const HeightField& field = *made->data()->field;
    std::vector<Vec3> vertices;
    std::vector<std::uint32_t> indices, names;
    for (std::uint32_t row = 0; row < field.cell_rows(); ++row) {
      for (std::uint32_t column = 0; column < field.cell_columns(); ++column) {
        if (!is_solid_cell(field, column, row)) continue;
        for (std::uint32_t half = 0; half < 2; ++half) {
          const std::uint32_t id = 2 * (row * field.cell_columns() + column) + half;
          const TriangleView view = view_triangle(field, id);
          names.push_back(id);
          for (const Vec3 corner : view.v) {
            indices.push_back(std::uint32_t(vertices.size()));
            vertices.push_back(corner);
          }
        }
      }
    }
    const Shape shape = shape_of(*made);
    const float half_width = 0.7f * float(columns) / 2.0f;
    int hits = 0;
    for (int i = 0; i < 1500; ++i) {
      DVec3 origin(random.in_box(half_width)), way = DVec3(random.in_box(half_width)) - origin;
      origin.y = double(random.between(-3.0f, 3.0f));
      if (i % 5 == 0) way = {0.0, -2.0 * origin.y, 0.0};
      LocalHit hit, plain;
      const bool found = cast_ray(shape, {origin, way}, 1.0, i % 2 == 0, hit);
      ASSERT_EQ(found, cast_plainly(vertices, indices, {origin, way}, i % 2 == 0, plain)) << i;
      if (!found) continue;
      ++hits;
      ASSERT_NEAR(hit.fraction, plain.fraction, 1.0e-11);
      EXPECT_TRUE(hit.fraction != plain.fraction || hit.triangle == names[plain.triangle]);
    }
    EXPECT_GT(hits, 30);
    // Straight down on every sample and every edge: nothing slips through.
    for (std::uint32_t row = 1; row + 1 < rows; ++row) {
      for (std::uint32_t column = 1; column + 1 < columns; ++column) {
        bool solid = true;
        for (int c = -1; c <= 0; ++c) {
          for (int r = -1; r <= 0; ++r)
            solid = solid && is_solid_cell(field, std::int64_t(column) + c, std::int64_t(row) + r);
        }
        if (!solid) continue;
        const DVec3 at(field.sample(column, row)), beside(field.sample(column - 1, row));
        LocalHit hit;
        EXPECT_TRUE(cast_ray(shape, {{at.x, 3, at.z}, {0, -6, 0}}, 1.0, false, hit));
        EXPECT_TRUE(cast_ray(shape, {{0.5 * (at.x + beside.x), 3, at.z}, {0, -6, 0}}, 1.0, false, hit));
      }
    }
  }
}

}  // namespace
}  // namespace gyre::cast_surface_test
