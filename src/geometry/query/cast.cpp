// Rays against convex shapes and planes, as intervals of the ray that lie inside. See cast.h.
#include "geometry/query/cast.h"

#include "geometry/query/cast_surface.h"
#include "geometry/shape/hull.h"

namespace gyre {
namespace {

constexpr double kInfinite = __builtin_huge_val();
// A ray whose stretch inside is shorter than this part of the shape's size, and lies behind it, has started on the surface
// and leaves.
constexpr double kOnSurface = 1.0e-9;
// Farther away than so many sizes the ray is moved along itself to where it is nearest: squares of its distance from the
// shape would drown the shape.
constexpr double kFar = 8.0;

// The stretch of a ray that lies inside something, as fractions of its way.
struct Stretch {
  double enter = -kInfinite, leave = kInfinite;
  DVec3 normal;  // where it enters, if flat there
  bool empty() const { return !(enter <= leave); }
  static Stretch none() { return {kInfinite, -kInfinite, {}}; }
};

// Cuts off what lies outside the half-space {p : height(p) <= 0}; the height is `height` at the origin and climbs by `rate`.
void cut(Stretch& s, double height, double rate, DVec3 normal) {
  if (rate == 0.0) {
    if (height > 0.0) s = Stretch::none();
    return;
  }
  const double t = -height / rate;
  if (rate < 0.0) {
    if (t > s.enter) {
      s.enter = t;
      s.normal = normal;
    }
  } else {
    s.leave = min(s.leave, t);
  }
}

void cut_slab(Stretch& s, double place, double rate, double half, DVec3 axis) {
  cut(s, place - half, rate, axis);
  cut(s, -place - half, -rate, -axis);
}

// The stretch in which a t^2 + 2 b t + c <= 0, for a >= 0.
Stretch inside_quadric(double a, double b, double c) {
  if (a == 0.0) return c <= 0.0 ? Stretch{} : Stretch::none();
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0.0)) return Stretch::none();
  // Without the difference of nearly equal numbers.
  const double q = -(b + (b < 0.0 ? -std::sqrt(discriminant) : std::sqrt(discriminant)));
  const double t1 = q / a, t2 = q == 0.0 ? t1 : c / q;
  return {min(t1, t2), max(t1, t2), {}};
}

Stretch inside_ball(const LocalRay& ray, DVec3 center, double radius) {
  const DVec3 o = ray.origin - center;
  return inside_quadric(dot(ray.way, ray.way), dot(o, ray.way), dot(o, o) - radius * radius);
}

