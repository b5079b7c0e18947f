// The cache of triangles around a shape. See cached_triangles.h.
#include "geometry/manifold_mesh/cached_triangles.h"

#include "base/prefetch.h"

namespace gyre {
namespace {

void find_triangles(const Mesh& mesh, const Aabb& box, CachedTriangles& cache) {
  cache.box = box;
  int count = 0;
  bool for_tree = false;
  const auto enter = [&](std::uint32_t index, int lane) {
    for_tree = for_tree || (mesh.flat_lanes[index] >> lane & 1) != 0;
    return !for_tree;
  };
  const auto visit = [&](std::uint32_t first, std::uint32_t leaf) {
    for (std::uint32_t id = first; id < first + leaf && !for_tree; ++id) {
      if (!overlap(triangle_box(mesh, id), box)) continue;
      for_tree = count == CachedTriangles::kRoom || (mesh.flags[id] & kInsidePatch) != 0;
      if (!for_tree) cache.ids[count++] = id;
    }
  };
  walk_overlaps(mesh.tree, box, enter, visit);
  cache.count = for_tree ? CachedTriangles::kForTree : count;
}

}  // namespace

bool cache_triangles(const Mesh& mesh, const Aabb& box, float margin, CachedTriangles& cache) {
  if (cache.count == CachedTriangles::kUnknown || !contains(cache.box, box))
    find_triangles(mesh, grow(box, margin), cache);
  return cache.count >= 0;
}

void prefetch_triangles(const Mesh& mesh, const CachedTriangles& cache) {
  for (int i = 0; i < cache.count; ++i) {
    const std::size_t id = cache.ids[i];
    __builtin_prefetch(mesh.indices.data() + 3 * id);
    __builtin_prefetch(mesh.normals.data() + id);
    __builtin_prefetch(mesh.twins.data() + 3 * id);
  }
}

}  // namespace gyre
