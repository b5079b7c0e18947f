// Closed forms for spheres and capsules. See manifold_round.h.
#include "geometry/manifold_round.h"

#include "geometry/clip.h"
#include "geometry/closest.h"
#include "geometry/gjk.h"
#include "geometry/hull.h"

namespace gyre {
namespace {

// Capsules that lean less than this sine against each other (6 degrees) touch in two points.
constexpr float kSideBySide = 0.1f;
// ... while they lie over each other within this part of the smaller radius: the separation is then within 0.5 % of it.
constexpr float kSideways = 0.1f;

// A point near a shape's surface: where, which way is out, and how far out the asked point lies (negative inside).
struct SurfacePoint {
  Vec3 point;   // of the core's surface
  Vec3 normal;  // unit, outward
  float distance;
};

// From a nearest point found outside. `fallback` stands in when `p` lies on the surface.
SurfacePoint outside(Vec3 p, Vec3 nearest, Vec3 fallback) {
  const Vec3 d = p - nearest;
  return {nearest, normalized(d, fallback), length(d)};
}

SurfacePoint nearest_on_box(Vec3 p, Vec3 h) {
  const Vec3 nearest{clamp(p.x, -h.x, h.x), clamp(p.y, -h.y, h.y), clamp(p.z, -h.z, h.z)};
  if (!(nearest == p)) return outside(p, nearest, {0, 1, 0});
  // Inside: through the nearest face.
  const Vec3 depth = h - absolute(p);
  const int axis = depth.x <= depth.y && depth.x <= depth.z ? 0 : depth.y <= depth.z ? 1 : 2;
  const float sign = p[axis] < 0.0f ? -1.0f : 1.0f;
  const Vec3 normal{axis == 0 ? sign : 0.0f, axis == 1 ? sign : 0.0f, axis == 2 ? sign : 0.0f};
  return {p + depth[axis] * normal, normal, -depth[axis]};
}

// Solids of revolution are worked in the half plane through the axis and the point: r outward, y along the axis.
struct Profile {
  float r, y;    // of the point
  Vec3 outward;  // unit direction of r

