// Conservative advancement. See time_of_impact.h.
#include "collision/continuous/time_of_impact.h"

#include "collision/broadphase/fat_box.h"
#include "geometry/distance/gjk.h"
#include "geometry/shape/support.h"
#include "math/rotation.h"

namespace gyre {
namespace {

// Grazing rotations converge slowly. If this is not enough, the time reached so far counts as the impact, which is
// early but never late.
constexpr int kMaxSteps = 1000;
constexpr double kTolerance = 0.25;  // of the target
// The largest number of advances along one normal before the next search for the closest points.
constexpr int kMaxNormalAdvances = 8;

bool is_still(Vec3 rotation) { return rotation.x == 0.0f && rotation.y == 0.0f && rotation.z == 0.0f; }

// A convex and B a plane; the normal from A to B is opposite to the plane's.
Gap plane_gap(const Shape& a, const Pose& frame_a, const Shape& plane, const Pose& frame_plane) {
  const DVec3 normal(rotate(frame_plane.orientation, plane.extents));
  const Vec3 down = rotate_inverse(frame_a.orientation, -to_float(normal));
  const DVec3 lowest = frame_a * support(a, down);
  Gap gap;
  gap.normal = -normal;
  gap.distance = dot(normal, lowest - frame_plane.position) - double(plane.offset) - double(core_radius(a));
  return gap;
}

double rotation_rate(const SweptShape& shape, DVec3 normal) {
  if (is_still(shape.sweep->rotation)) return 0.0;
  return length(cross(DVec3(shape.sweep->rotation), normal)) * double(shape.radius);
}

DVec3 middle_at(const SweptShape& shape, const Pose& pose) {
  return pose.position + DVec3(rotate(pose.orientation, shape.sweep->center));
}

// An upper bound of the closing speed along a fixed direction.
double closing_rate(const SweptShape& a, const SweptShape& b, DVec3 velocity, DVec3 normal) {
  return dot(velocity, normal) + rotation_rate(a, normal) + rotation_rate(b, normal);
}

// The same along a direction that rotates with B, over a time; `from_b` is the vector from B's middle to A's. In B's
// frame the middle of A starts with w = v_a - v_b - turn_b x from_b, which changes in second order of the time as A
// moves on and the frame rotates. About its middle A rotates by its rotation relative to B. Far out on something large
// that rotates, this is much less than the speed of its farthest point.
double closing_rate_seen_from_b(const SweptShape& a, const SweptShape& b, DVec3 velocity, DVec3 from_b,
                                DVec3 normal, double time) {
  const DVec3 rotation_a(a.sweep->rotation), rotation_b(b.sweep->rotation);
  const auto radius = double(a.radius);
  const DVec3 begin = velocity - cross(rotation_b, from_b), relative = rotation_a - rotation_b;
  const double half_angle = 0.5 * time * length(rotation_b);
  const double straight = length(velocity) * (1.0 + 2.0 * half_angle) + length(begin);
  return dot(begin, normal) + radius * length(cross(relative, normal)) +
         half_angle * (straight + radius * length(relative));
}

double closing_rate(const SweptShape& a, const SweptShape& b, DVec3 velocity, DVec3 from_b, DVec3 normal,
                    double time) {
  const double rate = closing_rate(a, b, velocity, normal);
  return is_still(b.sweep->rotation)
             ? rate
             : min(rate, closing_rate_seen_from_b(a, b, velocity, from_b, normal, time));
}

// How far the core extends along a direction from its body's middle.
double extent_along(const SweptShape& a, double time, DVec3 normal) {
  const Quat orientation = is_still(a.sweep->rotation) ? a.sweep->pose.orientation
                                                       : integrate_rotation(a.sweep->pose.orientation,
                                                                            float(time) * a.sweep->rotation);
  const Vec3 in_body = rotate_inverse(orientation, to_float(normal));
  const Vec3 in_shape = rotate_inverse(a.body_from_shape.orientation, in_body);
  return double(dot(in_shape, support(*a.shape, in_shape))) +
         double(dot(in_body, a.body_from_shape.position - a.sweep->center));
}

// Advances along one normal without a search: the gap along it is never more than the distance. True if the shapes do
// not come within `target` before `end`; otherwise `time` advances as far as that normal allows. B does not rotate.
bool passes_along(const SweptShape& a, DVec3 velocity, const Gap& gap, double closing, double target,
                  double end, double& time) {
  const double start = time, extent_before = extent_along(a, start, gap.normal),
               straight = dot(velocity, gap.normal);
  double remaining = gap.distance - target;
  for (int i = 0; i < kMaxNormalAdvances && remaining > kTolerance * target; ++i) {
    time += remaining / closing;
    remaining = gap.distance - target - straight * (time - start) -
                (extent_along(a, time, gap.normal) - extent_before);
    if (closing * (end - time) <= remaining) return true;
  }
  return false;
}

Gap find_gap(const SweptShape& a, const SweptShape& b, const Pose& pose_a, const Pose& pose_b,
             double max_distance) {
  const Pose frame_a = pose_a * a.body_from_shape;
  const Pose frame_b = pose_b * b.body_from_shape;
  if (b.shape->kind == ShapeKind::plane) return plane_gap(*a.shape, frame_a, *b.shape, frame_b);
  if (a.shape->kind == ShapeKind::plane) {
    Gap gap = plane_gap(*b.shape, frame_b, *a.shape, frame_a);
    gap.normal = -gap.normal;
    return gap;
  }
  // In double, because one shape may be a million times as large as the other.
  const DQuat back = conjugate(normalized(to_double(frame_a.orientation)));
  const CorePair pair(*a.shape, *b.shape, rotate(back, frame_b.position - frame_a.position),
                      back * normalized(to_double(frame_b.orientation)));
  const double radii = double(core_radius(*a.shape)) + double(core_radius(*b.shape));
  const CoreDistance cores = core_distance(pair, max_distance + radii, Vec3{});
  Gap gap;
  gap.normal = rotate(conjugate(back), cores.normal);
  gap.distance = cores.overlap ? -radii : cores.distance - radii;
  gap.beyond = cores.beyond;
  return gap;
}

}  // namespace

Pose pose_at(const Sweep& sweep, double time) {
  Pose pose = sweep.pose;
  if (!is_still(sweep.rotation)) {
    pose.orientation = integrate_rotation(sweep.pose.orientation, float(time) * sweep.rotation);
    const Vec3 from_center =
        rotate(sweep.pose.orientation, sweep.center) - rotate(pose.orientation, sweep.center);
    pose.position += from_center;
  }
  pose.position += time * DVec3(sweep.translation);
  return pose;
}

SweptShape make_swept_shape(const Shape& shape, const Transform& body_from_shape, const Sweep& sweep) {
  return {&shape, body_from_shape, &sweep, outer_radius(shape, inverse_times(body_from_shape, sweep.center))};
}

Gap find_gap(const SweptShape& a, const SweptShape& b, double time, double max_distance) {
  return find_gap(a, b, pose_at(*a.sweep, time), pose_at(*b.sweep, time), max_distance);
}

Impact time_of_impact(const SweptShape& a, const SweptShape& b, double start, double end, double target) {
  const DVec3 velocity = DVec3(a.sweep->translation) - DVec3(b.sweep->translation);
  double time = start;
  for (int i = 0; i < kMaxSteps; ++i) {
    // An upper bound of the closing speed in any direction.
    double max_rate = length(velocity);
    if (!is_still(a.sweep->rotation)) max_rate += double(length(a.sweep->rotation)) * double(a.radius);
    if (!is_still(b.sweep->rotation)) max_rate += double(length(b.sweep->rotation)) * double(b.radius);
    const Pose pose_a = pose_at(*a.sweep, time), pose_b = pose_at(*b.sweep, time);
    const Gap gap = find_gap(a, b, pose_a, pose_b, target + max_rate * (end - time));
    if (gap.beyond) return {};
    const double remaining = gap.distance - target;
    if (remaining <= kTolerance * target) return {true, time};
    const DVec3 from_b = middle_at(a, pose_a) - middle_at(b, pose_b);
    const double closing = closing_rate(a, b, velocity, from_b, gap.normal, end - time);
    // Velocity and angular velocity are constant: a pair that does not close along one normal now never does.
    if (closing * (end - time) <= remaining) return {};
    const bool searched = a.shape->kind != ShapeKind::plane && b.shape->kind != ShapeKind::plane;
    if (searched && !is_still(a.sweep->rotation) && is_still(b.sweep->rotation)) {
      if (passes_along(a, velocity, gap, closing, target, end, time)) return {};
    } else {
      time += remaining / closing;
    }
  }
  return {true, time};
}

bool stays_clear(const SweptShape& a, const SweptShape& b, double start, double end, double distance) {
  if (a.shape->kind == ShapeKind::plane || b.shape->kind == ShapeKind::plane) return false;
  const Pose pose_a = start > 0.0 ? pose_at(*a.sweep, start) : a.sweep->pose;
  const Pose pose_b = start > 0.0 ? pose_at(*b.sweep, start) : b.sweep->pose;
  const Pose frame_b = pose_b * b.body_from_shape;
  const Transform b_from_a = inverse_times(frame_b, pose_a * a.body_from_shape);
  const Aabb box_a = bounds(*a.shape, b_from_a), box_b = bounds(*b.shape, {});
  // As in world_box: bounds() loses some digits.
  const bool has_disc = a.shape->kind == ShapeKind::cylinder || a.shape->kind == ShapeKind::cone;
  const float scale = max(max(largest(absolute(box_a.low)), largest(absolute(box_a.high))),
                          max(largest(absolute(box_b.low)), largest(absolute(box_b.high))));
  const double slack =
      distance + 4.0e-6 * double(scale) + (has_disc ? 6.0e-4 * double(a.shape->radius) : 0.0);
  const DVec3 velocity = DVec3(a.sweep->translation) - DVec3(b.sweep->translation);
  const DVec3 from_b = middle_at(a, pose_a) - middle_at(b, pose_b);
  for (int axis = 0; axis < 3; ++axis) {
    const double above = double(box_a.low[axis]) - double(box_b.high[axis]);
    const double below = double(box_b.low[axis]) - double(box_a.high[axis]);
    const double apart = max(above, below) - slack;
    if (!(apart > 0.0)) continue;
    const float sign = above > below ? -1.0f : 1.0f;
    const Vec3 side{axis == 0 ? sign : 0.0f, axis == 1 ? sign : 0.0f, axis == 2 ? sign : 0.0f};
    const DVec3 normal(rotate(frame_b.orientation, side));  // from A to B
    if ((end - start) * closing_rate(a, b, velocity, from_b, normal, end - start) < apart) return true;
  }
  return false;
}

}  // namespace gyre
