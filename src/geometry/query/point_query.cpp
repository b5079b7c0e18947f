#include "geometry/query/point_query.h"

#include "geometry/distance/closest.h"
#include "geometry/query/cast_surface.h"
#include "geometry/query/closest_points.h"
#include "geometry/shape/height_field.h"
#include "geometry/shape/hull.h"

#include <cmath>

namespace gyre {

namespace {

// Triangles at distances that differ by less than this share are equally near: they share the closest point.
constexpr double kSameDistance = 1.0e-9;

double axis_of(DVec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// The distance to a core, rounded by `radius`. `direction` is used where the point lies in the core.
void set_rounded(DVec3 point, DVec3 on_core, double radius, DVec3 direction, PointDistance& out) {
  const DVec3 offset = point - on_core;
  const double apart = length(offset);
  out.normal = apart > 0.0 ? offset / apart : direction;
  out.distance = apart - radius;
  out.on_surface = on_core + radius * out.normal;
}

void find_in_box(DVec3 half, double rounding, DVec3 p, PointDistance& out) {
  const DVec3 inner{clamp(p.x, -half.x, half.x), clamp(p.y, -half.y, half.y), clamp(p.z, -half.z, half.z)};
  if (inner.x != p.x || inner.y != p.y || inner.z != p.z)
    return set_rounded(p, inner, rounding, {0, 1, 0}, out);
  int face = 0;
  double depth = half.x - absolute(p.x);
  for (int axis = 1; axis < 3; ++axis) {
    const double other = axis_of(half, axis) - absolute(axis_of(p, axis));
    if (other < depth) depth = other, face = axis;
  }
  const double side = axis_of(p, face) < 0.0 ? -1.0 : 1.0;
  out.normal = {face == 0 ? side : 0.0, face == 1 ? side : 0.0, face == 2 ? side : 0.0};
  out.distance = -(depth + rounding);
  out.on_surface = p - out.distance * out.normal;
}

// A point in the half plane of a solid of revolution: distance from the axis, and height.
struct Profile {
  double r = 0.0, y = 0.0;
};

// The distance to a convex profile of corners from top to bottom, the first and last on the axis. The profile's edges are seen with their outside
// on the side of larger r.
void find_in_profile(std::span<const Profile> corners, DVec3 p, PointDistance& out) {
  const double r = std::sqrt(p.x * p.x + p.z * p.z);
  const DVec3 outward = r > 0.0 ? DVec3{p.x / r, 0.0, p.z / r} : DVec3{1, 0, 0};
  double deepest = -1.0e300, nearest = 1.0e300;
  Profile face_normal, at, near_normal, near_at;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) {
    const Profile a = corners[i], b = corners[i + 1];
    const double dr = b.r - a.r, dy = b.y - a.y, span = std::sqrt(dr * dr + dy * dy);
    const Profile normal{-dy / span, dr / span};
    const double height = (r - a.r) * normal.r + (p.y - a.y) * normal.y;
    const double along = clamp(((r - a.r) * dr + (p.y - a.y) * dy) / (span * span), 0.0, 1.0);
    const Profile closest{a.r + along * dr, a.y + along * dy};
    const double apart = std::sqrt(square(r - closest.r) + square(p.y - closest.y));
    if (height > deepest)
      deepest = height, face_normal = normal, at = {r - height * normal.r, p.y - height * normal.y};
    if (apart < nearest) {
      nearest = apart, near_at = closest;
      near_normal = apart > 0.0 ? Profile{(r - closest.r) / apart, (p.y - closest.y) / apart} : normal;
    }
  }
  const bool inside = deepest <= 0.0;
  const Profile n = inside ? face_normal : near_normal, q = inside ? at : near_at;
  out.distance = inside ? deepest : nearest;
  out.normal = n.r * outward + DVec3{0, n.y, 0};
  out.on_surface = q.r * outward + DVec3{0, q.y, 0};
}

bool find_in_hull(const Shape& shape, DVec3 p, double max_distance, PointDistance& out) {
  double deepest = -1.0e300;
  for (const HullPlane& plane : shape.hull->planes) {
    const double height = dot(DVec3(plane.normal), p) - double(plane.offset);
    if (height > deepest) deepest = height, out.normal = DVec3(plane.normal);
  }
  if (deepest > max_distance) return false;
  out.distance = deepest;
  out.on_surface = p - deepest * out.normal;
  if (deepest <= 0.0) return true;
  const Shape point{};  // a ball of radius 0
  ClosestPair pair;
  if (!find_closest_points(shape, {&point, p, DQuat{0, 0, 0, 1}}, max_distance, pair)) return false;
  if (pair.overlap) return true;
  out.distance = pair.distance;
  out.normal = pair.normal;
  out.on_surface = pair.on_target;
  return true;
}

class NearestTriangle {
 public:
  NearestTriangle(const Shape& surface, DVec3 point, double max_distance)
      : surface_(surface), point_(point), nearest_(max_distance) {}

