// Culling four triangles at a time: what is left out is out of reach, and a lane does not depend on its neighbours.
#include "geometry/mesh_cull.h"

#include "geometry/gjk.h"
#include "geometry/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre {
namespace {

using namespace test;

constexpr float kReach = 0.1f;

// Whether the triangle is farther from the shape than it may be, or has all of it behind.
bool is_out_of_reach(const NearTriangle& t, const PlacedConvex& convex) {
  if (convex.highest(t.normal) + convex.radius() <= dot(t.normal, t.v[0]) + 1.0e-5f) return true;
  const DVec3 corners[3] = {DVec3(t.v[0]), DVec3(t.v[1]), DVec3(t.v[2])};
  const CorePair pair(corners, convex.shape(), {}, normalized(to_double(convex.orientation())));
  const CoreDistance found = core_distance(pair, 10.0, t.normal);
  return !found.overlap && found.distance - double(convex.radius()) > double(kReach) - 1.0e-5;
}

// Whether both searches find what is known to be apart out of reach, and so have no say in any contact.
bool is_apart_to_searches(const Surface& surface, const NearTriangle& t, const PlacedConvex& convex) {
  AxisScratch scratch;
  const float face = convex.lowest(t.normal) - convex.radius() - dot(t.normal, t.v[0]);
  return search_axes(surface, t, convex, face, kReach, scratch).best > kReach &&
         search_nearest(surface, t, convex, face, kReach, scratch).best > kReach;
}

void check(const Geometry& ground, Random& random) {
  const Shape shape = make_shape(ground);
  const Surface surface(shape);
  int kept = 0, left_out = 0;
  for (const AnyShape& any : all_kinds(random)) {
    const Shape other = make_shape(any);
    for (int round = 0; round < 40; ++round) {
      const Vec3 position = random.in_box(2.0f);
      const PlacedConvex convex(other, random.rotation());
      for (std::uint32_t first = 0; first + 4 <= 128; first += 4) {
        const std::uint32_t ids[4] = {first, first + 1, first + 2, first + 3};
        const MeshCull cull = cull_triangles(surface, ids, 4, position, convex, kReach);
        for (int lane = 0; lane < 4; ++lane) {
          const NearTriangle t = near_triangle(surface, ids[lane], position, convex);
          const PlacedConvex::Extent extent = convex.extent(t.normal);
          ASSERT_EQ(cull.extents[lane].low, extent.low);
          ASSERT_EQ(cull.extents[lane].high, extent.high);
          const bool touchable = (cull.touchable >> lane & 1u) != 0;
          const MeshCull alone = cull_triangles(surface, ids + lane, 1, position, convex, kReach);
          ASSERT_EQ(alone.touchable, touchable ? 1u : 0u);
          ASSERT_EQ(alone.apart, cull.apart >> lane & 1u);
          ASSERT_TRUE(touchable || is_out_of_reach(t, convex));
          const bool apart = (cull.apart >> lane & 1u) != 0;
          ASSERT_TRUE(!apart || is_apart_to_searches(surface, t, convex));
          ++(touchable ? kept : left_out);
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

}  // namespace
}  // namespace gyre
