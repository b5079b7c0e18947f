// A ray against triangles, without gaps between neighbours (S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", 2013). In: a
// ray and corners in one frame. Out: the fraction of the ray at which it crosses the triangle, and from which side.
#pragma once

#include "geometry/query/cast.h"

#include <gyre/math.h>

namespace gyre {

// Intersection of a ray with triangles. A ray through an edge or a corner hits at least one of the triangles around it,
// because all of them use the same sheared corners, and an edge counts for both sides.
class TriangleRay {
 public:
  explicit TriangleRay(const LocalRay& ray);

  // The fraction at which the ray crosses the plane of the triangle inside the triangle, if it does. `front`: the
  // corners run counter-clockwise seen from the ray's origin.
  bool crosses(Vec3 a, Vec3 b, Vec3 c, double& fraction, bool& front) const {
    return crosses(DVec3(a), DVec3(b), DVec3(c), fraction, front);
  }
  bool crosses(DVec3 a, DVec3 b, DVec3 c, double& fraction, bool& front) const;

 private:
  DVec3 sheared(DVec3 corner) const;

  DVec3 origin_;
  int x_, y_, z_;  // axes; z is the one with the largest component of the ray
  double shear_x_ = 0.0, shear_y_ = 0.0, scale_ = 0.0;
};

}  // namespace gyre
