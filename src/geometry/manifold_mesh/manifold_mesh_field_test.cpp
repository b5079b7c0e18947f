// Height fields, dense and rough ground: equal results from both kinds of surface, and bounded work.
#include "geometry/manifold_mesh/manifold_mesh.h"
#include "geometry/manifold_mesh/mesh_candidates.h"
#include "geometry/shape/cooked.h"
#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::manifold_mesh_field_test {
namespace {

using namespace test;

struct Ground {
  Geometry field, mesh;
};

// The same heights as a height field and as a mesh.
template <class Height>
Ground make_ground(std::uint32_t n, float spacing, Height&& height) {
  std::vector<float> heights;
  Triangles triangles;
  const float half = 0.5f * float(n - 1) * spacing;
  for (std::uint32_t row = 0; row < n; ++row) {
    for (std::uint32_t column = 0; column < n; ++column) {
      const float x = -half + float(column) * spacing, z = -half + float(row) * spacing;
      heights.push_back(height(x, z));
      triangles.vertex({x, heights.back(), z});
    }
  }
  const auto missing = [&](std::uint32_t i) { return heights[i] != heights[i]; };
  for (std::uint32_t row = 0; row + 1 < n; ++row) {
    for (std::uint32_t column = 0; column + 1 < n; ++column) {
      const std::uint32_t a = row * n + column, b = a + 1, c = a + n, d = c + 1;
      if (missing(a) || missing(b) || missing(c) || missing(d)) continue;
      triangles.triangle(a, c, b);
      triangles.triangle(b, c, d);
    }
  }
  for (Vec3& v : triangles.vertices) {
    if (!is_finite(v)) v = {};
  }
  Result<Geometry> field =
      cook_height_field({.heights = heights, .columns = n, .rows = n, .spacing = spacing});
  EXPECT_TRUE(field.has_value()) << field.error().message;
  return {field ? *field : Geometry(), triangles.cook()};
}

void expect_same(const Manifolds& a, const Manifolds& b, bool also_normals = true) {
  ASSERT_EQ(a.count, b.count);
  for (int i = 0; i < a.count && also_normals; ++i) {
    const LocalManifold* other = b.along(a.all[i].normal, 1.0e-4f);
    ASSERT_NE(other, nullptr);
  }
  EXPECT_NEAR(a.deepest(), b.deepest(), 2.0e-5f);
}

// If the test of boxes rules a pair out, the test of triangles finds no contact; and it rules out more than distant
// pairs.
TEST(CollideHeightField, NothingTouchesWhatIsClearOfTheSurface) {
  const Ground hills =
      make_ground(24, 0.4f, [](float x, float z) { return std::sin(x) * std::cos(1.3f * z); });
  Random random{7};
  int clear = 0, near = 0;
  for (int round = 0; round < 200; ++round) {
    for (const AnyShape& shape : all_kinds(random)) {
      const Transform pose{{random.between(-4, 4), random.between(-3, 4), random.between(-4, 4)},
                           random.rotation()};
      const float reach = random.between(0.01f, 0.6f);
      for (const Geometry& ground : {hills.mesh, hills.field}) {
        const Shape surface = make_shape(ground), convex = make_shape(shape);
        const bool is_clear = is_clear_of_surface(surface, convex, pose, reach);
        EXPECT_EQ(is_clear, is_clear_of_surface(convex, surface, inverse(pose), 0.999f * reach) && is_clear);
        const int contacts = collide(ground, shape, pose, reach).count;
        EXPECT_TRUE(!is_clear || contacts == 0);
        clear += is_clear ? 1 : 0;
        near += contacts == 0 && !is_clear ? 1 : 0;
      }
    }
  }
  EXPECT_GT(clear, near);
  EXPECT_FALSE(is_clear_of_surface(make_shape(Sphere{1}), make_shape(Sphere{1}), {{9, 0, 0}, {}}, 0.0f));
}

TEST(CollideHeightField, EqualsTheSameGroundAsAMesh) {
  Random random{83};
  const std::vector<AnyShape> kinds = all_kinds(random);
  for (const float roughness : {0.0f, 0.1f, 0.4f}) {
    const Ground ground = make_ground(17, 0.5f, [&](float x, float z) {
      return roughness == 0.0f ? 0.25f * x - 0.5f * z : random.between(0.0f, roughness);
    });
    int touching = 0;
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      for (int i = 0; i < 80; ++i) {
        SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", kind " << kind << ", pose " << i);
        Transform pose{{random.between(-3, 3), 0.0f, random.between(-3, 3)}, random.rotation()};
        const float level =
            roughness == 0.0f ? 0.25f * pose.position.x - 0.5f * pose.position.z : 0.7f * roughness;
        pose.position.y = level + random.between(0.0f, 0.1f) - lowest_point(kinds[kind], pose);
        const Manifolds a = collide(ground.field, kinds[kind], pose),
                        b = collide(ground.mesh, kinds[kind], pose);
        // Among equally good directions on curved shapes that of the first triangle wins, and the order differs.
        const bool curved = kind == 5 || kind == 6;
        expect_same(a, b, !curved);
        touching += a.count > 0;
      }
    }
    EXPECT_GT(touching, 50);
  }
}