  explicit Profile(Vec3 p)
      : r(std::sqrt(p.x * p.x + p.z * p.z)), y(p.y), outward(normalized(Vec3{p.x, 0, p.z})) {}
  Vec3 at(float radial, float height) const { return radial * outward + Vec3{0, height, 0}; }
};

SurfacePoint nearest_on_cylinder(Vec3 p, float radius, float h) {
  const Profile q(p);
  const float sign = p.y < 0.0f ? -1.0f : 1.0f;
  if (q.r > radius || absolute(q.y) > h) {
    // On the mantle or a cap the direction is exact; only past a rim it slants.
    if (absolute(q.y) <= h) return {q.at(radius, q.y), q.outward, q.r - radius};
    if (q.r <= radius) return {{p.x, sign * h, p.z}, {0, sign, 0}, absolute(q.y) - h};
    return outside(p, q.at(radius, sign * h), {0, sign, 0});
  }
  const float to_cap = h - absolute(q.y), to_mantle = radius - q.r;
  if (to_cap < to_mantle) return {{p.x, sign * h, p.z}, {0, sign, 0}, -to_cap};
  return {q.at(radius, q.y), q.outward, -to_mantle};
}

SurfacePoint nearest_on_cone(Vec3 p, float radius, float h) {
  const Profile q(p);
  const float slant = std::sqrt(radius * radius + 4.0f * h * h);
  const float n_r = 2.0f * h / slant, n_y = radius / slant;  // outward normal of the mantle
  const float above_mantle = n_r * q.r + n_y * (q.y - h), below_base = -h - q.y;
  // Length along the mantle line from the apex.
  const float along = n_y * q.r - n_r * (q.y - h);
  if (above_mantle <= 0.0f && below_base <= 0.0f) {
    if (above_mantle > below_base) {
      const float r = q.r - above_mantle * n_r, y = q.y - above_mantle * n_y;
      return {q.at(r, y), q.at(n_r, n_y), above_mantle};
    }
    return {{p.x, -h, p.z}, {0, -1, 0}, below_base};
  }
  if (below_base > 0.0f && q.r <= radius) return {{p.x, -h, p.z}, {0, -1, 0}, below_base};
  if (along <= 0.0f) return outside(p, {0, h, 0}, {0, 1, 0});
  if (along >= slant) return outside(p, q.at(radius, -h), {0, -1, 0});
  return {q.at(q.r - above_mantle * n_r, q.y - above_mantle * n_y), q.at(n_r, n_y), above_mantle};
}

SurfacePoint nearest_on_hull(const Shape& shape, Vec3 p, float reach) {
  const Hull& hull = *shape.hull;
  int face = 0;
  float best = -kUnbounded;
  for (int f = 0; f < hull.face_count(); ++f) {
    const HullPlane& plane = hull.planes[std::size_t(f)];
    const float height = dot(plane.normal, p) - plane.offset;
    if (height > best) {
      best = height;
      face = f;
    }
  }
  const HullPlane& plane = hull.planes[std::size_t(face)];
  const SurfacePoint over_face{p - best * plane.normal, plane.normal, best};
  if (best <= 0.0f || best > reach) return over_face;
  // Outside: over the face's polygon its normal is exact, else an edge or vertex is nearest.
  const std::uint32_t begin = hull.face_offsets[std::size_t(face)],
                      end = hull.face_offsets[std::size_t(face) + 1];
  bool over = true;
  for (std::uint32_t i = begin; i < end && over; ++i) {
    const Vec3 from = hull.vertices[hull.face_vertices[i]];
    const Vec3 to = hull.vertices[hull.face_vertices[i + 1 == end ? begin : i + 1]];
    over = dot(cross(to - from, plane.normal), p - from) <= 0.0f;
  }
  if (over) return over_face;
  const Shape point{};
  const CorePair pair(shape, point, {p, {}});
  const CoreDistance found = core_distance(pair, double(reach), plane.normal);
  if (found.beyond) return {p - best * plane.normal, plane.normal, kUnbounded};
  if (found.overlap) return over_face;
  return {to_float(found.on_a), to_float(found.normal), float(found.distance)};
}

SurfacePoint nearest_on_core(const Shape& shape, Vec3 p, float reach) {
  const float h = shape.extents.y;
  switch (shape.kind) {
    case ShapeKind::box:
      return nearest_on_box(p, shape.extents);
    case ShapeKind::capsule:
      // A point on the segment itself leaves it sideways.
      return outside(p, {0.0f, clamp(p.y, -h, h), 0.0f}, {1, 0, 0});
    case ShapeKind::cylinder:
      return nearest_on_cylinder(p, shape.radius, h);
    case ShapeKind::cone:
      return nearest_on_cone(p, shape.radius, h);
    case ShapeKind::hull:
      return nearest_on_hull(shape, p, reach);
    default:
      return outside(p, {}, {0, 1, 0});
  }
}

// `sphere_at` is the sphere's centre in the shape's frame. The result's normal points from the shape to the sphere.
bool touch_sphere(const Shape& shape, float sphere_radius, Vec3 sphere_at, float max_separation,
                  ManifoldPoint& point, Vec3& normal) {
  const float radius = core_radius(shape);
  const SurfacePoint near = nearest_on_core(shape, sphere_at, radius + sphere_radius + max_separation);
  point.separation = near.distance - radius - sphere_radius;
  if (!(point.separation <= max_separation)) return false;
  point.position = near.point + (radius + 0.5f * point.separation) * near.normal;
  point.feature = kFeatureNearest;
  normal = near.normal;
  return true;
}

void collide_capsules(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                      LocalManifold& out) {
  FacePolygon fa, fb;
  fa.count = fb.count = 2;
  fa.ids[1] = fb.ids[1] = 1;
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
      &fa, &fb, out.normal, a.radius, b.radius, max_separation, kSideways * min(a.radius, b.radius)};
  const float sine_squared = length_squared(cross(up, up_b));
  if (sine_squared <= square(kSideBySide * a.extents.y * b.extents.y))
    out.count = clip_segments(pair, out.points);
  if (out.count == 2) return;
  out.count = 1;
  out.points[0].separation = float(gap - double(a.radius) - double(b.radius));
  out.points[0].position =
      0.5f * ((to_float(near.on_a) + a.radius * out.normal) + (to_float(near.on_b) - b.radius * out.normal));
  out.points[0].feature = kFeatureNearest;
}

}  // namespace

void collide_round(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache&, LocalManifold& out) {
  out.count = 0;
  ManifoldPoint& point = out.points[0];
  if (b.kind == ShapeKind::sphere) {
    if (touch_sphere(a, b.radius, a_from_b.position, max_separation, point, out.normal)) out.count = 1;
    return;
  }
  if (a.kind == ShapeKind::sphere) {
    Vec3 normal;
    const Vec3 center = inverse_times(a_from_b, Vec3{});
    if (!touch_sphere(b, a.radius, center, max_separation, point, normal)) return;
    out.count = 1;
    out.normal = -rotate(a_from_b.orientation, normal);
    point.position = a_from_b * point.position;
    return;
  }
  collide_capsules(a, b, a_from_b, max_separation, out);
}

}  // namespace gyre
