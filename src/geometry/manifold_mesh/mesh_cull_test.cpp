// Culling of triangles side by side: excluded triangles are too far away, all others have the form of a single
// triangle, and no lane depends on its neighbours or on their number.
#include "geometry/manifold_mesh/mesh_cull.h"

#include "geometry/distance/gjk.h"
#include "geometry/manifold_mesh/mesh_lanes.h"
#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre::mesh_cull_test {
namespace {

using namespace test;

constexpr float kReach = 0.1f;

// True if the triangle is too far from the shape, or if the shape is behind it.
bool is_out_of_reach(const LocalTriangle& t, const LocalConvex& convex) {
  if (convex.highest(t.normal) + convex.radius() <= dot(t.normal, t.v[0]) + 1.0e-5f) return true;
  const DVec3 corners[3] = {DVec3(t.v[0]), DVec3(t.v[1]), DVec3(t.v[2])};
  const CorePair pair(corners, convex.shape(), {}, normalized(to_double(convex.orientation())));
  const CoreDistance found = core_distance(pair, 10.0, t.normal);
  return !found.overlap && found.distance - double(convex.radius()) > double(kReach) - 1.0e-5;
}

// True if both searches find the triangle too far away, so that it can give no contact.
bool is_apart_to_searches(const Surface& surface, const LocalTriangle& t, const LocalConvex& convex) {
  AxisScratch scratch;
  const float face = convex.lowest(t.normal) - convex.radius() - dot(t.normal, t.v[0]);
  return search_axes(surface, t, convex, face, kReach, scratch).best > kReach &&
         search_nearest(surface, t, convex, face, kReach, scratch).best > kReach;
}

bool same(const LocalTriangle& a, const LocalTriangle& b) {
  bool all = a.id == b.id && a.normal == b.normal && a.slack == b.slack && a.flipped == b.flipped &&
             a.flat_corners == b.flat_corners;
  for (int i = 0; i < 3; ++i) {
    all = all && a.v[i] == b.v[i] && a.along[i] == b.along[i] && a.outward[i] == b.outward[i] &&
          a.length[i] == b.length[i] && a.edge[i] == b.edge[i] && a.edge_id[i] == b.edge_id[i] &&
          a.corner_id[i] == b.corner_id[i] && a.neighbor_normal[i] == b.neighbor_normal[i];
  }
  return all;
}

// Invariants of one triangle of a batch.
void check_lane(const Surface& surface, std::uint32_t id, const TriangleBatch& placed, int lane,
                Vec3 position, const LocalConvex& convex) {
  const LocalTriangle t = measured_triangle(surface, id, position, convex);
  const LocalConvex::Extent extent = convex.extent(t.normal);
  ASSERT_EQ(placed.low[lane], extent.low);
  ASSERT_EQ(placed.high[lane], extent.high);
  const bool touchable = (placed.touchable >> lane & 1u) != 0, apart = (placed.apart >> lane & 1u) != 0;
  ASSERT_TRUE(touchable ? same(t, batch_triangle(surface, id, placed, lane)) : is_out_of_reach(t, convex));
  ASSERT_TRUE(!apart || is_apart_to_searches(surface, t, convex));
  TriangleBatch alone;
  load_triangles(mesh_kernels<4>(), surface, &id, 1, position, convex, kReach, alone);
  ASSERT_EQ(alone.touchable, touchable ? 1u : 0u);
  ASSERT_EQ(alone.apart, apart ? 1u : 0u);
  ASSERT_TRUE(!touchable || same(t, batch_triangle(surface, id, alone, 0)));
}

void check(const Geometry& ground, Random& random) {
  const Shape shape = make_shape(ground);
  const Surface surface(shape);
  int kept = 0, left_out = 0;
  for (const AnyShape& any : all_kinds(random)) {
    const Shape other = make_shape(any);
    for (int round = 0; round < 40; ++round) {
      const Vec3 position = random.in_box(2.0f);
      const LocalConvex convex(other, random.rotation());
      // Also with fewer triangles than lanes.
      const int count = 1 + round % TriangleBatch::kCount;
      for (std::uint32_t first = 0; first + 8 <= 128; first += std::uint32_t(count)) {
        std::uint32_t ids[TriangleBatch::kCount];
        for (int lane = 0; lane < count; ++lane) ids[lane] = first + std::uint32_t(lane);
        TriangleBatch placed;
        load_triangles(select_mesh_kernels(), surface, ids, count, position, convex, kReach, placed);
        ASSERT_EQ((placed.touchable | placed.apart) >> count, 0u);
        for (int lane = 0; lane < count; ++lane) {
          check_lane(surface, ids[lane], placed, lane, position, convex);
          ++((placed.touchable >> lane & 1u) != 0 ? kept : left_out);
        }
      }
    }
  }
  EXPECT_GT(kept, 1000);
  EXPECT_GT(left_out, 1000);
}

float bumpy(float x, float z) { return 0.3f * std::sin(2.0f * x) * std::cos(3.0f * z); }

TEST(MeshCull, LeavesOutOnlyWhatAMeshHasOutOfReach) {
  Random random{3};
  check(grid(2.0f, 0.5f, bumpy).cook(), random);
}

TEST(MeshCull, LeavesOutOnlyWhatATwoSidedMeshHasOutOfReach) {
  Random random{4};
  check(grid(2.0f, 0.5f, bumpy).cook(true), random);
}

TEST(MeshCull, LeavesOutOnlyWhatAHeightFieldHasOutOfReach) {
  Random random{5};
  std::vector<float> heights;
  for (int j = 0; j < 9; ++j) {
    for (int i = 0; i < 9; ++i) heights.push_back(bumpy(0.5f * float(i), 0.5f * float(j)));
  }
  const Result<Geometry> field =
      cook_height_field({.heights = heights, .columns = 9, .rows = 9, .spacing = 0.5f});
  ASSERT_TRUE(field.has_value());
  check(*field, random);
}

// Four lanes, the widest kernel of the machine and the scalar test find the same triangles.
TEST(MeshCull, BoxesAreNearToAllKernels) {
  Random random{6};
  const Geometry ground = grid(2.0f, 0.5f, bumpy).cook();
  const Shape shape = make_shape(ground);
  const Mesh& mesh = *shape.mesh;
  int near = 0, far = 0;
  for (const AnyShape& any : all_kinds(random)) {
    const Shape other = make_shape(any);
    for (int round = 0; round < 400; ++round) {
      const Vec3 position = random.in_box(2.0f), middle = position + random.in_box(0.1f);
      const LocalConvex convex(other, random.rotation());
      const Aabb body{convex.box().low + position, convex.box().high + position};
      const NearBoxes boxes{grow(body, kReach), grow({middle, middle}, 0.05f), position, kReach};
      std::uint32_t ids[24];
      const int count = 1 + int(random.unit() * 23.0f);
      for (int i = 0; i < count; ++i) ids[i] = std::uint32_t(random.unit() * 127.0f);
      const std::uint32_t bits =
          select_mesh_kernels().find_near(columns_of(mesh), ids, count, convex.columns(), boxes);
      ASSERT_EQ(bits, mesh_kernels<4>().find_near(columns_of(mesh), ids, count, convex.columns(), boxes));
      for (int i = 0; i < count; ++i) {
        const AxisBox box(triangle_box(mesh, ids[i]));
        const bool counts = box.overlaps(AxisBox(boxes.outer)) &&
                            (box.overlaps(AxisBox(boxes.inner)) || convex.can_touch(box - position, kReach));
        ASSERT_EQ(counts, (bits >> i & 1u) != 0);
        ++(counts ? near : far);
      }
      ASSERT_EQ(std::uint64_t(bits) >> count, 0u);
    }
  }
  EXPECT_GT(near, 500);
  EXPECT_GT(far, 500);
}

}  // namespace
}  // namespace gyre::mesh_cull_test
