// Triangles that the kernel finds apart are apart for the searches too, for triangles of all sizes and thin ones.
#include "geometry/manifold_mesh/mesh_apart_lanes.h"

#include "geometry/manifold_mesh/mesh_axis.h"
#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre::mesh_apart_test {
namespace {

using namespace test;

constexpr float kReach = 0.1f;

TriangleLanes<4> lanes_of(const LocalTriangle& t, Vec3 position) {
  TriangleLanes<4> lanes;
  float reach = largest(absolute(position));
  for (int i = 0; i < 3; ++i) {
    lanes.corner[i] = splat<4>(t.v[i]);
    reach = max(reach, largest(absolute(t.v[i] + position)));
  }
  lanes.normal = splat<4>(t.normal);
  lanes.max_coordinate = Wide<4>(reach);
  return lanes;
}

TEST(MeshApart, WhatIsApartIsFoundApart) {
  Random random{7};
  Triangles triangles;
  for (int i = 0; i < 600; ++i) {
    const Vec3 middle = random.in_box(1.0f);
    const float size = std::pow(10.0f, random.between(-1.5f, 1.5f));
    const Vec3 a = middle + random.in_box(size), b = middle + random.in_box(size);
    const bool thin = i % 5 == 0;
    const Vec3 c =
        thin ? lerp(a, b, random.unit()) + random.in_box(0.01f * size) : middle + random.in_box(size);
    const std::uint32_t first = triangles.vertex(a);
    triangles.vertex(b), triangles.vertex(c);
    triangles.triangle(first, first + 1, first + 2);
  }
  const Geometry ground = triangles.cook();
  const Shape shape = make_shape(ground);
  const Surface surface(shape);
  int apart = 0, known = 0;
  for (const AnyShape& any : all_kinds(random)) {
    const Shape other = make_shape(any);
    for (int round = 0; round < 10; ++round) {
      const Vec3 position = random.in_box(1.5f);
      const LocalConvex convex(other, random.rotation());
      for (std::uint32_t id = 0; id < surface.mesh->triangle_count(); ++id) {
        const LocalTriangle t = measured_triangle(surface, id, position, convex);
        const float face = convex.lowest(t.normal) - dot(t.normal, t.v[0]) - convex.radius();
        if (face > kReach) continue;
        AxisScratch scratch;
        const bool found = search_axes(surface, t, convex, face, kReach, scratch).best > kReach;
        const bool told = to_bits(is_apart<4>(lanes_of(t, position), convex.columns(), kReach)) != 0;
        ASSERT_TRUE(!told || found);
        ASSERT_TRUE(!told || search_nearest(surface, t, convex, face, kReach, scratch).best > kReach);
        if (!convex.has_vertices()) continue;
        apart += found ? 1 : 0;
        known += told ? 1 : 0;
      }
    }
  }
  // The search must decide only a few triangles close to the bound, and pairs of edges of hulls.
  EXPECT_GT(known, apart * 9 / 10);
}

}  // namespace
}  // namespace gyre::mesh_apart_test
