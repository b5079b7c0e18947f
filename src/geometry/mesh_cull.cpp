// Triangles side by side. See mesh_cull.h. Numbers are rounded as place_triangle and what follows it rounds them.
#include "geometry/mesh_cull.h"

#include "geometry/mesh_apart.h"

namespace gyre {
namespace {

constexpr int kLanes = MeshCull::kLanes;
using Floats = Wide<kLanes>;
using Vectors = Vec3W<kLanes>;

TriangleLanes gather(const Mesh& mesh, const std::uint32_t (&ids)[kLanes]) {
  TriangleLanes out;
  const Vec3* const normals = mesh.normals.data();
  const Vec3* const vertices = mesh.vertices.data();
  const std::uint32_t* index[kLanes];
  for (int k = 0; k < kLanes; ++k) index[k] = mesh.indices.data() + 3 * std::size_t(ids[k]);
  out.normal = side_by_side(normals[ids[0]], normals[ids[1]], normals[ids[2]], normals[ids[3]]);
  GYRE_UNROLL
  for (int i = 0; i < 3; ++i) {
    out.corner[i] = side_by_side(vertices[index[0][i]], vertices[index[1][i]], vertices[index[2][i]],
                                 vertices[index[3][i]]);
  }
  return out;
}

TriangleLanes gather(const HeightField& field, const std::uint32_t (&ids)[kLanes]) {
  TriangleLanes out;
  const BareTriangle a = bare_triangle(field, ids[0]), b = bare_triangle(field, ids[1]),
                     c = bare_triangle(field, ids[2]), d = bare_triangle(field, ids[3]);
  out.normal = side_by_side(a.normal, b.normal, c.normal, d.normal);
  for (int i = 0; i < 3; ++i) out.corner[i] = side_by_side(a.v[i], b.v[i], c.v[i], d.v[i]);
  return out;
}

TriangleLanes place(const Surface& surface, const std::uint32_t (&ids)[kLanes], Vec3 position,
                    const PlacedConvex& convex) {
  TriangleLanes t = surface.mesh != nullptr ? gather(*surface.mesh, ids) : gather(*surface.field, ids);
  if (surface.double_sided()) {
    const Vectors middle = splat<kLanes>(convex.center() + position);
    const Mask<kLanes> turned = dot(t.normal, middle - t.corner[0]) < Floats(0.0f);
    const Vectors second = t.corner[1];
    t.corner[1] = select(turned, t.corner[2], second);
    t.corner[2] = select(turned, second, t.corner[2]);
    t.normal = select(turned, -t.normal, t.normal);
  }
  t.reach = largest(absolute(position));
  for (Vectors& corner : t.corner) {
    t.reach = max(t.reach, largest(absolute(corner)));
    corner = corner - splat<kLanes>(position);
  }
  return t;
}

}  // namespace

MeshCull cull_triangles(const Surface& surface, const std::uint32_t* ids, int count, Vec3 position,
                        const PlacedConvex& convex, float max_separation) {
  std::uint32_t lane_ids[kLanes];
  for (int k = 0; k < kLanes; ++k) lane_ids[k] = ids[min(k, count - 1)];
  const TriangleLanes t = place(surface, lane_ids, position, convex);
  MeshCull out;
  out.extents = convex.extents(t.normal);
  const Floats height = dot(t.normal, t.corner[0]), radius(convex.radius());
  const Floats before = out.extents.low - height - radius;
  const Mask<kLanes> behind = out.extents.high - height + radius <= Floats(0.0f);
  const unsigned counted = (1u << count) - 1u;
  out.touchable = to_bits(~(behind | (before > Floats(max_separation)))) & counted;
  out.apart = to_bits(before > Floats(max_separation) + apart_slack(t, convex)) & counted;
  if (out.touchable == 0) return out;
  const unsigned apart = to_bits(is_apart(t, convex, max_separation));
  // Only of lanes that were still in question, so that none depends on its neighbours.
  out.apart |= apart & out.touchable;
  out.touchable &= ~apart;
  return out;
}

}  // namespace gyre
