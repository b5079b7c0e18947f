// What manifolds and GJK ask of a convex shape: its farthest point along a direction, and the face, edge or point that
// faces that way.
//
// Both are of the shape's CORE: the part that is left when the shape is seen as a core swept by a ball of core_radius
// (sphere: its centre, capsule: its segment, box: the inner box; everything else is its own core with radius 0). The true
// surface lies core_radius farther out along the normal.
//
// Source: G. van den Bergen, "Collision Detection in Interactive 3D Environments", 2003, chapter 4 (support mappings).
#pragma once

#include "geometry/shape/shape.h"

#include <cstdint>

namespace gyre {

constexpr int kMaxFaceVertices = 32;

// A polygon (3 or more points), a segment (2) or a point (1) of a shape's core.
struct FacePolygon {
  int count = 0;
  // Unit, outward. For a segment: at a right angle to it, as near to the asked direction as that allows. For a point: the
  // asked direction.
  Vec3 normal;
  // Counter-clockwise seen from outside. Like their names not cleared: only the counted ones are ever read.
  union {
    Vec3 vertices[kMaxFaceVertices];
  };
  // Names each vertex within the whole shape, and keeps its meaning while the shape turns.
  std::uint8_t ids[kMaxFaceVertices];
  // Names the face, segment or point within the shape; below 256 too.
  std::uint32_t feature = 0;

  FacePolygon() {}
};

// The radius of the ball that sweeps the core: sphere and capsule radius, box rounding, else 0.
inline float core_radius(const Shape& shape) {
  return shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule || shape.kind == ShapeKind::box
             ? shape.radius
             : 0.0f;
}

// The core's farthest point along `direction` (any length; any extreme point if it is zero). Convex kinds only.
Vec3 support(const Shape& shape, Vec3 direction);

// The core's feature whose outward normal is nearest to `direction` (any length but zero). Returns out.count.
// Round caps of cylinders and cones become eight points fixed to the shape (so that contacts of a standing cylinder keep
// their names), and, once the direction leans, a ninth exactly at the lowest point of the rim (so that it rolls smoothly).
int support_face(const Shape& shape, Vec3 direction, FacePolygon& out);

}  // namespace gyre
