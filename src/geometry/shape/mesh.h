// A cooked triangle mesh: welded vertices, triangles in the order of their tree, and the neighbour across every edge.
//
// In: a MeshDef, cooked once (mesh_builder.cpp). Out: triangles with their neighbourhood, and traversal of those near a
// box. Cooking decides adjacency and the kinds of edges; contacts only read them.
#pragma once

#include "geometry/shape/triangle.h"
#include "geometry/tree/static_tree.h"

#include <cstdint>
#include <vector>

namespace gyre {

struct Mesh {
  static constexpr std::uint32_t kNoTwin = 0xffffffffu;

  std::vector<Vec3> vertices;  // welded; every one is used
  // Three for each triangle, in the order of the tree: each leaf has one contiguous run of triangles.
  std::vector<std::uint32_t> indices;
  std::vector<Vec3> normals;  // one for each triangle; the same bits all over a flat patch
  // By half-edge 3 * triangle + edge: the opposite half-edge of the neighbour, or kNoTwin.
  std::vector<std::uint32_t> twins;
  std::vector<std::uint16_t> flags;   // one for each triangle, see below
  std::vector<std::uint32_t> source;  // for each triangle its number in the MeshDef
  StaticTree tree;                    // its `items` are released: position and triangle are equal
  // By node, bit i for lane i: all triangles below lie inside one flat patch, so only their plane can be touched.
  std::vector<std::uint8_t> flat_lanes;
  bool double_sided = false;
  std::vector<std::uint16_t> materials;  // by the number in the MeshDef; empty if no triangle has one

  std::uint32_t triangle_count() const { return std::uint32_t(normals.size()); }
};

// Bits 0 to 5: the kinds of the three edges, two bits each. Bits 6 to 8: flat corners. Bit 9: no edge and no corner is
// active (the triangle lies inside a flat patch).
constexpr int kFlatCornerShift = 6;
constexpr std::uint16_t kInsidePatch = 1 << 9;
constexpr EdgeKind edge_kind(std::uint16_t flags, int edge) { return EdgeKind(flags >> (2 * edge) & 3); }

// The triangle with its neighbourhood, in the mesh's frame.
TriangleView view_triangle(const Mesh& mesh, std::uint32_t triangle);
void view_triangle(const Mesh& mesh, std::uint32_t triangle, TriangleView& out);
// The neighbourhood alone, without the corners and the normal.
void view_surroundings(const Mesh& mesh, std::uint32_t triangle, TriangleView& out);

// The triangle without its neighbourhood.
inline BareTriangle bare_triangle(const Mesh& mesh, std::uint32_t triangle) {
  const std::uint32_t* corner = mesh.indices.data() + 3 * std::size_t(triangle);
  return {{mesh.vertices[corner[0]], mesh.vertices[corner[1]], mesh.vertices[corner[2]]},
          mesh.normals[triangle]};
}

inline Aabb triangle_box(const Mesh& mesh, std::uint32_t triangle) {
  const std::uint32_t* corner = mesh.indices.data() + 3 * std::size_t(triangle);
  const Vec3 a = mesh.vertices[corner[0]], b = mesh.vertices[corner[1]], c = mesh.vertices[corner[2]];
  return {min(a, min(b, c)), max(a, max(b, c))};
}

// True if no edge at this corner of the triangle climbs along `direction` (unit) by more than the sine `tolerance`. The
// direction is then a normal of the surface there.
bool in_normal_cone(const Mesh& mesh, std::uint32_t triangle, int corner, Vec3 direction, float tolerance);

}  // namespace gyre
