// Access to a cooked mesh. See mesh.h.
#include "geometry/shape/mesh.h"

namespace gyre {

TriangleView view_triangle(const Mesh& mesh, std::uint32_t triangle) {
  TriangleView view;
  view_triangle(mesh, triangle, view);
  return view;
}

void view_triangle(const Mesh& mesh, std::uint32_t triangle, TriangleView& view) {
  view_surroundings(mesh, triangle, view);
  view.normal = mesh.normals[triangle];
  for (int i = 0; i < 3; ++i) view.v[i] = mesh.vertices[view.corner_id[i]];
}

void view_surroundings(const Mesh& mesh, std::uint32_t triangle, TriangleView& view) {
  view.id = triangle;
  const std::uint16_t flags = mesh.flags[triangle];
  view.flat_corners = std::uint8_t(flags >> kFlatCornerShift & 7);
  for (int i = 0; i < 3; ++i) {
    const std::uint32_t half_edge = 3 * triangle + std::uint32_t(i);
    view.corner_id[i] = mesh.indices[half_edge];
    const std::uint32_t twin = mesh.twins[half_edge];
    view.edge[i] = edge_kind(flags, i);
    view.edge_id[i] = twin == Mesh::kNoTwin ? half_edge : min(half_edge, twin);
    view.neighbor_normal[i] = mesh.normals[twin == Mesh::kNoTwin ? triangle : twin / 3];
  }
}

bool in_normal_cone(const Mesh& mesh, std::uint32_t triangle, int corner, Vec3 direction, float tolerance) {
  const std::uint32_t start = 3 * triangle + std::uint32_t(corner);
  const Vec3 apex = mesh.vertices[mesh.indices[start]];
  const auto climbs = [&](std::uint32_t vertex) {
    const Vec3 along = mesh.vertices[vertex] - apex;
    return dot(direction, along) > tolerance * length(along);
  };
  // Visits the half-edges that leave the apex, triangle by triangle: first counter-clockwise and then, if the fan is
  // open, clockwise from the start. The bound only guards against damaged data.
  constexpr int kMaxFan = 1 << 16;
  std::uint32_t half_edge = start;
  for (int step = 0; step < kMaxFan; ++step) {
    const std::uint32_t base = half_edge / 3 * 3, k = half_edge % 3;
    if (climbs(mesh.indices[base + (k + 1) % 3]) || climbs(mesh.indices[base + (k + 2) % 3])) return false;
    const std::uint32_t twin = mesh.twins[base + (k + 2) % 3];
    if (twin == Mesh::kNoTwin) break;
    half_edge = twin;
    if (half_edge == start) return true;
  }
  half_edge = start;
  for (int step = 0; step < kMaxFan; ++step) {
    const std::uint32_t twin = mesh.twins[half_edge];
    if (twin == Mesh::kNoTwin) return true;
    half_edge = twin / 3 * 3 + (twin + 1) % 3;  // the half-edge after the twin leaves the apex
    if (half_edge == start) return true;
    const std::uint32_t base = half_edge / 3 * 3, k = half_edge % 3;
    if (climbs(mesh.indices[base + (k + 1) % 3]) || climbs(mesh.indices[base + (k + 2) % 3])) return false;
  }
  return true;
}

}  // namespace gyre
