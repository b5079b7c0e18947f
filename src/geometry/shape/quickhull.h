// The convex hull of points on an integer grid, as triangles. All decisions about sides are exact, so the result is
// closed and convex whatever the points are: duplicates, lines, planes and slivers need no special care.
//
// The points go in farthest first, and the search stops when every other point lies within a tolerance of the hull or the
// greatest number of vertices is reached: few vertices that keep the shape.
//
// In: points with coordinates in 0 .. kGridSize. Out: triangles of point numbers.
// Source: C. Barber, D. Dobkin, H. Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996.
#pragma once

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// A step is 1.5e-8 of the whole: finer than a float's own precision. Side tests then fit two 64-bit words.
constexpr std::int32_t kGridSize = 1 << 26;

struct GridPoint {
  std::int32_t x, y, z;

  bool operator==(const GridPoint&) const = default;
};

// Three point numbers, counter-clockwise seen from outside.
struct GridTriangle {
  int vertices[3];
};

// What the points span.
enum class GridSpan : std::uint8_t { volume, point, line, plane };

struct GridHull {
  GridSpan span = GridSpan::volume;
  bool complete = true;       // every point lies within the tolerance
  std::vector<int> vertices;  // in the order they went in: every beginning of the list is a good coarser hull
  std::vector<GridTriangle> triangles;
};

struct QuickhullLimits {
  double tolerance = 0.0;  // how far outside a point may stay, in grid steps
  double flat = 1.0;       // points that lie within this of a point, line or plane span no volume
  int vertices = 255;      // at most, and at least four
};

// The hull of all points. If `first` is not empty its points go in first, in their order, and all of them that lie
// outside of those before become vertices.
GridHull quickhull(std::span<const GridPoint> points, std::span<const int> first,
                   const QuickhullLimits& limits);

// Distance of `p` from the triangle (a, b, c), which may be a line or point.
double distance_to_triangle(DVec3 p, DVec3 a, DVec3 b, DVec3 c);

// How far `p` lies outside the hull's triangles, in grid steps; 0 inside.
double distance_outside(std::span<const GridPoint> points, std::span<const GridTriangle> triangles,
                        const GridPoint& p);

}  // namespace gyre
