// Rays against swept points, segments, boxes and triangles. See cast_ball.h.
#include "geometry/query/cast_ball.h"

#include "geometry/distance/closest.h"

namespace gyre {
namespace {

constexpr double kNoImpact = __builtin_huge_val();

// Where a t^2 + 2 b t + c falls to 0 after t = 0, at which c > 0 but for rounding; kNoImpact if it does not.
double falls_to_zero(double a, double b, double c) {
  if (!(b < 0.0)) return kNoImpact;
  if (c <= 0.0) return 0.0;
  const double discriminant = b * b - a * c;
  return discriminant >= 0.0 ? c / (std::sqrt(discriminant) - b) : kNoImpact;
}

// The fractions from `enter` to `leave` within a box of half extents `half`.
bool clip_to_box(DVec3 half, const LocalRay& ray, double& enter, double& leave) {
  for (int axis = 0; axis < 3; ++axis) {
    const double o = ray.origin[axis], d = ray.way[axis], e = half[axis];
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

// The way along one axis of a box: beside which of its sides it is, and when it comes beside the next.
struct AxisWay {
  double place, way, half;
  double side;  // -1 below the low face, 1 above the high one, 0 between them
  double next;  // fraction at which the side changes

  AxisWay(double from, double along, double extent) : place(from), way(along), half(extent) {
    side = place > half ? 1.0 : place < -half ? -1.0 : 0.0;
    next = turn();
  }
  double beyond(double time) const { return place + time * way - side * half; }
  void go_on() {
    side += way < 0.0 ? -1.0 : 1.0;
    next = turn();
  }

 private:
  double turn() const {
    if (way == 0.0 || side * way > 0.0) return kNoImpact;
    // Going down, the high face is left from above it and the low one from between them.
    const double face = way < 0.0 ? (side > 0.0 ? half : -half) : (side < 0.0 ? -half : half);
    return (face - place) / way;
  }
};

bool starts_apart(DVec3 core, double radii, DVec3 middle) {
  const DVec3 out{max(absolute(middle.x) - core.x, 0.0), max(absolute(middle.y) - core.y, 0.0),
                  max(absolute(middle.z) - core.z, 0.0)};
  return dot(out, out) > radii * radii;
}

}  // namespace

BallCast cast_ball_at_box(DVec3 core, double radii, const LocalRay& middle, double reach,
                          BallImpact& impact) {
  double start = 0.0, end = kNoImpact;
  if (!clip_to_box(core + DVec3{radii, radii, radii}, middle, start, end) || start > reach)
    return BallCast::misses;
  if (start == 0.0 && !starts_apart(core, radii, middle.origin)) return BallCast::unknown;
  // Seen from where the way comes near, so that nothing below is larger than it must be.
  const DVec3 from = middle.origin + start * middle.way;
  AxisWay axes[3] = {
      {from.x, middle.way.x, core.x}, {from.y, middle.way.y, core.y}, {from.z, middle.way.z, core.z}};
  // Beside a face, an edge or a corner the squared distance is one quadratic; six times the way comes from one to the next.
  double now = 0.0;
  for (int part = 0; part < 7; ++part) {
    double a = 0.0, b = 0.0, c = -radii * radii;
    int first = 0;
    for (int i = 0; i < 3; ++i) {
      if (axes[i].next < axes[first].next) first = i;
      if (axes[i].side == 0.0) continue;
      const double out = axes[i].beyond(now);
      a += axes[i].way * axes[i].way;
      b += axes[i].way * out;
      c += out * out;
    }
    const double time = now + falls_to_zero(a, b, c), next = axes[first].next;
    if (time <= next && time < kNoImpact) {
      impact.fraction = start + time;
      if (impact.fraction > reach) return BallCast::misses;
      const DVec3 at = from + time * middle.way;
      impact.on_core = {axes[0].side == 0.0 ? at.x : axes[0].side * core.x,
                        axes[1].side == 0.0 ? at.y : axes[1].side * core.y,
                        axes[2].side == 0.0 ? at.z : axes[2].side * core.z};
      const DVec3 out = at - impact.on_core;
      const double size = length(out);
      impact.normal = size > 0.0 ? out / size : -(middle.way / length(middle.way));
      return BallCast::hits;
    }
    if (next > end - start || next == kNoImpact) return BallCast::misses;
    now = max(now, next);
    axes[first].go_on();
  }
  return BallCast::misses;
}

namespace {

// A ray against the edge from p to q swept by the radius.
void cast_at_edge(DVec3 p, DVec3 q, double radius, const LocalRay& ray, double& nearest, DVec3& on_core) {
  const DVec3 along = q - p, from = ray.origin - p;
  const double squared = dot(along, along);
  if (!(squared > 0.0)) return;
  // In parts of the edge, at the start and for each unit of fraction; and what is square to it.
  const double place = dot(from, along) / squared, rate = dot(ray.way, along) / squared;
  const DVec3 out = from - place * along, way = ray.way - rate * along;
  const double a = dot(way, way), b = dot(out, way), c = dot(out, out) - radius * radius;
  double time = c > 0.0 ? falls_to_zero(a, b, c) : 0.0;
  if (time > nearest) return;
  double part = place + time * rate;
  if (part >= 0.0 && part <= 1.0) {
    if (!(b < 0.0)) return;
  } else {
    // Beyond an end, whose ball is met first if anything is.
    part = part < 0.5 ? 0.0 : 1.0;
    const DVec3 beside = from - part * along;
    time = falls_to_zero(dot(ray.way, ray.way), dot(beside, ray.way), dot(beside, beside) - radius * radius);
  }
  if (!(time < nearest)) return;
  nearest = time;
  on_core = p + part * along;
}

bool holds(const DVec3 (&corners)[3], DVec3 facing, DVec3 point) {
  for (int i = 0; i < 3; ++i) {
    const DVec3 edge = corners[i == 2 ? 0 : i + 1] - corners[i];
    if (dot(cross(facing, edge), point - corners[i]) < 0.0) return false;
  }
  return true;
}

// A triangle flatter than this part of its size has no normal to rely on.
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

BallCast cast_ball_at_triangle(const DVec3 (&corners)[3], double radius, const LocalRay& middle, double reach,
                               BallImpact& impact) {
  DVec3 facing;
  double size;
  if (!facing_of(corners, facing, size)) return BallCast::unknown;
  const double height = dot(facing, middle.origin - corners[0]), rate = dot(facing, middle.way);
  const double side = height < 0.0 ? -1.0 : 1.0, above = side * height - radius, falling = -side * rate;
  double start = 0.0;
  if (above > 0.0) {
    if (!(falling > 0.0)) return BallCast::misses;
    start = above / falling;
    if (start > reach) return BallCast::misses;
    const DVec3 foot = middle.origin + start * middle.way - (side * radius) * facing;
    if (holds(corners, facing, foot)) {
      impact = {start, foot, side * facing};
      return BallCast::hits;
    }
  } else {
    const SimplexPoint at_start = closest_on_triangle(middle.origin, corners[0], corners[1], corners[2]);
    if (!(length_squared(middle.origin - at_start.point) > radius * radius)) return BallCast::unknown;
    // Along the plane from far away: seen from where the way comes near.
    const double way = length(middle.way), away = length(middle.origin - corners[0]) - 2.0 * (size + radius);
    if (away > 0.0 && way > 0.0) start = away / way;
    if (start > reach) return BallCast::misses;
  }
  const LocalRay near{middle.origin + start * middle.way, middle.way};
  // No farther than `reach` is asked in the end alone: what is found must not hang on it.
  double nearest = kNoImpact;
  for (int i = 0; i < 3; ++i)
    cast_at_edge(corners[i], corners[i == 2 ? 0 : i + 1], radius, near, nearest, impact.on_core);
  impact.fraction = start + nearest;
  if (impact.fraction > reach) return BallCast::misses;
  const DVec3 out = near.origin + nearest * near.way - impact.on_core;
  const double apart = length(out);
  impact.normal = apart > 0.0 ? out / apart : side * facing;
  return BallCast::hits;
}

}  // namespace gyre
