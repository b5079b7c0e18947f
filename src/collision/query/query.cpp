// Candidates, exact looks, and keeping what is wanted. See query.h.
#include "collision/query/query.h"

#include "collision/broadphase/fat_box.h"
#include "geometry/manifold/manifold.h"
#include "geometry/query/cast_surface.h"
#include "geometry/query/closest_points.h"

namespace gyre {
namespace {

// Where a shape stands, in double and of length 1, so that what is far away keeps its precision.
struct Frame {
  DVec3 position;
  DQuat orientation;

  explicit Frame(const Pose& pose)
      : position(pose.position), orientation(normalized(to_double(pose.orientation))) {}
  DVec3 to_local(DVec3 place) const { return rotate_inverse(orientation, place - position); }
  DVec3 turn_to_local(DVec3 direction) const { return rotate_inverse(orientation, direction); }
  DVec3 to_world(DVec3 place) const { return position + rotate(orientation, place); }
  Vec3 turn_to_world(DVec3 direction) const { return to_float(rotate(orientation, direction)); }
};

// The nearest shape is looked for in growing boxes up to so many sizes of the one that asks, and then everywhere.
constexpr double kManySizes = 1.0e5;

// The next float that is not smaller; what is looked at must not end before what was found.
float wider_reach(double reach) { return reach >= 1.0 ? 1.0f : float(reach * (1.0 + 1.0e-6)); }

// Calls look(shape, reach, hit) for every candidate along the way, and tells of those that it finds to be met.
template <class Look>
void for_each_along(const QueryInput& input, const BoxSweep& sweep, HitVisit found, Look&& look) {
  double reach = 1.0;
  input.broadphase.cast(input.proxies, sweep, 1.0f, [&](std::uint32_t shape, float) {
    if (!input.accepts(shape)) return wider_reach(reach);
    const Frame frame(input.pose_of(shape));
    LocalHit local;
    if (!look(input.shapes[shape].shape, frame, reach, local)) return wider_reach(reach);
    ShapeHit hit;
    hit.shape = shape;
    hit.triangle = local.triangle;
    hit.fraction = local.fraction;
    hit.point = frame.to_world(local.point);
    hit.normal = frame.turn_to_world(local.normal);
    hit.inside = local.inside;
    hit.depth = float(local.depth);
    reach = min(reach, found(hit));
    return reach < 0.0 ? -1.0f : wider_reach(reach);
  });
}

// The box of a convex shape, as a box in the world that stands still or moves.
BoxSweep sweep_of(const WorldShape& shape) {
  const WorldBox box = world_box(shape.shape, shape.pose);
  const DVec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
  const Aabb outward = round_outward({-half, half});
  // Twice: what rounding of the middle takes from one side.
  const float slack = 1.0e-6f * largest(outward.high);
  return {middle, shape.way, outward.high + Vec3{slack, slack, slack}};
}

// What find_near looks at in one go.
BoxSweep grown(const BoxSweep& sweep, double distance) {
  BoxSweep out = sweep;
  const float margin = distance < double(kUnbounded) ? float(distance * (1.0 + 1.0e-6)) : kUnbounded;
  out.half_extents = sweep.half_extents + Vec3{margin, margin, margin};
  out.way = {};
  return out;
}

}  // namespace

void cast_ray(const QueryInput& input, const WorldRay& ray, HitVisit found) {
  for_each_along(input, {ray.origin, ray.way, {}}, found,
                 [&](const Shape& target, const Frame& frame, double reach, LocalHit& hit) {
                   const LocalRay local{frame.to_local(ray.origin), frame.turn_to_local(DVec3(ray.way))};
                   return cast_ray(target, local, reach, input.back_faces, hit);
                 });
}

void cast_shape(const QueryInput& input, const WorldShape& shape, HitVisit found) {
  const DQuat orientation = normalized(to_double(shape.pose.orientation));
  for_each_along(input, sweep_of(shape), found,
                 [&](const Shape& target, const Frame& frame, double reach, LocalHit& hit) {
                   MovingShape moving;
                   moving.shape = &shape.shape;
                   moving.position = frame.to_local(shape.pose.position);
                   moving.orientation = conjugate(frame.orientation) * orientation;
                   moving.translation = frame.turn_to_local(DVec3(shape.way));
                   moving.skin = shape.skin;
                   return cast_shape(target, moving, reach, input.back_faces, hit);
                 });
}

namespace {

// How far two boxes are apart at least.
double gap_of(const BoxSweep& place, const Aabb& box) {
  const auto gap = [&](int axis) {
    const double low = double(box.low[axis]), high = double(box.high[axis]);
    const double way = absolute(0.5 * (low + high) - place.start[axis]);
    return max(way - 0.5 * (high - low) - double(place.half_extents[axis]), 0.0);
  };
  return length(DVec3{gap(0), gap(1), gap(2)});
}

// Tells of every shape within `reach` of those whose boxes come within `look`, but not within `seen`, where one has looked before
// (below 0: nowhere); `found` returns the new reach.
template <class Found>
void look_around(const QueryInput& input, const WorldShape& shape, const BoxSweep& place, double seen,
                 double look, double reach, Found&& found) {
  const DQuat orientation = normalized(to_double(shape.pose.orientation));
  const BoxSweep before = grown(place, max(seen, 0.0));
  input.broadphase.cast(input.proxies, grown(place, look), 1.0f, [&](std::uint32_t target, float) {
    const Aabb& box = input.proxies[target].fat_box;
    if (gap_of(place, box) * (1.0 - 1.0e-6) > reach || (seen >= 0.0 && meets(before, 1.0f, box))) return 1.0f;
    if (!input.accepts(target)) return 1.0f;
    const Frame frame(input.pose_of(target));
    const PosedShape convex{&shape.shape, frame.to_local(shape.pose.position),
                            conjugate(frame.orientation) * orientation};
    ClosestPair near;
    if (!find_closest_points(input.shapes[target].shape, convex, reach, near)) return 1.0f;
    reach = found(ShapeNear{target, near.triangle, near.distance, frame.to_world(near.on_target),
                            frame.to_world(near.on_convex), frame.turn_to_world(near.normal)});
    return reach < 0.0 ? -1.0f : 1.0f;
  });
}

}  // namespace

void find_near(const QueryInput& input, const WorldShape& shape, double max_distance,
               FunctionRef<bool(const ShapeNear& near)> found) {
  look_around(input, shape, sweep_of(shape), -1.0, max_distance, max_distance,
              [&](const ShapeNear& near) { return found(near) ? max_distance : -1.0; });
}

bool find_nearest_shape(const QueryInput& input, const WorldShape& shape, double max_distance,
                        ShapeNear& nearest) {
  const BoxSweep place = sweep_of(shape);
  double look = min(double(largest(place.half_extents)), max_distance);
  const double far_away = kManySizes * look;
  bool any = false;
  double seen = -1.0;
  for (;; seen = look, look *= 2.0) {
    const bool last = look >= max_distance || look > far_away;
    look_around(input, shape, place, seen, last ? max_distance : look, any ? nearest.distance : max_distance,
                [&](const ShapeNear& near) {
                  const bool equal = any && near.distance == nearest.distance;
                  if (!any || near.distance < nearest.distance || (equal && near.shape < nearest.shape))
                    nearest = near;
                  any = true;
                  // A little farther than the best: which of two equal ones is found must not hang on their order.
                  return min(nearest.distance * (1.0 + 1.0e-9), max_distance);
                });
    // What lies beyond the boxes that were looked at may be nearer.
    if (last || (any && nearest.distance <= look * (1.0 - 1.0e-6))) return any;
  }
}

void find_penetrations(const QueryInput& input, const WorldShape& shape,
                       FunctionRef<void(const ShapePenetration& deep)> found) {
  BoxSweep place = sweep_of(shape);
  place.way = {};
  input.broadphase.cast(input.proxies, place, 1.0f, [&](std::uint32_t target, float) {
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
      deep.normal = frame.turn_to_world(DVec3(manifold.normal));
      found(deep);
    }
    return 1.0f;
  });
}

}  // namespace gyre
