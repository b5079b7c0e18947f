// The Voronoi regions of a triangle. See sphere_triangle.h.
#include "geometry/distance/sphere_triangle.h"

#include "geometry/distance/closest.h"

namespace gyre {
namespace {

TriangleFeature feature_of(unsigned corners) {
  switch (corners) {
    case 1:
      return TriangleFeature::corner_a;
    case 2:
      return TriangleFeature::corner_b;
    case 4:
      return TriangleFeature::corner_c;
    case 3:
      return TriangleFeature::edge_ab;
    case 6:
      return TriangleFeature::edge_bc;
    case 5:
      return TriangleFeature::edge_ca;
    default:
      return TriangleFeature::face;
  }
}

}  // namespace

const char* to_string(TriangleFeature feature) {
  constexpr const char* kNames[7] = {"corner_a", "corner_b", "corner_c", "edge_ab",
                                     "edge_bc",  "edge_ca",  "face"};
  return kNames[int(feature)];
}

SphereTriangle sphere_triangle(DVec3 middle, double radius, DVec3 a, DVec3 b, DVec3 c) {
  const SimplexPoint nearest = closest_on_triangle(middle, a, b, c);
  SphereTriangle out;
  out.corners = nearest.corners;
  out.feature = feature_of(nearest.corners);
  out.on_triangle = nearest.point;
  const DVec3 offset = middle - nearest.point;
  out.distance = length(offset);
  out.separation = out.distance - radius;
  if (out.distance > 0.0) {
    out.normal = offset / out.distance;
  } else {
    const DVec3 front = cross(b - a, c - a);
    const double area = length(front);
    out.normal = area > 0.0 ? front / area : DVec3{0, 1, 0};
  }
  return out;
}

}  // namespace gyre
