// Which triangles of a surface a convex shape may touch: few enough to look at each of them.
//
// Large flat stretches are not walked triangle by triangle: of a part of the tree (or of the pyramid) that lies inside one flat
// patch and has no corner of the shape above it, one triangle stands for all, since nothing but its plane can be touched. If
// there are still too many, as under a large body on finely cut rough ground, space around the body is cut into cells and each
// cell keeps its deepest.
#pragma once

#include "geometry/manifold_mesh/cached_triangles.h"
#include "geometry/manifold_mesh/mesh_axis.h"
#include "geometry/manifold_mesh/mesh_kernels.h"

namespace gyre {

struct MeshCandidates {
  static constexpr int kRoom = 1152;
  int count = 0;
  std::uint32_t ids[kRoom];  // ascending
  // Flat patches through which the shape reaches deeper than the margin, one triangle for each plane.
  static constexpr int kPatchRoom = 16;
  int deep_patch_count = 0;
  std::uint32_t deep_patches[kPatchRoom];
};

// `position` is the place of the convex shape's origin in the surface's frame. `kept`, if it is not null: what is kept of a mesh
// from one look of this shape at it to the next. What is found is the same with it and without it.
void find_candidates(const MeshKernels& kernels, const Surface& surface, const LocalConvex& convex,
                     Vec3 position, float max_separation, CachedTriangles* kept, MeshCandidates& out);

// The triangles whose boxes overlap a box in the surface's frame, ascending by their place in the tree or pyramid; those
// that do not fit into `out` are left out. Returns how many were written.
int find_triangles(const Surface& surface, const Aabb& box, std::span<std::uint32_t> out);

// Whether the box of any triangle overlaps a box in the surface's frame.
bool has_triangle(const Surface& surface, const Aabb& box);

}  // namespace gyre
