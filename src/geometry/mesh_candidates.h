// Which triangles of a surface a convex shape may touch: few enough to look at each of them.
//
// Large flat stretches are not walked triangle by triangle: of a part of the tree (or of the pyramid) that lies inside one flat
// patch and has no corner of the shape above it, one triangle stands for all, since nothing but its plane can be touched. If
// there are still too many, as under a large body on finely cut rough ground, space around the body is cut into cells and each
// cell keeps its deepest.
#pragma once

#include "geometry/mesh_axis.h"

namespace gyre {

struct MeshCandidates {
  static constexpr int kRoom = 1024;
  int count = 0;
  std::uint32_t ids[kRoom];  // ascending
};

// `position` is the place of the convex shape's origin in the surface's frame.
void find_candidates(const Surface& surface, const PlacedConvex& convex, Vec3 position, float max_separation,
                     MeshCandidates& out);

}  // namespace gyre
