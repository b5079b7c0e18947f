// The support function of convex shapes, for manifolds and GJK: the farthest point along a direction, and the face,
// edge or point that faces it.
//
// Both describe the CORE of the shape: the shape is a core with a rounding of core_radius (sphere: its centre, capsule:
// its segment, box: the inner box; all others are their own core with radius 0). The true surface is core_radius
// farther out along the normal.
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
  // Unit, outward. Of a segment: perpendicular to it and as close to the given direction as possible. Of a point: the
  // given direction.
  Vec3 normal;
  // Counter-clockwise seen from outside. Not cleared, like the ids: only the counted elements are read.
  union {
    Vec3 vertices[kMaxFaceVertices];
  };
  // Names each vertex within the shape. The names do not depend on the orientation.
  std::uint8_t ids[kMaxFaceVertices];
  // Names the face, segment or point within the shape; below 256.
  std::uint32_t feature = 0;

  FacePolygon() {}
};

// The rounding of the core: sphere and capsule radius, box rounding, else 0.
inline float core_radius(const Shape& shape) {
  return shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule || shape.kind == ShapeKind::box
             ? shape.radius
             : 0.0f;
}

// The farthest point of the core along `direction` (any length; any extreme point if it is zero). Convex kinds only.
Vec3 support(const Shape& shape, Vec3 direction);

// The feature of the core whose outward normal is closest to `direction` (any length but zero). Returns out.count. A
// round cap of a cylinder or cone becomes eight points fixed to the shape, so that contacts of a standing cylinder keep
// their names, and, once the direction leans, a ninth point exactly at the lowest point of the rim, so that it rolls
// smoothly.
int support_face(const Shape& shape, Vec3 direction, FacePolygon& out);

}  // namespace gyre
