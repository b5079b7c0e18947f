// Culling of the triangles of a surface against a convex shape, several at a time. Most triangles whose boxes are near
// are excluded before any is tested by itself; the others become local triangles. mesh_kernels.h describes the tests.
#pragma once

#include "geometry/manifold_mesh/mesh_axis.h"
#include "geometry/manifold_mesh/mesh_kernels.h"

namespace gyre {

TriangleColumns columns_of(const Mesh& mesh);

// Loads `count` triangles, 1 to TriangleBatch::kCount. `position` is the origin of the convex shape in the surface's
// frame.
void load_triangles(const MeshKernels& kernels, const Surface& surface, const std::uint32_t* ids, int count,
                    Vec3 position, const LocalConvex& convex, float max_separation, TriangleBatch& out);

// One triangle of a batch that may be touched, equal to the result of measured_triangle().
LocalTriangle batch_triangle(const Surface& surface, std::uint32_t id, const TriangleBatch& batch, int lane);

}  // namespace gyre
