// The convex hull of points in double precision, as triangles with planes and a volume: what a decomposition reckons with
// before it cooks anything.
//
// In: points of any number and place. Out: a ConvexBody, which is empty if the points span no volume.
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
};

struct BodyPrecision {
  int vertices = 255;      // at most, the most telling first
  double tolerance = 0.0;  // how far a point may stay outside
  double flat = 0.0;       // points within this of a plane span no volume
};

ConvexBody make_body(std::span<const DVec3> points, const BodyPrecision& precision);

// How far `p` lies below the nearest plane: its depth inside, or less than 0 outside.
double depth_below(const ConvexBody& body, DVec3 p);
// How far `p` lies from the body; 0 inside.
double distance_from(const ConvexBody& body, DVec3 p);

DVec3 lower(DVec3 a, DVec3 b);
DVec3 higher(DVec3 a, DVec3 b);

}  // namespace gyre