TEST(CollideHeightField, SlidesOverFlatFieldsWithoutGhosts) {
  const Ground ground = make_ground(65, 0.37f, [](float, float) { return 0.0f; });
  for (const AnyShape& shape : {AnyShape(Box{{0.5f, 0.5f, 0.5f}}), AnyShape(Sphere{0.5f})}) {
    std::uint32_t name = 0;
    for (int step = 0; step < 200; ++step) {
      const Transform pose{{-8.0f + 0.08f * float(step), 0.5f - 1.0e-4f, -3.0f + 0.017f * float(step)}, {}};
      const Manifolds found = collide(ground.field, shape, pose);
      ASSERT_EQ(found.count, 1);
      EXPECT_EQ(found.all[0].normal, kUp);
      EXPECT_EQ(found.points(), shape.index() == 0 ? 1 : 4);
      EXPECT_NEAR(found.deepest(), -1.0e-4f, 1.0e-6f);
      const bool same_name = found.all[0].points[0].feature == name;
      EXPECT_TRUE(step == 0 || shape.index() != 0 || same_name);
      name = found.all[0].points[0].feature;
    }
  }
}

TEST(CollideHeightField, HolesAreOpen) {
  const Ground ground = make_ground(17, 1.0f, [](float x, float z) {
    return std::fabs(x) < 1.5f && std::fabs(z) < 1.5f ? std::nanf("") : 0.0f;
  });
  // The hole reaches from -2 to 2. A ball in its middle falls, one over the rim rests on it.
  EXPECT_EQ(collide(ground.field, Sphere{0.5f}, {{0.0f, 0.3f, 0.0f}, {}}).count, 0);
  EXPECT_EQ(collide(ground.field, Box{{1.9f, 0.5f, 1.9f}}, {{0.0f, 0.3f, 0.0f}, {}}).count, 0);
  EXPECT_EQ(collide(ground.field, Box{{2.5f, 0.5f, 0.5f}}, {{0.0f, 0.499f, 0.0f}, {}}).points(), 4);
  const Manifolds rim = collide(ground.field, Sphere{0.5f}, {{1.9f, 0.48f, 0.0f}, {}});
  ASSERT_EQ(rim.count, 1);
  EXPECT_LT(rim.all[0].normal.x, -0.1f);
}

TEST(CollideHeightField, BordersAndTheLastCell) {
  for (const std::uint32_t n : {2u, 3u, 6u, 9u}) {
    const Ground ground = make_ground(n, 1.0f, [](float, float) { return 0.0f; });
    const float half = 0.5f * float(n - 1);
    for (const float x : {-half, half}) {
      for (const float z : {-half, half}) {
        SCOPED_TRACE(testing::Message() << n << " samples, corner " << x << ", " << z);
        const Manifolds box = collide(ground.field, Box{{0.3f, 0.3f, 0.3f}}, {{x, 0.299f, z}, {}});
        ASSERT_EQ(box.count, 1);
        EXPECT_EQ(box.all[0].normal, kUp);
        EXPECT_EQ(box.points(), 4);
        for (int k = 0; k < 4; ++k) {
          EXPECT_LE(std::fabs(box.all[0].points[k].position.x), half + 1.0e-5f);
          EXPECT_LE(std::fabs(box.all[0].points[k].position.z), half + 1.0e-5f);
        }
        expect_same(box, collide(ground.mesh, Box{{0.3f, 0.3f, 0.3f}}, {{x, 0.299f, z}, {}}));
        EXPECT_EQ(collide(ground.field, Sphere{0.5f}, {{x, 0.499f, z}, {}}).points(), 1);
        EXPECT_EQ(collide(ground.field, Sphere{0.5f}, {{1.6f * x, 0.499f, 1.6f * z}, {}}).points(), 0);
      }
    }
  }
}

// --------------------------------------------------------------------------------------------------- bounded work

