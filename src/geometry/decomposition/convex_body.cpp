// Conversion of points to the integer grid of quickhull and back. See convex_body.h.
#include "geometry/decomposition/convex_body.h"

#include "geometry/distance/closest.h"

namespace gyre {
namespace {

// The plane of the triangle, moved outward until all of its corners are on or below it.
HalfSpace plane_of(const ConvexBody& body, const GridTriangle& t) {
  const auto at = [&](int i) { return body.vertices[std::size_t(t.vertices[i])]; };
  const DVec3 normal = cross(at(1) - at(0), at(2) - at(0));
  const double size = length(normal);
  HalfSpace plane;
  if (!(size > 0.0)) return plane;
  plane.normal = normal / size;
  plane.offset = max(dot(plane.normal, at(0)), max(dot(plane.normal, at(1)), dot(plane.normal, at(2))));
  return plane;
}

}  // namespace

DVec3 lower(DVec3 a, DVec3 b) { return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; }
DVec3 higher(DVec3 a, DVec3 b) { return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; }

double ConvexBody::thickness() const {
  double area = 0.0;
  for (const GridTriangle& t : triangles) {
    const auto at = [&](int i) { return vertices[std::size_t(t.vertices[i])]; };
    area += 0.5 * length(cross(at(1) - at(0), at(2) - at(0)));
  }
  return area > 0.0 ? 2.0 * volume / area : 0.0;
}

ConvexBody make_body(std::span<const DVec3> points, const BodyPrecision& precision) {
  ConvexBody body;
  if (points.size() < 4) return body;
  DVec3 low = points[0], high = points[0];
  for (const DVec3& p : points) {
    low = lower(low, p);
    high = higher(high, p);
  }
  const DVec3 size = high - low;
  const double extent = max(size.x, max(size.y, size.z));
  if (!(extent > precision.flat)) return body;
  const double step = extent / double(kGridSize);
  std::vector<GridPoint> grid;
  grid.reserve(points.size());
  const auto snap = [&](double value, double origin) { return std::int32_t((value - origin) / step + 0.5); };
  for (const DVec3& p : points) grid.push_back({snap(p.x, low.x), snap(p.y, low.y), snap(p.z, low.z)});

  QuickhullLimits limits;
  limits.tolerance = precision.tolerance / step;
  limits.flat = max(1.0, precision.flat / step);
  limits.vertices = precision.vertices;
  const GridHull hull = quickhull(grid, {}, limits);
  if (hull.span != GridSpan::volume) return body;

  std::vector<int> number(points.size(), -1);
  for (const int v : hull.vertices) {
    number[std::size_t(v)] = int(body.vertices.size());
    body.vertices.push_back(points[std::size_t(v)]);
  }
  body.low = low;
  body.high = high;
  for (const GridTriangle& t : hull.triangles) {
    GridTriangle own{};
    for (int i = 0; i < 3; ++i) own.vertices[i] = number[std::size_t(t.vertices[i])];
    body.triangles.push_back(own);
    body.planes.push_back(plane_of(body, own));
    const auto at = [&](int i) { return body.vertices[std::size_t(own.vertices[i])] - body.vertices[0]; };
    body.volume += dot(at(0), cross(at(1), at(2))) / 6.0;
  }
  if (!(body.volume > 0.0)) return {};
  return body;
}

double depth_below(const ConvexBody& body, DVec3 p) {
  double depth = 1.0e300;
  for (const HalfSpace& plane : body.planes) depth = min(depth, plane.offset - dot(plane.normal, p));
  return depth;
}

double distance_from(const ConvexBody& body, DVec3 p) {
  if (depth_below(body, p) >= 0.0) return 0.0;
  double nearest = 1.0e300;
  for (const GridTriangle& t : body.triangles) {
    const auto at = [&](int i) { return body.vertices[std::size_t(t.vertices[i])]; };
    nearest = min(nearest, length(closest_on_triangle(p, at(0), at(1), at(2)).point - p));
  }
  return nearest;
}

}  // namespace gyre
