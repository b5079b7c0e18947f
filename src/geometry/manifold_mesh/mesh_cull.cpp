// What kernels are given of surfaces, and what is taken from them. See mesh_cull.h.
#include "geometry/manifold_mesh/mesh_cull.h"

namespace gyre {
namespace {

constexpr int kCount = TriangleBatch::kCount;

// A curved core has no columns: it is asked by itself.
void find_extents(const TriangleColumns& triangles, const std::uint32_t* ids, int count, Vec3 position,
                  const LocalConvex& convex, TriangleBatch& out) {
  for (int k = 0; k < kCount; ++k) {
    const std::size_t id = ids[min(k, count - 1)];
    const Vec3 normal = triangles.normals[id], corner = triangles.vertices[triangles.indices[3 * id]];
    const bool turned = triangles.double_sided && dot(normal, convex.center() + position - corner) < 0.0f;
    const LocalConvex::Extent extent = convex.extent(turned ? -normal : normal);
    out.low[k] = extent.low;
    out.high[k] = extent.high;
  }
}

void place(const MeshKernels& kernels, const TriangleColumns& triangles, const std::uint32_t* ids, int count,
           Vec3 position, const LocalConvex& convex, float max_separation, TriangleBatch& out) {
  if (!convex.has_vertices()) find_extents(triangles, ids, count, position, convex, out);
  kernels.place(triangles, ids, count, convex.columns(), position, max_separation, out);
}

}  // namespace

TriangleColumns columns_of(const Mesh& mesh) {
  return {mesh.vertices.data(), mesh.indices.data(), mesh.normals.data(), mesh.double_sided};
}

void load_triangles(const MeshKernels& kernels, const Surface& surface, const std::uint32_t* ids, int count,
                     Vec3 position, const LocalConvex& convex, float max_separation, TriangleBatch& out) {
  if (surface.mesh != nullptr)
    return place(kernels, columns_of(*surface.mesh), ids, count, position, convex, max_separation, out);
  // A field has no such columns: they are made.
  static constexpr std::uint32_t kNumbers[3 * kCount] = {0,  1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11,
                                                         12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23};
  Vec3 corners[3 * kCount], normals[kCount];
  for (int k = 0; k < count; ++k) {
    const BareTriangle t = bare_triangle(*surface.field, ids[k]);
    normals[k] = t.normal;
    for (int i = 0; i < 3; ++i) corners[3 * k + i] = t.v[i];
  }
  place(kernels, {corners, kNumbers, normals, false}, kNumbers, count, position, convex, max_separation, out);
}

LocalTriangle batch_triangle(const Surface& surface, std::uint32_t id, const TriangleBatch& placed,
                           int lane) {
  LocalTriangle t;
  t.turned = (placed.turned >> lane & 1u) != 0;
  if (t.turned) {
    static_cast<TriangleView&>(t) = back_view(surface.triangle(id));
  } else if (surface.mesh != nullptr) {
    view_surroundings(*surface.mesh, id, t);
  } else {
    static_cast<TriangleView&>(t) = view_triangle(*surface.field, id);
  }
  t.normal = placed.normal[lane];
  t.slack = placed.slack[lane];
  for (int i = 0; i < 3; ++i) {
    t.v[i] = placed.corner[i][lane];
    t.along[i] = placed.along[i][lane];
    t.outward[i] = placed.outward[i][lane];
    t.length[i] = placed.length[i][lane];
  }
  return t;
}

}  // namespace gyre