  bool run(PointDistance& out) {
    const float reach = float(nearest_) * 1.001f;
    const Vec3 low = to_float(point_) - Vec3{reach, reach, reach},
               high = to_float(point_) + Vec3{reach, reach, reach};
    if (surface_.kind == ShapeKind::mesh) {
      const Mesh& mesh = *surface_.mesh;
      walk_overlaps(
          mesh.tree, {low, high}, [](std::uint32_t, int) { return true; },
          [&](std::uint32_t first, std::uint32_t count) {
            for (std::uint32_t id = first; id < first + count; ++id) test(surface_triangle(mesh, id));
          });
    } else {
      const HeightField& field = *surface_.field;
      walk_cells(
          field, {low, high}, [](HeightBlock) { return true; },
          [&](std::uint32_t column, std::uint32_t row) {
            if (!is_solid_cell(field, column, row)) return;
            for (int half = 0; half < 2; ++half) test(surface_triangle(field, column, row, half));
          });
    }
    if (!found_) return false;
    const double side = cosine_ < 0.0 && !is_double_sided(surface_) ? -1.0 : 1.0;
    const DVec3 offset = point_ - at_;
    out.distance = side * nearest_;
    out.normal = nearest_ > 0.0 ? (side / nearest_) * offset : face_;
    out.on_surface = at_;
    out.triangle = public_triangle(surface_, triangle_);
    return true;
  }

 private:
  void test(const SurfaceTriangle& triangle) {
    const DVec3 pivot(triangle.a), b = DVec3(triangle.b) - pivot, c = DVec3(triangle.c) - pivot;
    const DVec3 at = closest_on_triangle(point_ - pivot, {}, b, c).point + pivot;
    const DVec3 offset = point_ - at, area = cross(b, c);
    const double apart = length(offset), size = length(area);
    if (!(size > 0.0) || apart > nearest_ * (1.0 + kSameDistance)) return;
    const double cosine = apart > 0.0 ? dot(offset, area) / (apart * size) : 0.0;
    const bool nearer = !found_ || apart < nearest_ * (1.0 - kSameDistance);
    if (!nearer && absolute(cosine) <= absolute(cosine_)) return;
    found_ = true;
    nearest_ = min(nearest_, apart);
    at_ = at, cosine_ = cosine, triangle_ = triangle.id, face_ = area / size;
  }

  const Shape& surface_;
  DVec3 point_;
  double nearest_;
  bool found_ = false;
  double cosine_ = 0.0;  // of the direction from the triangle and its normal
  DVec3 at_, face_;
  std::uint32_t triangle_ = 0;
};

}  // namespace

bool find_point_distance(const Shape& shape, DVec3 p, double max_distance, PointDistance& out) {
  out = {};
  const double radius = double(shape.radius), half = double(shape.extents.y);
  switch (shape.kind) {
    case ShapeKind::sphere:
      set_rounded(p, {}, radius, {0, 1, 0}, out);
      break;
    case ShapeKind::capsule:
      set_rounded(p, {0, clamp(p.y, -half, half), 0}, radius, {1, 0, 0}, out);
      break;
    case ShapeKind::box:
      find_in_box(DVec3(shape.extents), radius, p, out);
      break;
    case ShapeKind::cylinder: {
      const Profile corners[4] = {{0, half}, {radius, half}, {radius, -half}, {0, -half}};
      find_in_profile(corners, p, out);
      break;
    }
    case ShapeKind::cone: {
      const Profile corners[3] = {{0, half}, {radius, -half}, {0, -half}};
      find_in_profile(corners, p, out);
      break;
    }
    case ShapeKind::hull:
      return find_in_hull(shape, p, max_distance, out);
    case ShapeKind::plane:
      out.normal = DVec3(shape.extents);
      out.distance = dot(out.normal, p) - double(shape.offset);
      out.on_surface = p - out.distance * out.normal;
      break;
    case ShapeKind::mesh:
    case ShapeKind::height_field:
      return NearestTriangle(shape, p, max_distance).run(out);
  }
  return out.distance <= max_distance;
}

}  // namespace gyre
