// Which triangles near a convex shape it may touch, four at a time: most of those whose boxes come near are left out here, before
// any is looked at by itself.
//
// Left out is what has all of the shape behind its plane or farther before it than asked, what lies farther before one of the
// shape's faces, and what mesh_apart.h knows to be apart.
#pragma once

#include "geometry/mesh_axis.h"

namespace gyre {

struct MeshCull {
  static constexpr int kLanes = PlacedConvex::kLanes;
  unsigned touchable = 0;  // bits of the triangles that are not left out
  unsigned apart =
      0;  // bits of those that are out of reach of the nearest points too, whatever lies before or behind
  PlacedConvex::Extents extents;  // of the shape's core along the triangles' normals
};

// Of `count` triangles, 1 to MeshCull::kLanes. `position` is the place of the convex shape's origin in the surface's frame.
MeshCull cull_triangles(const Surface& surface, const std::uint32_t* ids, int count, Vec3 position,
                        const PlacedConvex& convex, float max_separation);

}  // namespace gyre