// An infinite cylinder of the given radius along `axis` (0, 1 or 2), cut to a half length.
Stretch inside_rod(const LocalRay& ray, DVec3 center, int axis, double radius, double half) {
  const DVec3 o = ray.origin - center;
  const int i = axis == 2 ? 0 : axis + 1, j = axis == 0 ? 2 : axis - 1;
  const double a = ray.way[i] * ray.way[i] + ray.way[j] * ray.way[j];
  const double b = o[i] * ray.way[i] + o[j] * ray.way[j];
  Stretch s = inside_quadric(a, b, o[i] * o[i] + o[j] * o[j] - radius * radius);
  const DVec3 along{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
  cut_slab(s, o[axis], ray.way[axis], half, along);
  return s;
}

Stretch inside_box(const LocalRay& ray, DVec3 half) {
  Stretch s;
  cut_slab(s, ray.origin.x, ray.way.x, half.x, {1, 0, 0});
  cut_slab(s, ray.origin.y, ray.way.y, half.y, {0, 1, 0});
  cut_slab(s, ray.origin.z, ray.way.z, half.z, {0, 0, 1});
  return s;
}

// What two parts of one convex shape hold together; where one enters from the other is of no interest.
void join(Stretch& s, const Stretch& part) {
  if (part.empty()) return;
  if (s.empty()) {
    s = part;
    return;
  }
  if (part.enter < s.enter) {
    s.enter = part.enter;
    s.normal = part.normal;
  }
  s.leave = max(s.leave, part.leave);
}

// A point, segment or box swept by a ball: the rods along its edges, the balls at its corners, and the box itself pushed
// out along each axis.
Stretch inside_rounded_core(const LocalRay& ray, DVec3 core, double radius) {
  if (inside_box(ray, core + DVec3{radius, radius, radius}).empty()) return Stretch::none();
  Stretch s = Stretch::none();
  const double extent[3] = {core.x, core.y, core.z};
  if (extent[0] > 0.0 || extent[1] > 0.0 || extent[2] > 0.0) {
    for (int axis = 0; axis < 3; ++axis) {
      const int i = axis == 2 ? 0 : axis + 1, j = axis == 0 ? 2 : axis - 1;
      double out[3] = {extent[0], extent[1], extent[2]};
      out[axis] += radius;
      if (extent[i] > 0.0 || extent[j] > 0.0) join(s, inside_box(ray, {out[0], out[1], out[2]}));
      for (int corner = 0; corner < 4 && extent[axis] > 0.0; ++corner) {
        if ((corner & 1 && extent[i] == 0.0) || (corner & 2 && extent[j] == 0.0)) continue;
        double at[3] = {};
        at[i] = corner & 1 ? -extent[i] : extent[i];
        at[j] = corner & 2 ? -extent[j] : extent[j];
        join(s, inside_rod(ray, {at[0], at[1], at[2]}, axis, radius, extent[axis]));
      }
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    double at[3];
    bool twice = false;
    for (int axis = 0; axis < 3; ++axis) {
      const bool low = (corner >> axis & 1) != 0;
      twice = twice || (low && extent[axis] == 0.0);
      at[axis] = low ? -extent[axis] : extent[axis];
    }
    if (!twice) join(s, inside_ball(ray, {at[0], at[1], at[2]}, radius));
  }
  s.normal = {};
  return s;
}

// All points below the apex (0, h, 0), above -h, within slope * (distance below the apex) of the axis.
Stretch inside_cone(const LocalRay& ray, double radius, double h) {
  const double slope = radius / (2.0 * h);
  const DVec3 d = ray.way;
  const DVec3 o{ray.origin.x, ray.origin.y - h, ray.origin.z};  // seen from the apex
  const double a = d.x * d.x + d.z * d.z - slope * slope * d.y * d.y;
  const double b = o.x * d.x + o.z * d.z - slope * slope * o.y * d.y;
  const double c = o.x * o.x + o.z * o.z - slope * slope * o.y * o.y;
  Stretch s;
  if (a > 0.0) {
    s = inside_quadric(a, b, c);
    // Both crossings are of one of the two halves of the double cone.
    if (!s.empty() && o.y + 0.5 * (s.enter + s.leave) * d.y > 0.0) return Stretch::none();
  } else if (a < 0.0) {
    // Steeper than the mantle: one crossing on each half, and all beyond the one on this half.
    const double root = std::sqrt(max(b * b - a * c, 0.0));
    const double q = -(b + (b < 0.0 ? -root : root));
    const double t1 = q / a, t2 = q == 0.0 ? t1 : c / q;
    if (d.y < 0.0) {
      s.enter = max(t1, t2);
    } else {
      s.leave = min(t1, t2);
    }
  } else if (d.y == 0.0) {
    if (c > 0.0 || o.y > 0.0) return Stretch::none();  // no way at all
  } else {
    // Along the mantle: one crossing, or none if it runs within the surface or outside.
    if (b == 0.0 && c > 0.0) return Stretch::none();
    if (b != 0.0) (b < 0.0 ? s.enter : s.leave) = -c / (2.0 * b);
  }
  cut(s, -o.y - 2.0 * h, -d.y, {0, -1, 0});
  cut(s, o.y, d.y, {0, 1, 0});
  return s;
}

Stretch inside_hull(const LocalRay& ray, const Hull& hull) {
  Stretch s;
  for (const HullPlane& plane : hull.planes) {
    const DVec3 n(plane.normal);
    cut(s, dot(n, ray.origin) - double(plane.offset), dot(n, ray.way), n);
    if (s.empty()) return s;
  }
  return s;
}

Stretch inside_plane(const LocalRay& ray, const Shape& plane) {
  const DVec3 n(plane.extents);
  Stretch s;
  cut(s, dot(n, ray.origin) - double(plane.offset), dot(n, ray.way), n);
  return s;
}

Stretch stretch_inside(const Shape& shape, const LocalRay& ray) {
  const auto radius = double(shape.radius), h = double(shape.extents.y);
  switch (shape.kind) {
    case ShapeKind::sphere:
      return inside_ball(ray, {}, radius);
    case ShapeKind::box:
      return radius > 0.0 ? inside_rounded_core(ray, DVec3(shape.extents), radius)
                          : inside_box(ray, DVec3(shape.extents));
    case ShapeKind::capsule: {
      Stretch s = inside_rod(ray, {}, 1, radius, h);
      join(s, inside_ball(ray, {0, h, 0}, radius));
      join(s, inside_ball(ray, {0, -h, 0}, radius));
      s.normal = {};
      return s;
    }
    case ShapeKind::cylinder:
      return inside_rod(ray, {}, 1, radius, h);
    case ShapeKind::cone:
      return inside_cone(ray, radius, h);
    case ShapeKind::hull:
      return inside_hull(ray, *shape.hull);
    default:
      return inside_plane(ray, shape);
  }
}

// The outward normal at a point of a curved part of the surface.
DVec3 curved_normal(const Shape& shape, DVec3 p) {
  DVec3 n = p;
  if (shape.kind == ShapeKind::cylinder) {
    n = {p.x, 0.0, p.z};
  } else if (shape.kind == ShapeKind::cone) {
    const double radial = std::sqrt(p.x * p.x + p.z * p.z);
    n = {p.x, radial * double(shape.radius) / (2.0 * double(shape.extents.y)), p.z};
  } else {
    const DVec3 e(shape.kind == ShapeKind::sphere ? Vec3{} : shape.extents);
    n = {p.x - clamp(p.x, -e.x, e.x), p.y - clamp(p.y, -e.y, e.y), p.z - clamp(p.z, -e.z, e.z)};
  }
  const double size = length(n);
  return size > 0.0 ? n / size : DVec3{0, 1, 0};  // the apex of a cone
}

DVec3 against(DVec3 way) {
  const double size = length(way);
  return size > 0.0 ? -(way / size) : DVec3{};
}

// A length that is as large as the shape, and its middle; 0 for planes, which have none.
double size_of(const Shape& shape, DVec3& middle) {
  if (shape.kind == ShapeKind::plane) return 0.0;
  if (shape.kind == ShapeKind::hull) {
    middle = DVec3(center(shape.hull->box));
    return double(largest(half_size(shape.hull->box)));
  }
  return double(shape.radius) + double(shape.kind == ShapeKind::sphere ? 0.0f : largest(shape.extents));
}

}  // namespace

bool cast_ray(const Shape& shape, const LocalRay& ray, double reach, bool back_faces, LocalHit& hit) {
  if (shape.kind == ShapeKind::mesh || shape.kind == ShapeKind::height_field) {
    return cast_ray_at_surface(shape, ray, reach, back_faces, hit);
  }
  DVec3 middle;
  const double size = size_of(shape, middle), way_squared = dot(ray.way, ray.way);
  const double before = size > 0.0 && way_squared > 0.0 && length(ray.origin - middle) > kFar * size
                            ? dot(middle - ray.origin, ray.way) / way_squared
                            : 0.0;
  const LocalRay near_ray{ray.origin + before * ray.way, ray.way};
  Stretch s = stretch_inside(shape, near_ray);
  if (s.empty()) return false;
  const double enter = s.enter + before, leave = s.leave + before;
  if (enter > reach || leave < 0.0) return false;
  hit = {};
  if (enter < 0.0) {
    if (way_squared > 0.0 && leave * std::sqrt(way_squared) <= kOnSurface * size) return false;
    hit.inside = true;
    hit.point = ray.origin;
    hit.normal = against(ray.way);
    return true;
  }
  hit.fraction = enter;
  hit.point = near_ray.origin + s.enter * ray.way;
  hit.normal = s.normal == DVec3{} ? curved_normal(shape, hit.point) : s.normal;
  return true;
}

}  // namespace gyre
