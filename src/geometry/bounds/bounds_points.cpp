// Checks, rounding, outlines and principal axes of points to be bounded. See bounds_points.h.
#include "geometry/bounds/bounds_points.h"

#include "geometry/shape/hull_builder.h"
#include "geometry/shape/shape.h"
#include "math/dense.h"

namespace gyre {
namespace {

// Sums of a covariance of points, or of triangles by their area.
struct Covariance {
  double weight = 0.0;
  DVec3 sum;
  double squares[6] = {};  // xx, yy, zz, xy, xz, yz

  void add(DVec3 p, double w) {
    weight += w;
    sum += w * p;
    squares[0] += w * p.x * p.x;
    squares[1] += w * p.y * p.y;
    squares[2] += w * p.z * p.z;
    squares[3] += w * p.x * p.y;
    squares[4] += w * p.x * p.z;
    squares[5] += w * p.y * p.z;
  }
  DAxes axes() const {
    if (!(weight > 0.0)) return {};
    const DVec3 m = (1.0 / weight) * sum;
    const double means[6] = {m.x * m.x, m.y * m.y, m.z * m.z, m.x * m.y, m.x * m.z, m.y * m.z};
    double matrix[6], moments[3], a[9];
    for (int i = 0; i < 6; ++i) matrix[i] = squares[i] / weight - means[i];
    symmetric_eigen(matrix, moments, a);
    return {{a[0], a[1], a[2]}, {a[3], a[4], a[5]}, {a[6], a[7], a[8]}};
  }
};

// The exact integral over a triangle is a sum over its corners and its centre, with weights 1 : 9.
void add_triangle(Covariance& covariance, DVec3 a, DVec3 b, DVec3 c) {
  const double area = 0.5 * length(cross(b - a, c - a));
  covariance.add((1.0 / 3.0) * (a + b + c), 0.75 * area);
  for (const DVec3& corner : {a, b, c}) covariance.add(corner, area / 12.0);
}

}  // namespace

Error check_bounded_points(std::span<const Vec3> points) {
  if (points.empty())
    return make_error(ErrorCode::invalid_geometry, "bounds: no points; allowed is one or more");
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i];
    if (is_finite(p) && largest(absolute(p)) <= kMaxLength) continue;
    return make_error(ErrorCode::invalid_geometry,
                      "bounds: point %zu is (%g, %g, %g); allowed are finite coordinates within -%g to %g m",
                      i, double(p.x), double(p.y), double(p.z), double(kMaxLength), double(kMaxLength));
  }
  return {};
}

float round_up_to_float(double x) {
  const auto rounded = float(x);
  return double(rounded) < x ? std::nextafter(rounded, 3.0e38f) : rounded;
}
float round_down_to_float(double x) { return -round_up_to_float(-x); }

DVec3 some_perpendicular(DVec3 a) {
  const DVec3 other = absolute(a.x) < 0.57735   ? DVec3(1, 0, 0)
                      : absolute(a.y) < 0.57735 ? DVec3(0, 1, 0)
                                                : DVec3(0, 0, 1);
  return unit(cross(a, other));
}

DAxes axes_of(Quat q) {
  double x = double(q.x), y = double(q.y), z = double(q.z), w = double(q.w);
  const double size = std::sqrt(x * x + y * y + z * z + w * w);
  if (!(size > 0.0)) return {};
  x /= size;
  y /= size;
  z /= size;
  w /= size;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

Quat to_quaternion(const DAxes& axes) {
  return from_matrix({to_float(axes.x), to_float(axes.y), to_float(axes.z)});
}

Outline outline_of(std::span<const Vec3> points) {
  Outline out;
  const Result<Hull> hull =
      points.size() >= 4 ? build_hull(points) : Result<Hull>(Error{ErrorCode::invalid_geometry, {}});
  // Sums relative to one of the points, so that no digits are lost far from the origin.
  const DVec3 origin(points[0]);
  Covariance covariance;
  if (!hull) {
    for (const Vec3& p : points) {
      out.points.emplace_back(p);
      covariance.add(DVec3(p) - origin, 1.0);
    }
    out.axes = covariance.axes();
    return out;
  }
  for (const Vec3& p : hull->vertices) out.points.emplace_back(p);
  for (const HullPlane& plane : hull->planes) out.face_normals.push_back(unit(DVec3(plane.normal)));
  for (const HullEdge& edge : hull->edges) out.edges.push_back(out.points[edge.to] - out.points[edge.from]);
  for (std::size_t face = 0; face + 1 < hull->face_offsets.size(); ++face) {
    const std::uint32_t first = hull->face_offsets[face];
    for (std::uint32_t i = first + 2; i < hull->face_offsets[face + 1]; ++i) {
      const auto corner = [&](std::uint32_t at) { return out.points[hull->face_vertices[at]] - origin; };
      add_triangle(covariance, corner(first), corner(i - 1), corner(i));
    }
  }
  out.axes = covariance.axes();
  return out;
}

}  // namespace gyre
