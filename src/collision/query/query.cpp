// Queries: candidates from the broad phase, each tested exactly. See query.h.
#include "collision/query/query.h"

#include "collision/broadphase/fat_box.h"
#include "geometry/manifold/manifold.h"
#include "geometry/query/cast_surface.h"
#include "geometry/query/closest_points.h"
#include "geometry/query/surface_overlap.h"

namespace gyre {
namespace {

// The frame of a shape in double with a unit quaternion, so that distant shapes keep their precision.
struct Frame {
  DVec3 position;
  DQuat orientation;

  explicit Frame(const Pose& pose)
      : position(pose.position), orientation(normalized(to_double(pose.orientation))) {}
  DVec3 to_local(DVec3 point) const { return rotate_inverse(orientation, point - position); }
  DVec3 rotate_to_local(DVec3 direction) const { return rotate_inverse(orientation, direction); }
  DVec3 to_world(DVec3 point) const { return position + rotate(orientation, point); }
  Vec3 rotate_to_world(DVec3 direction) const { return to_float(rotate(orientation, direction)); }
};

// The search for the nearest shape grows its box up to this many sizes of the query shape, and then takes the whole
// world.
constexpr double kMaxGrowth = 1.0e5;

// The fraction as a float that is not smaller: the broad phase must not stop before the hit.
float widened(double max_fraction) {
  return max_fraction >= 1.0 ? 1.0f : float(max_fraction * (1.0 + 1.0e-6));
}

// Calls test(shape, frame, max_fraction, hit) for every candidate along the cast, and `found` for each hit.
template <class Test>
void for_each_along(const QueryInput& input, const CastBox& cast, HitVisit found, Test&& test) {
  double max_fraction = 1.0;
  input.broadphase.cast(input.proxies, cast, 1.0f, [&](std::uint32_t shape, float) {
    if (!input.accepts(shape)) return widened(max_fraction);
    const Frame frame(input.pose_of(shape));
    LocalHit local;
    if (!test(input.shapes[shape].shape, frame, max_fraction, local)) return widened(max_fraction);
    ShapeHit hit;
    hit.shape = shape;
    hit.triangle = local.triangle;
    hit.fraction = local.fraction;
    hit.point = frame.to_world(local.point);
    hit.normal = frame.rotate_to_world(local.normal);
    hit.inside = local.inside;
    hit.depth = float(local.depth);
    max_fraction = min(max_fraction, found(hit));
    return max_fraction < 0.0 ? -1.0f : widened(max_fraction);
  });
}

// The box of a convex shape, at rest or moving.
CastBox cast_box_of(const WorldShape& shape) {
  const WorldBox box = world_box(shape.shape, shape.pose);
  const DVec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
  const Aabb outward = round_outward({-half, half});
  // Twice the rounding, since rounding of the middle takes from one side.
  const float slack = 1.0e-6f * largest(outward.high);
  return {middle, shape.translation, outward.high + Vec3{slack, slack, slack}};
}

// The box of a query, enlarged by a distance.
CastBox grown(const CastBox& cast, double distance) {
  CastBox out = cast;
  const float margin = distance < double(kUnbounded) ? float(distance * (1.0 + 1.0e-6)) : kUnbounded;
  out.half_extents = cast.half_extents + Vec3{margin, margin, margin};
  out.translation = {};
  return out;
}

}  // namespace

void cast_ray(const QueryInput& input, const WorldRay& ray, HitVisit found) {
  for_each_along(
      input, {ray.origin, ray.translation, {}}, found,
      [&](const Shape& target, const Frame& frame, double max_fraction, LocalHit& hit) {
        const LocalRay local{frame.to_local(ray.origin), frame.rotate_to_local(DVec3(ray.translation))};
        return cast_ray(target, local, max_fraction, input.back_faces, hit);
      });
}

void cast_shape(const QueryInput& input, const WorldShape& shape, HitVisit found) {
  const DQuat orientation = normalized(to_double(shape.pose.orientation));
  for_each_along(input, cast_box_of(shape), found,
                 [&](const Shape& target, const Frame& frame, double max_fraction, LocalHit& hit) {
                   MovingShape moving;
                   moving.shape = &shape.shape;
                   moving.position = frame.to_local(shape.pose.position);
                   moving.orientation = conjugate(frame.orientation) * orientation;
                   moving.translation = frame.rotate_to_local(DVec3(shape.translation));
                   moving.skin = shape.skin;
                   return cast_shape(target, moving, max_fraction, input.back_faces, hit);
                 });
}

namespace {

// A lower bound of the distance of two boxes.
double gap_of(const CastBox& around, const Aabb& box) {
  const auto gap = [&](int axis) {
    const double low = double(box.low[axis]), high = double(box.high[axis]);
    const double between = absolute(0.5 * (low + high) - around.start[axis]);
    return max(between - 0.5 * (high - low) - double(around.half_extents[axis]), 0.0);
  };
  return length(DVec3{gap(0), gap(1), gap(2)});
}

// Calls `found` for every shape within `max_distance`, among those whose boxes come within `search_radius` but not
// within `searched`, the radius of an earlier search (negative: none). `found` returns the new max_distance.
template <class Found>
void find_between(const QueryInput& input, const WorldShape& shape, const CastBox& around, double searched,
                  double search_radius, double max_distance, Found&& found) {
  const DQuat orientation = normalized(to_double(shape.pose.orientation));
  const CastBox before = grown(around, max(searched, 0.0));
  input.broadphase.cast(input.proxies, grown(around, search_radius), 1.0f, [&](std::uint32_t target, float) {
    const Aabb& box = input.proxies[target].fat_box;
    if (gap_of(around, box) * (1.0 - 1.0e-6) > max_distance || (searched >= 0.0 && meets(before, 1.0f, box)))
      return 1.0f;
    if (!input.accepts(target)) return 1.0f;
    const Frame frame(input.pose_of(target));
    const PosedShape convex{&shape.shape, frame.to_local(shape.pose.position),
                             conjugate(frame.orientation) * orientation};
    ClosestPair closest;
    if (!find_closest_points(input.shapes[target].shape, convex, max_distance, closest)) return 1.0f;
    max_distance = found(ShapeNear{target, closest.triangle, closest.distance, frame.to_world(closest.on_target),
                                   frame.to_world(closest.on_convex), frame.rotate_to_world(closest.normal)});
    return max_distance < 0.0 ? -1.0f : 1.0f;
  });
}

}  // namespace

void find_near(const QueryInput& input, const WorldShape& shape, double max_distance,
               FunctionRef<bool(const ShapeNear& near)> found) {
  find_between(input, shape, cast_box_of(shape), -1.0, max_distance, max_distance,
               [&](const ShapeNear& near) { return found(near) ? max_distance : -1.0; });
}

bool find_nearest_shape(const QueryInput& input, const WorldShape& shape, double max_distance,
                        ShapeNear& nearest) {
  const CastBox box = cast_box_of(shape);
  double search_radius = min(double(largest(box.half_extents)), max_distance);
  const double far_away = kMaxGrowth * search_radius;
  bool any = false;
  double searched = -1.0;
  for (;; searched = search_radius, search_radius *= 2.0) {
    const bool last = search_radius >= max_distance || search_radius > far_away;
    find_between(input, shape, box, searched, last ? max_distance : search_radius,
                 any ? nearest.distance : max_distance, [&](const ShapeNear& near) {
                   const bool equal = any && near.distance == nearest.distance;
                   if (!any || near.distance < nearest.distance || (equal && near.shape < nearest.shape))
                     nearest = near;
                   any = true;
                   // A little more than the best distance, so that the choice between equal shapes does not depend on
                   // their order.
                   return min(nearest.distance * (1.0 + 1.0e-9), max_distance);
                 });
    // Shapes beyond the boxes searched so far may be nearer.
    if (last || (any && nearest.distance <= search_radius * (1.0 - 1.0e-6))) return any;
  }
}

void find_penetrations(const QueryInput& input, const WorldShape& shape,
                       FunctionRef<void(const ShapePenetration& deep)> found) {
  CastBox box = cast_box_of(shape);
  box.translation = {};
  input.broadphase.cast(input.proxies, box, 1.0f, [&](std::uint32_t target, float) {
    if (!input.accepts(target)) return 1.0f;
    const Pose pose = input.pose_of(target);
    const Frame frame(pose);
    const Shape& other = input.shapes[target].shape;
    PairCache cache;
    LocalManifold manifolds[kMaxMeshManifolds];
    const int count =
        collide_shapes(other, shape.shape, inverse_times(pose, shape.pose), 0.0f, cache, manifolds);
    for (int i = 0; i < count; ++i) {
      const LocalManifold& manifold = manifolds[i];
      int deepest = 0;
      for (int k = 1; k < manifold.count; ++k) {
        if (manifold.points[k].separation < manifold.points[deepest].separation) deepest = k;
      }
      if (manifold.count == 0 || !(manifold.points[deepest].separation < 0.0f)) continue;
      ShapePenetration deep;
      deep.shape = target;
      if (!is_convex(other.kind) && other.kind != ShapeKind::plane)
        deep.triangle = public_triangle(other, manifold.triangle);
      deep.depth = -double(manifold.points[deepest].separation);
      deep.point = frame.to_world(DVec3(manifold.points[deepest].position));
      deep.normal = frame.rotate_to_world(DVec3(manifold.normal));
      found(deep);
    }
    return 1.0f;
  });
}

bool do_shapes_overlap(const QueryInput& input, std::uint32_t a, std::uint32_t b) {
  if (!is_convex(input.shapes[b].shape.kind)) {
    const std::uint32_t swapped = a;
    a = b;
    b = swapped;
  }
  const Shape& target = input.shapes[a].shape;
  const Shape& convex = input.shapes[b].shape;
  const Pose pose_a = input.pose_of(a), pose_b = input.pose_of(b);
  if (!is_convex(convex.kind)) return surfaces_overlap(target, convex, inverse_times(pose_a, pose_b));
  const Frame frame(pose_a);
  const DQuat orientation = normalized(to_double(pose_b.orientation));
  const PosedShape posed{&convex, frame.to_local(pose_b.position), conjugate(frame.orientation) * orientation};
  ClosestPair closest;
  return find_closest_points(target, posed, 0.0, closest);
}

}  // namespace gyre
