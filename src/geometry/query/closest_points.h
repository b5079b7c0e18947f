// How far a convex shape is from another shape of any kind, and between which points.
//
// In: the shape, where the convex one is in its frame, and how far to look. Out: distance, the two points, the direction, and
// the triangle of a mesh or height field, which are surfaces without thickness here. Overlap is distance 0; how deep it is,
// manifolds tell.
#pragma once

#include "geometry/query/cast.h"

namespace gyre {

// A convex shape in the frame of another.
struct PosedShape {
  const Shape* shape = nullptr;
  DVec3 position;
  DQuat orientation;
};

struct ClosestPoints {
  double distance = 0.0;
  bool overlap =
      false;  // they share a point; distance is 0 and the points are one that they share, or near it
  DVec3 on_target, on_convex;  // in the target's frame
  DVec3 normal;                // unit, from the target to the convex shape; when they overlap: some direction
  std::uint32_t triangle = kNoTriangle;
};

// Whether the two are within `max_distance`. Touching counts as overlap.
bool find_closest_points(const Shape& target, const PosedShape& convex, double max_distance, ClosestPoints& out);

}  // namespace gyre