int candidate_count(const Geometry& ground, const AnyShape& any, const Transform& pose) {
  const Shape mesh = make_shape(ground), shape = make_shape(any);
  const Surface surface(mesh);
  const LocalConvex convex(shape, pose.orientation);
  MeshCandidates candidates;
  find_candidates(select_mesh_kernels(), surface, convex, pose.position, kMargin, nullptr, candidates);
  return candidates.count;
}

TEST(CollideDenseGround, ALargeBodyOnFinelyCutFlatGroundLooksAtFewTriangles) {
  // 5 m on cells of 1 cm: 500,000 triangles lie under it.
  const Ground ground = make_ground(601, 0.01f, [](float, float) { return 0.0f; });
  for (const Geometry& geometry : {ground.field, ground.mesh}) {
    for (int i = 0; i < 40; ++i) {
      for (const float depth : {1.0e-4f, 5.0e-3f, 0.05f}) {
        const Transform pose{{0.0137f * float(i) - 0.3f, 0.5f - depth, 0.0071f * float(i)},
                             from_axis_angle(kUp, 0.003f * float(i))};
        const AnyShape box = Box{{2.5f, 0.5f, 2.5f}};
        EXPECT_LT(candidate_count(geometry, box, pose), 400);
        const Manifolds found = collide(geometry, box, pose);
        ASSERT_EQ(found.count, 1);
        EXPECT_EQ(found.all[0].normal, kUp);
        EXPECT_EQ(found.points(), 4);
        for (int k = 0; k < 4; ++k) EXPECT_NEAR(found.all[0].points[k].separation, -depth, 1.0e-5f);
      }
    }
    const Manifolds ball = collide(geometry, Sphere{2.0f}, {{0.1f, 1.999f, 0.2f}, {}});
    ASSERT_EQ(ball.points(), 1);
    EXPECT_EQ(ball.all[0].normal, kUp);
  }
}

TEST(CollideDenseGround, ALargeBodyOnFinelyCutRoughGroundKeepsTheDeepest) {
  Random random{89};
  const Ground ground = make_ground(401, 0.01f, [&](float, float) { return random.between(-0.01f, 0.0f); });
  for (const Geometry& geometry : {ground.field, ground.mesh}) {
    for (const float depth : {1.0e-3f, 5.0e-3f}) {
      const Transform pose{{0.02f, 0.5f - depth, 0.03f}, {}};
      const AnyShape box = Box{{1.5f, 0.5f, 1.5f}};
      EXPECT_LE(candidate_count(geometry, box, pose), MeshCandidates::kRoom);
      const Manifolds found = collide(geometry, box, pose);
      ASSERT_GE(found.count, 1);
      // Peaks reach up to 0: the deepest is that deep, and the points span the box.
      EXPECT_NEAR(found.deepest(), -depth, 1.0e-3f);
      ASSERT_NE(found.along(kUp, 0.05f), nullptr);
      Vec3 low{9, 9, 9}, high{-9, -9, -9};
      for (int m = 0; m < found.count; ++m) {
        for (int k = 0; k < found.all[m].count; ++k) {
          low = min(low, found.all[m].points[k].position);
          high = max(high, found.all[m].points[k].position);
        }
      }
      EXPECT_GT(high.x - low.x, 1.5f);
      EXPECT_GT(high.z - low.z, 1.5f);
    }
  }
}

TEST(CollideRoughGround, NothingIsPushedDownOrFarther) {
  // Any kind, any pose, any ground: normals point out of the ground, and no contact is deeper than the body.
  Random random{97};
  const std::vector<AnyShape> kinds = all_kinds(random);
  for (const float roughness : {0.05f, 0.3f}) {
    const Ground ground =
        make_ground(33, 0.25f, [&](float, float) { return random.between(-roughness, 0.0f); });
    for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
      for (int i = 0; i < 150; ++i) {
        SCOPED_TRACE(testing::Message() << "roughness " << roughness << ", kind " << kind << ", pose " << i);
        Transform pose{{random.between(-3, 3), 0.0f, random.between(-3, 3)}, random.rotation()};
        const float gap = random.between(-roughness, 0.01f);
        pose.position.y = gap - lowest_point(kinds[kind], pose);
        const Manifolds found = collide(ground.mesh, kinds[kind], pose);
        for (int m = 0; m < found.count; ++m) {
          EXPECT_GT(found.all[m].normal.y, 0.1f);
          for (int k = 0; k < found.all[m].count; ++k) {
            const ManifoldPoint& p = found.all[m].points[k];
            // Directions of cylinders and cones are searched, and deep bodies leave along faces that lean.
            EXPECT_GT(p.separation, (gap > 0.0f ? gap : 1.2f * gap) - 3.0e-3f);
            EXPECT_LT(length(p.position - pose.position), 1.2f);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace gyre::manifold_mesh_field_test
