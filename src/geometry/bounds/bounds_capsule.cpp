// Bounding capsules. See gyre/bounds.h.
#include "base/float_mode.h"
#include "geometry/bounds/bounds_points.h"

namespace gyre {
namespace {

// A capsule in double.
struct Tube {
  DVec3 a, b;
  double radius = 0.0;

  double volume() const { return kPiDouble * radius * radius * (length(b - a) + 4.0 / 3.0 * radius); }
  // Points on one line have no volume; then the shortest tube is best.
  double cost(double size) const { return volume() + 1.0e-9 * size * size * (length(b - a) + radius); }
};

DVec3 nearest_on(DVec3 a, DVec3 b, DVec3 p) {
  const DVec3 segment = b - a;
  const double squared = dot(segment, segment);
  const double t = squared > 0.0 ? clamp(dot(p - a, segment) / squared, 0.0, 1.0) : 0.0;
  return a + t * segment;
}

// The best capsule along a direction.
Tube tube_along(std::span<const DVec3> points, DVec3 direction, std::vector<DVec3>& flat) {
  const DVec3 u = some_perpendicular(direction), v = cross(direction, u), origin = points[0];
  flat.clear();
  for (const DVec3& p : points) flat.emplace_back(dot(u, p - origin), dot(v, p - origin), 0.0);
  const Ball circle = smallest_ball(flat);
  const double squared = circle.radius * circle.radius;
  double low = 1.0e300, high = -1.0e300;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = dot(direction, points[i] - origin);
    const double cap = std::sqrt(max(squared - length_squared(flat[i] - circle.center), 0.0));
    low = min(low, along + cap);
    high = max(high, along - cap);
  }
  // Both caps overlap and contain everything.
  if (low > high) low = high = 0.5 * (low + high);
  const DVec3 foot = origin + circle.center.x * u + circle.center.y * v;
  return {foot + low * direction, foot + high * direction, circle.radius};
}

Tube best_tube(const Outline& outline) {
  const std::span<const DVec3> points(outline.points);
  std::vector<DVec3> flat;
  DVec3 far_a = points[0], far_b = points[0];
  for (const DVec3& p : points) {
    if (length_squared(p - points[0]) > length_squared(far_a - points[0])) far_a = p;
  }
  for (const DVec3& p : points) {
    if (length_squared(p - far_a) > length_squared(far_b - far_a)) far_b = p;
  }
  const double size = length(far_b - far_a);
  DVec3 direction = unit(far_b - far_a);
  Tube best = tube_along(points, direction, flat);
  const auto attempt = [&](DVec3 other) {
    const Tube tube = tube_along(points, other, flat);
    if (!(tube.cost(size) < best.cost(size))) return false;
    best = tube;
    direction = other;
    return true;
  };
  for (const DVec3& axis : {outline.axes.x, outline.axes.y, outline.axes.z}) attempt(axis);
  for (double step = 0.3; step > 1.0e-4; step *= 0.5) {
    for (int round = 0; round < 8; ++round) {
      const DVec3 u = some_perpendicular(direction), v = cross(direction, u), from = direction;
      bool better = false;
      for (const DVec3& offset : {u, v, -u, -v}) better = better || attempt(unit(from + step * offset));
      if (!better) break;
    }
  }
  return best;
}

// Rounds the ends to float. The radius is `farthest(segment)` rounded up.
template <class Farthest>
BoundingCapsule rounded(const Tube& tube, const Farthest& farthest) {
  BoundingCapsule capsule{to_float(tube.a), to_float(tube.b), 0.0f};
  capsule.radius = round_up_to_float(farthest(DVec3(capsule.a), DVec3(capsule.b)) * (1.0 + 1.0e-14));
  return capsule;
}

bool encloses(const BoundingCapsule& outer, const BoundingCapsule& inner) {
  for (const Vec3& end : {inner.a, inner.b}) {
    const DVec3 nearest = nearest_on(DVec3(outer.a), DVec3(outer.b), DVec3(end));
    if (length(DVec3(end) - nearest) + double(inner.radius) > double(outer.radius)) return false;
  }
  return true;
}

double squared_distance(DVec3 p0, DVec3 p1, DVec3 q0, DVec3 q1) {
  // Two segments: the distance of their lines if its ends lie within both, else that at an end.
  double best = length_squared(nearest_on(q0, q1, p0) - p0);
  best = min(best, length_squared(nearest_on(q0, q1, p1) - p1));
  best = min(best, length_squared(nearest_on(p0, p1, q0) - q0));
  best = min(best, length_squared(nearest_on(p0, p1, q1) - q1));
  const DVec3 u = p1 - p0, v = q1 - q0, w = p0 - q0;
  const double uu = dot(u, u), uv = dot(u, v), vv = dot(v, v), uw = dot(u, w), vw = dot(v, w);
  const double det = uu * vv - uv * uv;
  if (!(det > 1.0e-14 * uu * vv)) return best;
  const double s = (uv * vw - vv * uw) / det, t = (uu * vw - uv * uw) / det;
  if (s >= 0.0 && s <= 1.0 && t >= 0.0 && t <= 1.0) best = min(best, length_squared(w + s * u - t * v));
  return best;
}

}  // namespace

