// The convex hull of points in double precision, as triangles with planes and a volume: the working form of
// decomposition, before hulls are cooked.
//
// In: any number of points anywhere. Out: a ConvexBody, which is empty if the points span no volume.
#pragma once

#include "geometry/shape/quickhull.h"

#include <gyre/math.h>

#include <span>
#include <vector>

namespace gyre {

// All points with dot(normal, p) <= offset.
struct HalfSpace {
  DVec3 normal;  // unit
  double offset = 0.0;
};

struct ConvexBody {
  std::vector<DVec3> vertices;
  std::vector<GridTriangle> triangles;  // vertex numbers, counter-clockwise seen from outside
  std::vector<HalfSpace> planes;        // of the triangles
  double volume = 0.0;
  DVec3 low, high;

  bool empty() const { return triangles.empty(); }
  // The mean thickness: twice the volume over the surface. 0 if empty.
  double thickness() const;
};

struct BodyPrecision {
  int vertices = 255;      // maximum number; the most important come first
  double tolerance = 0.0;  // how far a point may stay outside
  double flat = 0.0;       // points within this of a plane span no volume
};

ConvexBody make_body(std::span<const DVec3> points, const BodyPrecision& precision);

// The depth of `p` below the closest plane; negative outside.
double depth_below(const ConvexBody& body, DVec3 p);
// The distance of `p` from the body; 0 inside.
double distance_from(const ConvexBody& body, DVec3 p);

DVec3 lower(DVec3 a, DVec3 b);
DVec3 higher(DVec3 a, DVec3 b);

}  // namespace gyre
