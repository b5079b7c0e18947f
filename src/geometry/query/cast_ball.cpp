// Rays against swept points, segments, boxes and triangles. See cast_ball.h.
#include "geometry/query/cast_ball.h"

#include "geometry/distance/closest.h"

namespace gyre {
namespace {

constexpr double kNoImpact = __builtin_huge_val();

// The first t at which a t^2 + 2 b t + c falls to 0, or kNever; c > 0 at t = 0 but for rounding.
double falls_to_zero(double a, double b, double c) {
  if (!(b < 0.0)) return kNoImpact;
  if (c <= 0.0) return 0.0;
  const double discriminant = b * b - a * c;
  return discriminant >= 0.0 ? c / (std::sqrt(discriminant) - b) : kNoImpact;
}

// Clips the fractions to those inside a box of half extents `half`.
bool clip_to_box(DVec3 half, const LocalRay& ray, double& enter, double& leave) {
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.translation[axis], e = half[axis];
    if (d == 0.0) {
      if (absolute(o) > e) return false;
      continue;
    }
    const double inverse = 1.0 / d, to_low = (-e - o) * inverse, to_high = (e - o) * inverse;
    enter = max(enter, min(to_low, to_high));
    leave = min(leave, max(to_low, to_high));
  }
  return enter <= leave;
}

// The ray along one axis of a box: its current side of the box, and the fraction at which the side changes.
struct AxisPath {
  double start, speed, half;
  double side;  // -1 below the low face, 1 above the high one, 0 between them
  double next;  // fraction at which the side changes

  AxisPath(double from, double along, double extent) : start(from), speed(along), half(extent) {
    side = start > half ? 1.0 : start < -half ? -1.0 : 0.0;
    next = next_change();
  }
  double beyond(double time) const { return start + time * speed - side * half; }
  void advance() {
    side += speed < 0.0 ? -1.0 : 1.0;
    next = next_change();
  }

 private:
  double next_change() const {
    if (speed == 0.0 || side * speed > 0.0) return kNoImpact;
    // Downwards, the high face is passed from above it and the low face from between them. Upwards it is the reverse.
    const double face = speed < 0.0 ? (side > 0.0 ? half : -half) : (side < 0.0 ? -half : half);
    return (face - start) / speed;
  }
};

bool starts_apart(DVec3 core, double radii, DVec3 middle) {
  const DVec3 out{max(absolute(middle.x) - core.x, 0.0), max(absolute(middle.y) - core.y, 0.0),
                  max(absolute(middle.z) - core.z, 0.0)};
  return dot(out, out) > radii * radii;
}

}  // namespace

BallCast cast_ball_at_box(DVec3 core, double radii, const LocalRay& middle, double max_fraction,
                          BallImpact& impact) {
  double start = 0.0, end = kNoImpact;
  if (!clip_to_box(core + DVec3{radii, radii, radii}, middle, start, end) || start > max_fraction)
    return BallCast::misses;
  if (start == 0.0 && !starts_apart(core, radii, middle.origin)) return BallCast::unknown;
  // Start where the ray comes close, so that the numbers below are no larger than they must be.
  const DVec3 from = middle.origin + start * middle.translation;
  AxisPath axes[3] = {{from.x, middle.translation.x, core.x},
                      {from.y, middle.translation.y, core.y},
                      {from.z, middle.translation.z, core.z}};
  // Over a face, an edge or a corner the squared distance is one quadratic. The ray changes between these regions at
  // most six times.
  double now = 0.0;
  for (int step = 0; step < 7; ++step) {
    double a = 0.0, b = 0.0, c = -radii * radii;
    int first = 0;
    for (int i = 0; i < 3; ++i) {
      if (axes[i].next < axes[first].next) first = i;
      if (axes[i].side == 0.0) continue;
      const double out = axes[i].beyond(now);
      a += axes[i].speed * axes[i].speed;
      b += axes[i].speed * out;
      c += out * out;
    }
    const double time = now + falls_to_zero(a, b, c), next = axes[first].next;
    if (time <= next && time < kNoImpact) {
      impact.fraction = start + time;
      if (impact.fraction > max_fraction) return BallCast::misses;
      const DVec3 at = from + time * middle.translation;
      impact.on_core = {axes[0].side == 0.0 ? at.x : axes[0].side * core.x,
                        axes[1].side == 0.0 ? at.y : axes[1].side * core.y,
                        axes[2].side == 0.0 ? at.z : axes[2].side * core.z};
      const DVec3 out = at - impact.on_core;
      const double size = length(out);
      impact.normal = size > 0.0 ? out / size : -(middle.translation / length(middle.translation));
      return BallCast::hits;
    }
    if (next > end - start || next == kNoImpact) return BallCast::misses;
    now = max(now, next);
    axes[first].advance();
  }
  return BallCast::misses;
}

