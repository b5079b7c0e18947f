// The convex hull of points on an integer grid, as triangles. All side tests are exact, so the result is closed and
// convex for any input: duplicates, lines, planes and slivers need no special care.
//
// The farthest point is inserted first. The search stops when every other point is within a tolerance of the hull, or
// at the largest number of vertices. So few vertices preserve the shape.
//
// In: points with coordinates in 0 .. kGridSize. Out: triangles of point numbers.
// Source: C. Barber, D. Dobkin, H. Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996.
#pragma once

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// A step is 1.5e-8 of the extent: finer than the precision of a float. Side tests then fit two 64-bit words.
constexpr std::int32_t kGridSize = 1 << 26;

struct GridPoint {
  std::int32_t x, y, z;

  bool operator==(const GridPoint&) const = default;
};

// Three point numbers, counter-clockwise seen from outside.
struct GridTriangle {
  int vertices[3];
};

// The dimension that the points span.
enum class GridSpan : std::uint8_t { volume, point, line, plane };

struct GridHull {
  GridSpan span = GridSpan::volume;
  bool complete = true;       // every point is within the tolerance
  std::vector<int> vertices;  // in the order of insertion: every prefix of the list is a good coarser hull
  std::vector<GridTriangle> triangles;
};

struct QuickhullLimits {
  double tolerance = 0.0;  // grid steps, how far outside a point may stay
  double flat = 1.0;       // points within this of a point, line or plane span no volume
  int vertices = 255;      // at most, and at least four
};

// The hull of all points. The points of `first` are inserted first, in their order; all of them outside the hull of
// those before become vertices.
GridHull quickhull(std::span<const GridPoint> points, std::span<const int> first,
                   const QuickhullLimits& limits);

// Distance of `p` from the triangle (a, b, c), which may be a line or point.
double distance_to_triangle(DVec3 p, DVec3 a, DVec3 b, DVec3 c);

// The distance of `p` outside the hull, in grid steps; 0 inside.
double distance_outside(std::span<const GridPoint> points, std::span<const GridTriangle> triangles,
                        const GridPoint& p);

}  // namespace gyre
