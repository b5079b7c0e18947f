// A cooked triangle mesh: welded vertices, triangles in the order of their tree, and across every edge the triangle beyond.
//
// In: a MeshDef, cooked once (mesh_builder.h does the work). Out: triangles with their surroundings, and walks over those
// near a box. Adjacency and the kinds of edges are decided here, once; contacts only read them.
#pragma once

#include "geometry/tree/static_tree.h"
#include "geometry/shape/triangle.h"

#include <cstdint>
#include <vector>

namespace gyre {

struct Mesh {
  static constexpr std::uint32_t kNoTwin = 0xffffffffu;

  std::vector<Vec3> vertices;  // welded; every one is used
  std::vector<std::uint32_t>
      indices;                // three a triangle, in the order of the tree: a leaf owns one run of triangles
  std::vector<Vec3> normals;  // one a triangle; the same bits all over a flat patch
  // By half-edge 3 * triangle + edge: the half-edge that runs back along it in the neighbour, or kNoTwin.
  std::vector<std::uint32_t> twins;
  std::vector<std::uint16_t> flags;   // one a triangle, see below
  std::vector<std::uint32_t> source;  // one a triangle: which triangle of the MeshDef it was
  StaticTree tree;                    // its `items` are not kept: position and triangle are the same
  // By node, bit i for lane i: all triangles below lie inside one flat patch, so nothing but their plane can be touched.
  std::vector<std::uint8_t> flat_lanes;
  bool double_sided = false;
  std::vector<std::uint16_t> materials;  // by the number in the MeshDef; empty if none has one of its own

  std::uint32_t triangle_count() const { return std::uint32_t(normals.size()); }
};

// Bits 0 to 5: the kinds of the three edges, two bits each. Bits 6 to 8: flat corners. Bit 9: no edge and no corner is
// active (the triangle lies inside a flat patch).
constexpr int kFlatCornerShift = 6;
constexpr std::uint16_t kInsidePatch = 1 << 9;
constexpr EdgeKind edge_kind(std::uint16_t flags, int edge) { return EdgeKind(flags >> (2 * edge) & 3); }

// The triangle with its surroundings, in the mesh's frame; or written to where it is wanted.
TriangleView view_triangle(const Mesh& mesh, std::uint32_t triangle);
void view_triangle(const Mesh& mesh, std::uint32_t triangle, TriangleView& out);
// All of that but its own corners and normal.
void view_surroundings(const Mesh& mesh, std::uint32_t triangle, TriangleView& out);

// Without its surroundings.
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

// Whether no edge that leaves this corner of the triangle climbs along `direction` (unit) by more than the sine
// `tolerance`: whether the direction is a normal of the surface there.
bool in_normal_cone(const Mesh& mesh, std::uint32_t triangle, int corner, Vec3 direction, float tolerance);

}  // namespace gyre
