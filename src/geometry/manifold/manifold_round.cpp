// Closed forms for spheres and capsules. See manifold_round.h.
#include "geometry/manifold/manifold_round.h"

#include "geometry/manifold/clip.h"
#include "geometry/distance/closest.h"
#include "geometry/distance/gjk.h"
#include "geometry/shape/hull.h"

namespace gyre {
namespace {

// Two points stand for a contact if the nearer is within this part of the smaller radius of the nearest pair of points.
constexpr float kMissedByEnds = 0.01f;

// Worked in double: where a ball's middle all but lies on the surface, the way between the two is of rounding in float, and
// with it the normal.

// A point near a shape's surface: where, which way is out, and how far out the asked point lies (negative inside).
struct SurfacePoint {
  DVec3 point;   // of the core's surface
  DVec3 normal;  // unit, outward
  double distance;
};

// From a nearest point found outside. `fallback` stands in when `p` lies on the surface.
SurfacePoint outside(DVec3 p, DVec3 nearest, DVec3 fallback) {
  const DVec3 d = p - nearest;
  const double distance = length(d);
  return {nearest, distance > 0.0 ? d / distance : fallback, distance};
}

SurfacePoint nearest_on_box(DVec3 p, DVec3 h) {
  const DVec3 nearest{clamp(p.x, -h.x, h.x), clamp(p.y, -h.y, h.y), clamp(p.z, -h.z, h.z)};
  if (!(nearest == p)) return outside(p, nearest, {0, 1, 0});
  // Inside: through the nearest face.
  const DVec3 depth{h.x - absolute(p.x), h.y - absolute(p.y), h.z - absolute(p.z)};
  if (depth.x <= depth.y && depth.x <= depth.z) {
    const double sign = p.x < 0.0 ? -1.0 : 1.0;
    return {{sign * h.x, p.y, p.z}, {sign, 0, 0}, -depth.x};
  }
  if (depth.y <= depth.z) {
    const double sign = p.y < 0.0 ? -1.0 : 1.0;
    return {{p.x, sign * h.y, p.z}, {0, sign, 0}, -depth.y};
  }
  const double sign = p.z < 0.0 ? -1.0 : 1.0;
  return {{p.x, p.y, sign * h.z}, {0, 0, sign}, -depth.z};
}

// Solids of revolution are worked in the half plane through the axis and the point: r outward, y along the axis.
struct Profile {
  double r, y;    // of the point
  DVec3 outward;  // unit direction of r