Result<BoundingCapsule> fit_capsule(std::span<const Vec3> points) {
  const FloatMode mode;
  if (const Error e = check_bounded_points(points)) return e;
  return rounded(best_tube(outline_of(points)), [&](DVec3 a, DVec3 b) {
    double farthest = 0.0;
    for (const Vec3& p : points) farthest = max(farthest, length(DVec3(p) - nearest_on(a, b, DVec3(p))));
    return farthest;
  });
}

BoundingCapsule merge(const BoundingCapsule& a, const BoundingCapsule& b) {
  const FloatMode mode;
  if (encloses(a, b)) return a;
  if (encloses(b, a)) return b;
  const BoundingCapsule& thick = a.radius >= b.radius ? a : b;
  const BoundingCapsule& thin = a.radius >= b.radius ? b : a;
  const auto farthest = [&](DVec3 from, DVec3 to) {
    double needed = 0.0;
    for (const BoundingCapsule* each : {&a, &b}) {
      for (const Vec3& end : {each->a, each->b}) {
        needed = max(needed, length(DVec3(end) - nearest_on(from, to, DVec3(end))) + double(each->radius));
      }
    }
    return needed;
  };
  // The capsule around the four ends, or the thicker one extended to the ends of the other.
  const Vec3 ends[4] = {a.a, a.b, b.a, b.b};
  const BoundingCapsule around = rounded(best_tube(outline_of(ends)), farthest);
  Tube longer{DVec3(thick.a), DVec3(thick.b), 0.0};
  const DVec3 direction = unit(longer.b - longer.a);
  for (const Vec3& end : {thin.a, thin.b}) {
    const double along = dot(direction, DVec3(end) - longer.a);
    if (along < 0.0) longer.a += along * direction;
    if (along > length(longer.b - longer.a)) longer.b = longer.a + along * direction;
  }
  const BoundingCapsule lengthened = rounded(longer, farthest);
  return volume(around) < volume(lengthened) ? around : lengthened;
}

bool overlap(const BoundingCapsule& a, const BoundingCapsule& b) {
  const double radii = double(a.radius) + double(b.radius);
  return squared_distance(DVec3(a.a), DVec3(a.b), DVec3(b.a), DVec3(b.b)) <= radii * radii;
}
bool contains(const BoundingCapsule& capsule, Vec3 point) {
  const DVec3 p(point);
  return length(p - nearest_on(DVec3(capsule.a), DVec3(capsule.b), p)) <= double(capsule.radius);
}
double volume(const BoundingCapsule& capsule) {
  return Tube{DVec3(capsule.a), DVec3(capsule.b), double(capsule.radius)}.volume();
}
double surface_area(const BoundingCapsule& capsule) {
  const auto r = double(capsule.radius);
  return 2.0 * kPiDouble * r * (length(DVec3(capsule.b) - DVec3(capsule.a)) + 2.0 * r);
}

}  // namespace gyre