namespace {

// A ray against the edge from p to q rounded by the radius.
void cast_at_edge(DVec3 p, DVec3 q, double radius, const LocalRay& ray, double& nearest, DVec3& on_core) {
  const DVec3 along = q - p, from = ray.origin - p;
  const double squared = dot(along, along);
  if (!(squared > 0.0)) return;
  // Along the edge, relative to its length: the start and the rate; and the components perpendicular to the edge.
  const double start = dot(from, along) / squared, rate = dot(ray.translation, along) / squared;
  const DVec3 out = from - start * along, across = ray.translation - rate * along;
  const double a = dot(across, across), b = dot(out, across), c = dot(out, out) - radius * radius;
  double time = c > 0.0 ? falls_to_zero(a, b, c) : 0.0;
  if (time > nearest) return;
  double fraction = start + time * rate;
  if (fraction >= 0.0 && fraction <= 1.0) {
    if (!(b < 0.0)) return;
  } else {
    // Beyond an end, whose ball is hit first if anything is.
    fraction = fraction < 0.5 ? 0.0 : 1.0;
    const DVec3 beside = from - fraction * along;
    time = falls_to_zero(dot(ray.translation, ray.translation), dot(beside, ray.translation),
                         dot(beside, beside) - radius * radius);
  }
  if (!(time < nearest)) return;
  nearest = time;
  on_core = p + fraction * along;
}

bool projects_into(const DVec3 (&corners)[3], DVec3 facing, DVec3 point) {
  for (int i = 0; i < 3; ++i) {
    const DVec3 edge = corners[i == 2 ? 0 : i + 1] - corners[i];
    if (dot(cross(facing, edge), point - corners[i]) < 0.0) return false;
  }
  return true;
}

// Height relative to its size below which a triangle has no reliable normal.
constexpr double kSliver = 1.0e-6;

bool facing_of(const DVec3 (&corners)[3], DVec3& facing, double& size) {
  const DVec3 u = corners[1] - corners[0], v = corners[2] - corners[0];
  facing = cross(u, v);
  const double squared = max(max(dot(u, u), dot(v, v)), dot(v - u, v - u)), area = length(facing);
  if (!(area > kSliver * squared)) return false;
  facing = facing / area;
  size = std::sqrt(squared);
  return true;
}

}  // namespace

BallCast cast_ball_at_triangle(const DVec3 (&corners)[3], double radius, const LocalRay& middle,
                               double max_fraction, BallImpact& impact) {
  DVec3 facing;
  double size;
  if (!facing_of(corners, facing, size)) return BallCast::unknown;
  const double height = dot(facing, middle.origin - corners[0]), rate = dot(facing, middle.translation);
  const double side = height < 0.0 ? -1.0 : 1.0, above = side * height - radius, falling = -side * rate;
  double start = 0.0;
  if (above > 0.0) {
    if (!(falling > 0.0)) return BallCast::misses;
    start = above / falling;
    if (start > max_fraction) return BallCast::misses;
    const DVec3 foot = middle.origin + start * middle.translation - (side * radius) * facing;
    if (projects_into(corners, facing, foot)) {
      impact = {start, foot, side * facing};
      return BallCast::hits;
    }
  } else {
    const SimplexPoint at_start = closest_on_triangle(middle.origin, corners[0], corners[1], corners[2]);
    if (!(length_squared(middle.origin - at_start.point) > radius * radius)) return BallCast::unknown;
    // A ray along the plane from far away: start where it comes close.
    const double path_length = length(middle.translation),
                 far_distance = length(middle.origin - corners[0]) - 2.0 * (size + radius);
    if (far_distance > 0.0 && path_length > 0.0) start = far_distance / path_length;
    if (start > max_fraction) return BallCast::misses;
  }
  const LocalRay near{middle.origin + start * middle.translation, middle.translation};
  // `max_fraction` is compared only at the end, so that it cannot change the result.
  double nearest = kNoImpact;
  for (int i = 0; i < 3; ++i)
    cast_at_edge(corners[i], corners[i == 2 ? 0 : i + 1], radius, near, nearest, impact.on_core);
  impact.fraction = start + nearest;
  if (impact.fraction > max_fraction) return BallCast::misses;
  const DVec3 out = near.origin + nearest * near.translation - impact.on_core;
  const double apart = length(out);
  impact.normal = apart > 0.0 ? out / apart : side * facing;
  return BallCast::hits;
}

}  // namespace gyre
