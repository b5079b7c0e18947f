// Turning triangles round, their normals and their edges. See triangle.h.
#include "geometry/shape/triangle.h"

namespace gyre {

TriangleView back_view(const TriangleView& triangle) {
  // Corners 0, 2, 1: the new edge i is the old edge 2 - i.
  constexpr int kCorner[3] = {0, 2, 1};
  TriangleView back = triangle;
  back.normal = -triangle.normal;
  back.flat_corners = 0;
  for (int i = 0; i < 3; ++i) {
    const int corner = kCorner[i], edge = 2 - i;
    back.v[i] = triangle.v[corner];
    back.corner_id[i] = triangle.corner_id[corner];
    if ((triangle.flat_corners >> corner & 1) != 0)
      back.flat_corners = std::uint8_t(back.flat_corners | 1 << i);
    back.neighbor_normal[i] = -triangle.neighbor_normal[edge];
    back.edge_id[i] = triangle.edge_id[edge];
    const EdgeKind kind = triangle.edge[edge];
    back.edge[i] = kind == EdgeKind::convex    ? EdgeKind::concave
                   : kind == EdgeKind::concave ? EdgeKind::convex
                                               : kind;
  }
  return back;
}

Vec3 triangle_normal(Vec3 a, Vec3 b, Vec3 c) {
  const DVec3 ab = DVec3(b) - DVec3(a), ac = DVec3(c) - DVec3(a), bc = DVec3(c) - DVec3(b);
  const DVec3 n = cross(ab, ac);
  const double area = length(n);
  const double longest = max(length_squared(ab), max(length_squared(ac), length_squared(bc)));
  if (!(area > 1.0e-7 * longest)) return {0.0f, 0.0f, 0.0f};
  return to_float(n / area);
}

EdgeKind classify_edge(Vec3 normal, Vec3 neighbor_normal, Vec3 along, float flat_angle) {
  if (length_squared(neighbor_normal - normal) <= flat_angle * flat_angle) return EdgeKind::flat;
  return dot(cross(normal, neighbor_normal), along) > 0.0f ? EdgeKind::convex : EdgeKind::concave;
}

}  // namespace gyre
