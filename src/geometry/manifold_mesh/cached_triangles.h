// The triangles of a mesh around a shape, kept from look to look: while the shape stays inside the box for which they were
// found, the tree need not be asked again, and where they lie in memory is known before they are read.
#pragma once

#include "geometry/shape/mesh.h"

namespace gyre {

struct CachedTriangles {
  static constexpr int kRoom = 24;
  // In place of a count: nothing is known; what is in the box is for the tree, since it is too much, or flat patches of which one
  // triangle stands for many.
  static constexpr std::int32_t kUnknown = -1, kForTree = -2;

  Aabb box;  // in the mesh's frame: every triangle whose box overlaps it is here
  std::int32_t count = kUnknown;
  std::uint32_t ids[kRoom];  // ascending; not cleared: only the counted ones are ever read

  CachedTriangles() {}
};

// Finds them anew, in `box` and `margin` around it, where they are not those of a box around `box`. Returns whether they are all
// that overlap `box`; else the tree knows.
bool cache_triangles(const Mesh& mesh, const Aabb& box, float margin, CachedTriangles& kept);

// Asks for what is read first of each of them.
void prefetch_triangles(const Mesh& mesh, const CachedTriangles& kept);

}  // namespace gyre
