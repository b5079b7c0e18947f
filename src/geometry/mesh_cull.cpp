// Triangles side by side. See mesh_cull.h. Numbers are rounded as place_triangle and what follows it rounds them.
#include "geometry/mesh_cull.h"

namespace gyre {
namespace {

constexpr int kLanes = MeshCull::kLanes;
using Floats = Wide<kLanes>;
using Vectors = Vec3W<kLanes>;

// Seen from the shape's origin; of a double-sided surface the side on which the shape's middle lies.
struct TriangleLanes {
  Vectors corner[3], normal;
  Floats reach;  // the largest coordinate in the surface's frame, of corners and shape
};

Vectors side_by_side(Vec3 a, Vec3 b, Vec3 c, Vec3 d) {
  // Not by way of an array: GCC would build that on the stack, part by part.
  typedef float Quad __attribute__((vector_size(16)));
  return {Floats::of(Quad{a.x, b.x, c.x, d.x}), Floats::of(Quad{a.y, b.y, c.y, d.y}),
          Floats::of(Quad{a.z, b.z, c.z, d.z})};
}

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

// Whether a ball or capsule lies certainly too far beyond one of the triangle's sides.
Mask<kLanes> is_beside(const TriangleLanes& t, const PlacedConvex& convex, float max_separation) {
  const Vectors first = splat<kLanes>(convex.vertex(0)),
                last = splat<kLanes>(convex.vertex(convex.vertex_count() - 1));
  const Floats slack = Floats(1.2e-7f) * t.reach + Floats(1.0e-6f * convex.size());
  const Floats reach = Floats(1.00001f * (convex.radius() + max_separation)) + slack;
  Mask<kLanes> beside = Mask<kLanes>::splat(false);
  for (int i = 0; i < 3; ++i) {
    const Vectors edge = t.corner[next_corner(i)] - t.corner[i], outward = cross(edge, t.normal);
    const Floats beyond = min(dot(outward, first - t.corner[i]), dot(outward, last - t.corner[i]));
    beside = beside | ((beyond > Floats(0.0f)) & (square(beyond) > square(reach) * length_squared(edge)));
  }
  return beside;
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
  Mask<kLanes> away = (out.extents.low - height - radius > Floats(max_separation)) |
                      (out.extents.high - height + radius <= Floats(0.0f));
  if (convex.face_count() > 0)
    away = away | (convex.face_separations(t.corner) - radius > Floats(max_separation));
  if (convex.vertex_count() == 1 || convex.vertex_count() == 2)
    away = away | is_beside(t, convex, max_separation);
  out.touchable = to_bits(~away) & ((1u << count) - 1u);
  return out;
}

}  // namespace gyre
