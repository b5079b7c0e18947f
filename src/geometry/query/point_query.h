// Signed distance of a point to a shape: closed forms for curved kinds, boxes and planes; the planes of a hull from inside and GJK from
// outside; the nearest triangle of a mesh or height field.
//
// In: a shape and a point in its frame. Out: distance, outward normal, closest point. A mesh or height field has the sign of the nearest
// triangle that is seen most nearly along its normal, so that edges and corners have the right side (J. Baerentzen, H. Aanaes, "Signed
// Distance Computation Using the Angle Weighted Pseudonormal", 2005, say why one triangle alone would not). A double-sided mesh has no inside.
#pragma once

#include "geometry/query/cast.h"

namespace gyre {

struct PointDistance {
  double distance = 0.0;  // m, negative inside
  DVec3 normal;           // unit, out of the shape at the closest point
  DVec3 on_surface;       // the closest point, m
  std::uint32_t triangle = kNoTriangle;
};

// Returns false if the distance is above `max_distance`, or if the point is inside a mesh or below a height field by more than that.
bool find_point_distance(const Shape& shape, DVec3 point, double max_distance, PointDistance& out);

}  // namespace gyre
