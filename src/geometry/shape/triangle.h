// One triangle of a mesh or height field with all that contacts need to know about its surroundings, so that the same
// logic against ghost edges serves both.
//
// An edge is active only where the surface really has one: convex, or open. What a flat or concave edge could push against,
// the faces beside it push against better.
#pragma once

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

// m, of meshes and height fields. Beyond it, products of three coordinates would leave the range of a float.
constexpr float kMaxSurfaceCoordinate = 1.0e9f;

enum class EdgeKind : std::uint8_t {
  open,     // no neighbour: the border of the surface, or a seam that cannot be paired
  convex,   // a ridge, seen from the front
  flat,     // both sides lie in one plane
  concave,  // a valley
};

struct TriangleView {
  Vec3 v[3];                // counter-clockwise seen from the front; edge i runs from v[i] to v[(i + 1) % 3]
  Vec3 normal;              // unit
  Vec3 neighbor_normal[3];  // of the triangle beyond each edge; this one's own where the edge is open
  EdgeKind edge[3] = {};
  std::uint8_t flat_corners =
      0;  // bit i: all around v[i] the surface is one plane, so that it is no corner at all
  std::uint32_t id = 0;
  std::uint32_t corner_id[3] = {};  // names the vertex within the surface
  std::uint32_t edge_id[3] = {};    // names the edge, the same from both sides
};

// Of the same nothing but itself.
struct BareTriangle {
  Vec3 v[3];
  Vec3 normal;
};

constexpr int next_corner(int i) { return i == 2 ? 0 : i + 1; }

constexpr Aabb bounds(const TriangleView& t) {
  return {min(t.v[0], min(t.v[1], t.v[2])), max(t.v[0], max(t.v[1], t.v[2]))};
}

// The same triangle seen from behind: what was a ridge is a valley.
TriangleView back_view(const TriangleView& triangle);

// The unit normal of a triangle, by double arithmetic; zero if it has no area to speak of: if its height is below 1e-7 of
// its longest edge.
Vec3 triangle_normal(Vec3 a, Vec3 b, Vec3 c);

// What an edge is, from the normals on both sides: `along` is the edge's direction (any length) on the side of
// `normal`. Below `flat_angle` (rad) it is flat.
EdgeKind classify_edge(Vec3 normal, Vec3 neighbor_normal, Vec3 along, float flat_angle);

}  // namespace gyre
