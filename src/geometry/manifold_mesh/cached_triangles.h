// The triangles of a mesh around a shape, cached between manifold updates. While the shape stays inside the box of the
// cache, the tree is not traversed again, and the triangles can be prefetched.
#pragma once

#include "geometry/shape/mesh.h"

namespace gyre {

struct CachedTriangles {
  static constexpr int kRoom = 24;
  // Instead of a count. kUnknown: nothing is cached. kForTree: the tree must be traversed, because the box has too many
  // triangles or has flat patches, of which one triangle represents many.
  static constexpr std::int32_t kUnknown = -1, kForTree = -2;

  Aabb box;  // in the mesh's frame; the cache has every triangle whose box overlaps it
  std::int32_t count = kUnknown;
  std::uint32_t ids[kRoom];  // ascending; not cleared: only the counted elements are read

  CachedTriangles() {}
};

// Finds the triangles in `box` and `margin` around it, unless the cache already covers `box`. Returns true if the cache
// has all triangles that overlap `box`, false if the tree must be traversed.
bool cache_triangles(const Mesh& mesh, const Aabb& box, float margin, CachedTriangles& cache);

// Prefetches the data of each cached triangle that is read first.
void prefetch_triangles(const Mesh& mesh, const CachedTriangles& cache);

}  // namespace gyre
