// Conservative advancement. See time_of_impact.h.
#include "collision/time_of_impact.h"

#include "collision/fat_box.h"
#include "geometry/gjk.h"
#include "geometry/support.h"
#include "math/rotation.h"

namespace gyre {
namespace {

// Grazing turns converge slowly. Where this is not enough, the time reached so far counts as the impact: never late.
constexpr int kMaxSteps = 1000;
constexpr double kTolerance = 0.25;  // of the target

bool is_still(Vec3 turned) { return turned.x == 0.0f && turned.y == 0.0f && turned.z == 0.0f; }

// A convex and B plane; the normal from A to B is against the plane's.
Gap plane_gap(const Shape& a, const Pose& frame_a, const Shape& plane, const Pose& frame_plane) {
  const DVec3 normal(rotate(frame_plane.orientation, plane.extents));
  const Vec3 down = rotate_inverse(frame_a.orientation, -to_float(normal));
  const DVec3 lowest = frame_a * support(a, down);
  Gap gap;
  gap.normal = -normal;
  gap.distance = dot(normal, lowest - frame_plane.position) - double(plane.offset) - double(core_radius(a));
  return gap;
}

double turning(const SweptShape& shape, DVec3 normal) {
  if (is_still(shape.sweep->turned)) return 0.0;
  return length(cross(DVec3(shape.sweep->turned), normal)) * double(shape.radius);
}

}  // namespace

Pose pose_at(const Sweep& sweep, double time) {
  Pose pose = sweep.pose;
  if (!is_still(sweep.turned)) {
    pose.orientation = integrate_rotation(sweep.pose.orientation, float(time) * sweep.turned);
    const Vec3 from_center =
        rotate(sweep.pose.orientation, sweep.center) - rotate(pose.orientation, sweep.center);
    pose.position += from_center;
  }
  pose.position += time * DVec3(sweep.moved);
  return pose;
}

SweptShape make_swept_shape(const Shape& shape, const Transform& body_from_shape, const Sweep& sweep) {
  return {&shape, body_from_shape, &sweep, outer_radius(shape, inverse_times(body_from_shape, sweep.center))};
}

Gap find_gap(const SweptShape& a, const SweptShape& b, double time, double max_distance) {
  const Pose frame_a = pose_at(*a.sweep, time) * a.body_from_shape;
  const Pose frame_b = pose_at(*b.sweep, time) * b.body_from_shape;
  if (b.shape->kind == ShapeKind::plane) return plane_gap(*a.shape, frame_a, *b.shape, frame_b);
  if (a.shape->kind == ShapeKind::plane) {
    Gap gap = plane_gap(*b.shape, frame_b, *a.shape, frame_a);
    gap.normal = -gap.normal;
    return gap;
  }
  const CorePair pair(*a.shape, *b.shape, inverse_times(frame_a, frame_b));
  const double radii = double(core_radius(*a.shape)) + double(core_radius(*b.shape));
  const CoreDistance cores = core_distance(pair, max_distance + radii, Vec3{});
  Gap gap;
  gap.normal = DVec3(rotate(frame_a.orientation, to_float(cores.normal)));
  gap.distance = cores.overlap ? -radii : cores.distance - radii;
  gap.beyond = cores.beyond;
  return gap;
}

Impact time_of_impact(const SweptShape& a, const SweptShape& b, double start, double end, double target) {
  const DVec3 way = DVec3(a.sweep->moved) - DVec3(b.sweep->moved);
  double time = start;
  for (int i = 0; i < kMaxSteps; ++i) {
    // Nothing can close faster than this, whatever the direction.
    double reach = length(way);
    if (!is_still(a.sweep->turned)) reach += double(length(a.sweep->turned)) * double(a.radius);
    if (!is_still(b.sweep->turned)) reach += double(length(b.sweep->turned)) * double(b.radius);
    const Gap gap = find_gap(a, b, time, target + reach * (end - time));
    if (gap.beyond) return {};
    const double rest = gap.distance - target;
    if (rest <= kTolerance * target) return {true, time};
    const double closing = dot(way, gap.normal) + turning(a, gap.normal) + turning(b, gap.normal);
    // Both the line and the rate of turning are constant: what does not close along one normal now never does.
    if (closing * (end - time) <= rest) return {};
    time += rest / closing;
  }
  return {true, time};
}

}  // namespace gyre
