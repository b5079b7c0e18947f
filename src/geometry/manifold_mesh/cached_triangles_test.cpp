// Cached triangles around a shape that wanders over a mesh: they include all near triangles, and a manifold with the
// cache equals one without.
#include "geometry/manifold_mesh/cached_triangles.h"

#include "geometry/manifold_mesh/mesh_candidates.h"
#include "geometry/testing/mesh_contact_test.h"

#include <gtest/gtest.h>

namespace gyre::cached_triangles_test {
namespace {

using namespace test;

Geometry hills() {
  return grid(6.0f, 1.0f, [](float x, float z) { return 0.5f * std::sin(x) * std::cos(0.7f * z); }).cook();
}

Aabb box_at(Vec3 middle) { return grow({middle, middle}, 0.4f); }

TEST(CachedTriangles, AreAllThatOverlapTheBox) {
  const Geometry ground = hills();
  const Mesh& mesh = *make_shape(ground).mesh;
  Random random;
  CachedTriangles kept;
  Vec3 middle;
  int moves = 0, found_anew = 0;
  for (int round = 0; round < 2000; ++round) {
    middle = 0.98f * (middle + random.in_box(0.2f));
    const Aabb before = kept.box;
    ASSERT_TRUE(cache_triangles(mesh, box_at(middle), 0.3f, kept));
    ++moves;
    found_anew += kept.box == before ? 0 : 1;
    int next = 0;
    for (std::uint32_t id = 0; id < mesh.triangle_count(); ++id) {
      const bool is_kept = next < kept.count && kept.ids[next] == id;
      if (is_kept) ++next;
      ASSERT_TRUE(is_kept || !overlap(triangle_box(mesh, id), box_at(middle)));
    }
    ASSERT_EQ(next, kept.count);
  }
  EXPECT_GT(found_anew, moves / 100);
  EXPECT_LT(found_anew, moves / 2);
}

TEST(CachedTriangles, TooManyAndFlatPatchesAreForTheTree) {
  const Geometry flat = grid(6.0f, 1.0f, [](float, float) { return 0.0f; }).cook();
  const Geometry fine =
      grid(2.0f, 0.1f, [](float x, float z) { return 0.5f * std::sin(x) * std::cos(z); }).cook();
  for (const Geometry& ground : {flat, fine}) {
    CachedTriangles kept;
    EXPECT_FALSE(cache_triangles(*make_shape(ground).mesh, box_at({}), 0.3f, kept));
    const Aabb box = kept.box;
    EXPECT_FALSE(cache_triangles(*make_shape(ground).mesh, box_at({0.1f, 0.0f, 0.1f}), 0.3f, kept));
    EXPECT_EQ(kept.box, box);
  }
}

TEST(CachedTriangles, TheInsideOfAPatchAmongHillsIsForTheTree) {
  // So small that few lanes of the tree lie in one patch; the triangles themselves decide.
  const Geometry ground =
      grid(6.0f, 1.0f, [](float x, float z) {
        return std::fabs(x) <= 2.0f && std::fabs(z) <= 2.0f ? 0.0f : 0.3f + 0.2f * std::sin(x + 2.0f * z);
      }).cook();
  const Mesh& mesh = *make_shape(ground).mesh;
  int inside = 0;
  for (std::uint32_t id = 0; id < mesh.triangle_count(); ++id) {
    if ((mesh.flags[id] & kInsidePatch) == 0) continue;
    ++inside;
    CachedTriangles kept;
    EXPECT_FALSE(cache_triangles(mesh, triangle_box(mesh, id), 0.01f, kept)) << id;
  }
  EXPECT_GT(inside, 0);
}

TEST(CachedTriangles, ChangeNothingOfALook) {
  const Geometry ground = hills();
  const Shape mesh = make_shape(ground);
  const Surface surface(mesh);
  Random random;
  for (const AnyShape& any : all_kinds(random)) {
    const Shape shape = make_shape(any);
    CachedTriangles kept;
    Vec3 middle;
    for (int round = 0; round < 500; ++round) {
      middle = 0.98f * (middle + random.in_box(0.2f));
      const LocalConvex convex(shape, random.rotation());
      MeshCandidates with, without;
      find_candidates(select_mesh_kernels(), surface, convex, middle, 0.1f, &kept, with);
      find_candidates(select_mesh_kernels(), surface, convex, middle, 0.1f, nullptr, without);
      ASSERT_EQ(with.count, without.count);
      for (int i = 0; i < with.count; ++i) ASSERT_EQ(with.ids[i], without.ids[i]);
    }
  }
}

}  // namespace
}  // namespace gyre::cached_triangles_test
