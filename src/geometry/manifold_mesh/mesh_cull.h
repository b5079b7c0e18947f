// Which triangles of a surface a convex shape may touch, several at a time: most of those whose boxes come near are left out here,
// before any is looked at by itself; the others are placed. What is done is told in mesh_kernels.h.
#pragma once

#include "geometry/manifold_mesh/mesh_axis.h"
#include "geometry/manifold_mesh/mesh_kernels.h"

namespace gyre {

TriangleColumns columns_of(const Mesh& mesh);

// Of `count` triangles, 1 to TriangleBatch::kCount. `position` is the place of the convex shape's origin in the surface's frame.
void load_triangles(const MeshKernels& kernels, const Surface& surface, const std::uint32_t* ids, int count,
                     Vec3 position, const LocalConvex& convex, float max_separation, TriangleBatch& out);

// One of them that may be touched, as measured_triangle() tells it.
LocalTriangle batch_triangle(const Surface& surface, std::uint32_t id, const TriangleBatch& placed, int lane);

}  // namespace gyre
