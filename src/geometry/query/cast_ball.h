// A moving ball against a ball, capsule, box or triangle in closed form: its middle is a ray, and the other shape is a core (a
// point, segment, box or triangle) swept by both radii.
//
// In: the core, the sum of the radii (above 0), the way of the ball's middle. Out: the first fraction at which it is as near as that to the
// core, where on the core, and the direction from there to the middle.
//
// Source: C. Ericson, "Real-Time Collision Detection", 2005, 5.3.7 and 5.5.7, with all parts of space about a box that the
// way passes through looked at in turn.
#pragma once

#include "geometry/query/cast.h"

namespace gyre {

// Balls, capsules and boxes, as their cores: half extents, of which any may be 0.
inline bool has_box_core(const Shape& shape) { return shape.kind <= ShapeKind::capsule; }
inline DVec3 box_core(const Shape& shape) {
  if (shape.kind == ShapeKind::sphere) return {};
  return shape.kind == ShapeKind::capsule ? DVec3{0.0, double(shape.extents.y), 0.0} : DVec3(shape.extents);
}

struct BallImpact {
  double fraction = 0.0;
  DVec3 on_core;
  DVec3 normal;  // unit, from the core to the ball
};

// What begins within the radii, and a triangle without a normal to rely on, is left to a search (geometry/distance/gjk.h).
enum class BallCast { misses, hits, unknown };

BallCast cast_ball_at_box(DVec3 core, double radii, const LocalRay& middle, double reach, BallImpact& impact);
BallCast cast_ball_at_triangle(const DVec3 (&corners)[3], double radius, const LocalRay& middle, double reach,
                               BallImpact& impact);

}  // namespace gyre