  explicit Profile(DVec3 p) : r(std::sqrt(p.x * p.x + p.z * p.z)), y(p.y), outward{1, 0, 0} {
    if (r > 0.0) outward = DVec3{p.x / r, 0.0, p.z / r};
  }
  DVec3 at(double radial, double height) const { return radial * outward + DVec3{0, height, 0}; }
};

SurfacePoint nearest_on_cylinder(DVec3 p, double radius, double h) {
  const Profile q(p);
  const double sign = p.y < 0.0 ? -1.0 : 1.0;
  if (q.r > radius || absolute(q.y) > h) {
    // On the mantle or a cap the direction is exact; only past a rim it slants.
    if (absolute(q.y) <= h) return {q.at(radius, q.y), q.outward, q.r - radius};
    if (q.r <= radius) return {{p.x, sign * h, p.z}, {0, sign, 0}, absolute(q.y) - h};
    return outside(p, q.at(radius, sign * h), {0, sign, 0});
  }
  const double to_cap = h - absolute(q.y), to_mantle = radius - q.r;
  if (to_cap < to_mantle) return {{p.x, sign * h, p.z}, {0, sign, 0}, -to_cap};
  return {q.at(radius, q.y), q.outward, -to_mantle};
}

SurfacePoint nearest_on_cone(DVec3 p, double radius, double h) {
  const Profile q(p);
  const double slant = std::sqrt(radius * radius + 4.0 * h * h);
  const double n_r = 2.0 * h / slant, n_y = radius / slant;  // outward normal of the mantle
  const double above_mantle = n_r * q.r + n_y * (q.y - h), below_base = -h - q.y;
  // Length along the mantle line from the apex.
  const double along = n_y * q.r - n_r * (q.y - h);
  if (above_mantle <= 0.0 && below_base <= 0.0) {
    if (above_mantle > below_base) {
      const double r = q.r - above_mantle * n_r, y = q.y - above_mantle * n_y;
      return {q.at(r, y), q.at(n_r, n_y), above_mantle};
    }
    return {{p.x, -h, p.z}, {0, -1, 0}, below_base};
  }
  if (below_base > 0.0 && q.r <= radius) return {{p.x, -h, p.z}, {0, -1, 0}, below_base};
  if (along <= 0.0) return outside(p, {0, h, 0}, {0, 1, 0});
  if (along >= slant) return outside(p, q.at(radius, -h), {0, -1, 0});
  return {q.at(q.r - above_mantle * n_r, q.y - above_mantle * n_y), q.at(n_r, n_y), above_mantle};
}

SurfacePoint nearest_on_hull(const Shape& shape, DVec3 p, double reach) {
  const Hull& hull = *shape.hull;
  const Vec3 near_p = to_float(p);
  int face = 0;
  float highest = -kUnbounded;
  for (int f = 0; f < hull.face_count(); ++f) {
    const HullPlane& plane = hull.planes[std::size_t(f)];
    const float height = dot(plane.normal, near_p) - plane.offset;
    if (height > highest) {
      highest = height;
      face = f;
    }
  }
  const HullPlane& plane = hull.planes[std::size_t(face)];
  const DVec3 normal(plane.normal);
  const double best = dot(normal, p) - double(plane.offset);
  const SurfacePoint over_face{p - best * normal, normal, best};
  if (best <= 0.0 || best > reach) return over_face;
  // Outside: over the face's polygon its normal is exact, else an edge or vertex is nearest.
  const std::uint32_t begin = hull.face_offsets[std::size_t(face)],
                      end = hull.face_offsets[std::size_t(face) + 1];
  bool over = true;
  for (std::uint32_t i = begin; i < end && over; ++i) {
    const Vec3 from = hull.vertices[hull.face_vertices[i]];
    const Vec3 to = hull.vertices[hull.face_vertices[i + 1 == end ? begin : i + 1]];
    over = dot(cross(to - from, plane.normal), near_p - from) <= 0.0f;
  }
  if (over) return over_face;
  const Shape point{};
  const CorePair pair(shape, point, p, {});
  const CoreDistance found = core_distance(pair, reach, plane.normal);
  if (found.beyond) return {p - best * normal, normal, double(kUnbounded)};
  if (found.overlap) return over_face;
  return {found.on_a, found.normal, found.distance};
}

SurfacePoint nearest_on_core(const Shape& shape, DVec3 p, double reach) {
  const auto h = double(shape.extents.y), radius = double(shape.radius);
  switch (shape.kind) {
    case ShapeKind::box:
      return nearest_on_box(p, DVec3(shape.extents));
    case ShapeKind::capsule:
      // A point on the segment itself leaves it sideways.
      return outside(p, {0.0, clamp(p.y, -h, h), 0.0}, {1, 0, 0});
    case ShapeKind::cylinder:
      return nearest_on_cylinder(p, radius, h);
    case ShapeKind::cone:
      return nearest_on_cone(p, radius, h);
    case ShapeKind::hull:
      return nearest_on_hull(shape, p, reach);
    default:
      return outside(p, {}, {0, 1, 0});
  }
}

struct BallContact {
  double separation;
  DVec3 position, normal;
};

// `sphere_at` is the sphere's centre in the shape's frame. The result's normal points from the shape to the sphere.
bool touch_sphere(const Shape& shape, float sphere_radius, DVec3 sphere_at, float max_separation,
                  BallContact& out) {
  const auto radius = double(core_radius(shape)), ball = double(sphere_radius), most = double(max_separation);
  const SurfacePoint near = nearest_on_core(shape, sphere_at, radius + ball + most);
  out.separation = near.distance - radius - ball;
  if (!(out.separation <= most)) return false;
  out.position = near.point + (radius + 0.5 * out.separation) * near.normal;
  out.normal = near.normal;
  return true;
}

void collide_capsules(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                      LocalManifold& out) {
  FacePolygon fa, fb;
  fa.count = fb.count = 2;
  fa.ids[0] = fb.ids[0] = 0, fa.ids[1] = fb.ids[1] = 1;
  const Vec3 up{0, a.extents.y, 0}, up_b = rotate(a_from_b.orientation, {0, b.extents.y, 0}),
                                    t = a_from_b.position;
  fa.vertices[0] = -up, fa.vertices[1] = up;
  fb.vertices[0] = t - up_b, fb.vertices[1] = t + up_b;
  const SegmentPair near =
      closest_of_segments(DVec3(-up), DVec3(up), DVec3(fb.vertices[0]), DVec3(fb.vertices[1]));
  const DVec3 way = near.on_b - near.on_a;
  const double gap = length(way);
  out.points[0].separation = float(gap - double(a.radius) - double(b.radius));
  if (!(out.points[0].separation <= max_separation)) return;
  if (gap > 1.0e-9 * double(a.extents.y + b.extents.y + a.radius)) {
    out.normal = to_float(way / gap);
  } else {
    // Axes that cross: across both, from A to B's centre.
    const Vec3 sideways = any_perpendicular({0, 1, 0});
    out.normal = normalized(cross(up, up_b), sideways);
    if (dot(out.normal, t) < 0.0f) out.normal = -out.normal;
  }
  const FacePair pair{
      &fa, &fb, out.normal, a.radius, b.radius, max_separation, kMaxLateralOffset * min(a.radius, b.radius)};
  const float sine_squared = length_squared(cross(up, up_b)), nearest = out.points[0].separation;
  if (sine_squared <= square(kParallelSegmentSine * a.extents.y * b.extents.y)) {
    out.count = clip_segments(pair, out.points);
    // One behind the other, end to end, they share no stretch but what rounding makes of one.
    const float slack = kMissedByEnds * min(a.radius, b.radius);
    if (out.count == 2 && min(out.points[0].separation, out.points[1].separation) <= nearest + slack) return;
  }
  out.count = 1;
  out.points[0].separation = nearest;
  out.points[0].position =
      0.5f * ((to_float(near.on_a) + a.radius * out.normal) + (to_float(near.on_b) - b.radius * out.normal));
  out.points[0].feature = kFeatureNearest;
}

}  // namespace

void collide_round(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache&, LocalManifold& out) {
  out.count = 0;
  if (a.kind != ShapeKind::sphere && b.kind != ShapeKind::sphere)
    return collide_capsules(a, b, a_from_b, max_separation, out);
  BallContact contact;
  if (b.kind == ShapeKind::sphere) {
    if (!touch_sphere(a, b.radius, DVec3(a_from_b.position), max_separation, contact)) return;
  } else {
    const DVec3 position(a_from_b.position);
    const DQuat turn = normalized(to_double(a_from_b.orientation));
    if (!touch_sphere(b, a.radius, rotate_inverse(turn, -position), max_separation, contact)) return;
    contact.normal = -rotate(turn, contact.normal);
    contact.position = rotate(turn, contact.position) + position;
  }
  out.count = 1;
  out.normal = to_float(contact.normal);
  out.points[0] = {to_float(contact.position), float(contact.separation), kFeatureNearest};
}

}  // namespace gyre
