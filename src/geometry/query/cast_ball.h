// A moving ball against a ball, capsule, box or triangle in closed form. The centre of the ball is a ray, and the other
// shape is a core (point, segment, box or triangle) rounded by both radii.
//
// In: the core, the sum of the radii (above 0) and the ray of the ball's centre. Out: the first fraction at which the
// centre is that close to the core, the point of the core, and the direction from it to the centre.
//
// Source: C. Ericson, "Real-Time Collision Detection", 2005, 5.3.7 and 5.5.7; here the regions around a box are visited
// in the order in which the ray passes through them.
#pragma once

#include "geometry/query/cast.h"

namespace gyre {

// Balls, capsules and boxes by their cores: half extents, any of which may be 0.
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

// unknown: the ball starts within the radii, or the triangle has no reliable normal; a search must decide
// (geometry/distance/gjk.h).
enum class BallCast { misses, hits, unknown };

BallCast cast_ball_at_box(DVec3 core, double radii, const LocalRay& middle, double max_fraction,
                          BallImpact& impact);
BallCast cast_ball_at_triangle(const DVec3 (&corners)[3], double radius, const LocalRay& middle,
                               double max_fraction, BallImpact& impact);

}  // namespace gyre
