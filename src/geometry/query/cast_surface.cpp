// Watertight intersection of a ray with triangles. See cast_surface.h.
#include "geometry/query/cast_surface.h"

namespace gyre {

TriangleRay::TriangleRay(const LocalRay& ray) : origin_(ray.origin) {
  const DVec3 size{absolute(ray.translation.x), absolute(ray.translation.y), absolute(ray.translation.z)};
  z_ = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
  x_ = z_ == 2 ? 0 : z_ + 1;
  y_ = x_ == 2 ? 0 : x_ + 1;
  const double along = ray.translation[z_];
  if (along < 0.0) {  // the corners keep their orientation
    const int swap = x_;
    x_ = y_;
    y_ = swap;
  }
  if (along == 0.0) return;
  shear_x_ = ray.translation[x_] / along;
  shear_y_ = ray.translation[y_] / along;
  scale_ = 1.0 / along;
}

DVec3 TriangleRay::sheared(DVec3 corner) const {
  const DVec3 p = corner - origin_;
  const double z = p[z_];
  return {p[x_] - shear_x_ * z, p[y_] - shear_y_ * z, scale_ * z};
}

bool TriangleRay::crosses(DVec3 a, DVec3 b, DVec3 c, double& fraction, bool& front) const {
  const DVec3 p = sheared(a), q = sheared(b), r = sheared(c);
  // Twice the areas that the ray, now the z axis, spans with each edge. Two triangles that share an edge compute
  // exactly opposite numbers for it.
  const double u = r.x * q.y - r.y * q.x, v = p.x * r.y - p.y * r.x, w = q.x * p.y - q.y * p.x;
  if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) return false;
  const double area = u + v + w;
  if (area == 0.0 || scale_ == 0.0) return false;
  fraction = (u * p.z + v * q.z + w * r.z) / area;
  front = area > 0.0;
  return true;
}

Vec3 surface_normal(const Shape& surface, const SurfaceTriangle& triangle) {
  if (surface.kind == ShapeKind::mesh) return surface.mesh->normals[triangle.id];
  return triangle_normal(triangle.a, triangle.b, triangle.c);
}

bool clip_to_surface(const Shape& surface, const LocalRay& ray, Vec3 half, double max_fraction, double& from,
                     double& to) {
  const Aabb& box = surface.kind == ShapeKind::mesh ? surface.mesh->tree.box : surface.field->box;
  from = 0.0, to = max_fraction;
  const double slack = 1.0e-6 * double(largest(max(absolute(box.low), absolute(box.high))));
  for (int axis = 0; axis < 3; ++axis) {
    const double low = double(box.low[axis]) - double(half[axis]) - slack;
    const double high = double(box.high[axis]) + double(half[axis]) + slack;
    const double o = ray.origin[axis], d = ray.translation[axis];
    if (d == 0.0) {
      if (o < low || o > high) return false;
      continue;
    }
    const double t1 = (low - o) / d, t2 = (high - o) / d;
    from = max(from, min(t1, t2));
    to = min(to, max(t1, t2));
  }
  return from <= to;
}

bool cast_ray_at_surface(const Shape& surface, const LocalRay& ray, double max_fraction, bool back_faces,
                         LocalHit& hit) {
  const TriangleRay crossing(ray);
  const bool both_sides = back_faces || is_double_sided(surface);
  bool found = false, from_front = true;
  SurfaceTriangle nearest{};
  walk_triangles(surface, ray, {}, max_fraction, [&](const SurfaceTriangle& triangle, double now) {
    LocalHit next;
    bool front;
    if (!crossing.crosses(triangle.a, triangle.b, triangle.c, next.fraction, front)) return now;
    if (next.fraction < 0.0 || next.fraction > now || !(front || both_sides)) return now;
    next.triangle = public_triangle(surface, triangle.id);
    if (found && !comes_before(next, hit)) return now;
    hit = next;
    found = true;
    from_front = front;
    nearest = triangle;
    return next.fraction;
  });
  if (!found) return false;
  const DVec3 normal(surface_normal(surface, nearest));
  hit.normal = from_front ? normal : -normal;
  hit.point = ray.origin + hit.fraction * ray.translation;
  return true;
}

}  // namespace gyre
