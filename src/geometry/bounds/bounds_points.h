// What the fits of bounding volumes share: checks of points, rounding outward, small doubles, the smallest ball.
#pragma once

#include <gyre/bounds.h>

#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace gyre {

// Why points cannot be bounded; code none if they can.
Error check_bounded_points(std::span<const Vec3> points);

// The smallest float not below x, and the largest not above.
float round_up_to_float(double x);
float round_down_to_float(double x);

inline DVec3 unit(DVec3 a) {
  const double size = length(a);
  return size > 0.0 ? (1.0 / size) * a : DVec3(1, 0, 0);
}
// A unit vector at a right angle to the unit vector `a`.
DVec3 some_perpendicular(DVec3 a);

// Three axes at right angles, right-handed.
struct DAxes {
  DVec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};
// The exact axes that a box's float quaternion stands for.
DAxes axes_of(Quat orientation);
Quat to_quaternion(const DAxes& axes);

// Those points that the others' volumes cannot be found without: the vertices of their hull, or all if they span no volume.
struct Outline {
  std::vector<DVec3> points;
  std::vector<DVec3> face_normals;  // unit; none if the points span no volume
  std::vector<DVec3> edges;         // directions times length, each once
  DAxes axes;                       // principal axes: of the hull's surface, or of the points
};
Outline outline_of(std::span<const Vec3> points);

struct Ball {
  DVec3 center;
  double radius = -1.0;  // below 0: empty
};
// The smallest ball around at least one point.
Ball smallest_ball(std::span<const DVec3> points);

}  // namespace gyre
