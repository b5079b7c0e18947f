// Which triangles of a surface a convex shape may touch, several at a time: most of those whose boxes come near are left out here,
// before any is looked at by itself; the others are placed. What is done is told in mesh_kernels.h.
#pragma once

#include "geometry/manifold_mesh/mesh_axis.h"
#include "geometry/manifold_mesh/mesh_kernels.h"

namespace gyre {

TriangleColumns columns_of(const Mesh& mesh);

// Of `count` triangles, 1 to PlacedTriangles::kCount. `position` is the place of the convex shape's origin in the surface's frame.
void place_triangles(const MeshKernels& kernels, const Surface& surface, const std::uint32_t* ids, int count,
                     Vec3 position, const PlacedConvex& convex, float max_separation, PlacedTriangles& out);

// One of them that may be touched, as near_triangle() tells it.
NearTriangle take_triangle(const Surface& surface, std::uint32_t id, const PlacedTriangles& placed, int lane);

}  // namespace gyre
