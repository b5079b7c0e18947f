// Distance and closest points of a convex shape and another shape of any kind.
//
// In: the target, the pose of the convex shape in its frame, and the largest distance. Out: the distance, the two
// points, the direction, and the triangle of a mesh or height field, which are surfaces without thickness here. An
// overlap has distance 0; manifolds give its depth.
#pragma once

#include "geometry/query/cast.h"

namespace gyre {

// A convex shape with its pose in the frame of another shape.
struct PosedShape {
  const Shape* shape = nullptr;
  DVec3 position;
  DQuat orientation;
};

struct ClosestPair {
  double distance = 0.0;
  // The two share a point. The distance is then 0, and the points are one point that they share, or close to one.
  bool overlap = false;
  DVec3 on_target, on_convex;  // in the target's frame
  DVec3 normal;                // unit, from the target to the convex shape; of an overlap: some direction
  std::uint32_t triangle = kNoTriangle;
};

// Returns true if the two are within `max_distance`. Touching counts as overlap.
bool find_closest_points(const Shape& target, const PosedShape& convex, double max_distance,
                         ClosestPair& out);

// True if the convex shape overlaps or touches a triangle whose surface is rounded by `radius`.
bool overlaps_triangle(const DVec3 (&triangle)[3], double radius, const PosedShape& convex);

}  // namespace gyre
