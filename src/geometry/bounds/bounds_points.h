// Shared by the fits of bounding volumes: checks of points, rounding outward, small doubles, the smallest ball.
#pragma once

#include <gyre/bounds.h>

#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace gyre {

// The error of points that cannot be bounded; code none if they can.
Error check_bounded_points(std::span<const Vec3> points);

// The smallest float not below x, and the largest not above it.
float round_up_to_float(double x);
float round_down_to_float(double x);

inline DVec3 unit(DVec3 a) {
  const double size = length(a);
  return size > 0.0 ? (1.0 / size) * a : DVec3(1, 0, 0);
}
// A unit vector perpendicular to the unit vector `a`.
DVec3 some_perpendicular(DVec3 a);

// Three perpendicular axes, right-handed.
struct DAxes {
  DVec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
};
// The exact axes of a box with a float quaternion.
DAxes axes_of(Quat orientation);
Quat to_quaternion(const DAxes& axes);

// The points that decide a bounding volume: the vertices of the hull, or all points if they span no volume.
struct Outline {
  std::vector<DVec3> points;
  std::vector<DVec3> face_normals;  // unit; none if the points span no volume
  std::vector<DVec3> edges;         // directions times length, without repetition
  DAxes axes;                       // principal axes of the surface of the hull, or of the points
};
Outline outline_of(std::span<const Vec3> points);

struct Ball {
  DVec3 center;
  double radius = -1.0;  // negative: empty
};
// The smallest ball around one or more points.
Ball smallest_ball(std::span<const DVec3> points);

}  // namespace gyre
