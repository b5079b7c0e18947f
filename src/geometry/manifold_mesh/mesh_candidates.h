// The triangles of a surface that a convex shape may touch: few enough to test each of them.
//
// Large flat areas are not traversed triangle by triangle. If a node of the tree (or of the pyramid) lies inside one
// flat patch and no corner of the shape is above it, one triangle represents the whole node, because the shape can
// touch nothing but its plane. If too many triangles remain, as under a large body on finely divided rough ground, the
// space around the body is divided into cells, and each cell contributes its deepest triangles.
#pragma once

#include "geometry/manifold_mesh/cached_triangles.h"
#include "geometry/manifold_mesh/mesh_axis.h"
#include "geometry/manifold_mesh/mesh_kernels.h"

namespace gyre {

struct MeshCandidates {
  static constexpr int kRoom = 1152;
  int count = 0;
  std::uint32_t ids[kRoom];  // ascending
  // Flat patches that the shape penetrates deeper than the margin, one triangle for each plane.
  static constexpr int kPatchRoom = 16;
  int deep_patch_count = 0;
  std::uint32_t deep_patches[kPatchRoom];
};

// `position` is the origin of the convex shape in the surface's frame. `cache`, if not null, has the triangles of a
// mesh from the last update; it never changes the result.
void find_candidates(const MeshKernels& kernels, const Surface& surface, const LocalConvex& convex,
                     Vec3 position, float max_separation, CachedTriangles* cache, MeshCandidates& out);

// The triangles whose boxes overlap a box in the surface's frame, ascending by their index in the tree or pyramid.
// Triangles that do not fit into `out` are dropped. Returns the number written.
int find_triangles(const Surface& surface, const Aabb& box, std::span<std::uint32_t> out);

// True if the box of any triangle overlaps a box in the surface's frame.
bool has_triangle(const Surface& surface, const Aabb& box);

}  // namespace gyre
