// The CCD stage: halts fast bodies at their times of impact. See continuous.h.
#include "collision/continuous/continuous.h"

#include "base/container/sort.h"
#include "collision/broadphase/fat_box.h"
#include "collision/continuous/swept_surface.h"
#include "geometry/query/closest_points.h"
#include "math/rotation.h"
#include "task/parallel.h"

#include <optional>

namespace gyre {
namespace {

constexpr int kBodiesPerBlock = 4;  // bodies: each is enough work
// In inner radii of the moving shape. The remaining gap must lie within the search distance of collide(), and be so
// small that it counts as touching there.
constexpr double kTarget = 0.0025;
constexpr double kTouching = 0.01;
constexpr double kClear = 0.01;  // of the target: nearer gaps are left to the next update of the contact
constexpr double kCoreTarget = 0.025;

// A box around the whole sweep of a shape, rotation included: around both ends, and the bulge between them.
Aabb swept_box(const SweptShape& shape) {
  const WorldBox start = world_box(*shape.shape, shape.sweep->pose * shape.body_from_shape);
  const WorldBox end = world_box(*shape.shape, pose_at(*shape.sweep, 1.0) * shape.body_from_shape);
  const double radius = double(shape.radius);
  const double bulge = min(0.125 * radius * double(length_squared(shape.sweep->rotation)), 2.0 * radius);
  const DVec3 all{bulge, bulge, bulge};
  const auto lower = [](DVec3 a, DVec3 b) { return DVec3{min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; };
  const auto upper = [](DVec3 a, DVec3 b) { return DVec3{max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; };
  return round_outward({lower(start.low, end.low) - all, upper(start.high, end.high) + all});
}

// A larger box, computed faster: the bounds at the start, extended by the largest displacement of any point.
Aabb quick_box(const SweptShape& shape) {
  const Sweep& sweep = *shape.sweep;
  const Pose start = sweep.pose * shape.body_from_shape;
  const Aabb rotated = bounds(*shape.shape, {{}, start.orientation});
  const Vec3 position = to_float(start.position), from_center = shape.body_from_shape.position - sweep.center;
  const float angle = length(sweep.rotation);
  const float arc = shape.radius * angle * (1.0f + 0.125f * angle);
  // The slack that world_box() adds at both ends, and more than all rounding.
  const bool has_disc = shape.shape->kind == ShapeKind::cylinder || shape.shape->kind == ShapeKind::cone;
  const float slack =
      1.0e-5f * largest(absolute(position) + max(absolute(rotated.low), absolute(rotated.high)) +
                        absolute(sweep.translation) + absolute(sweep.center) + absolute(from_center)) +
      (has_disc ? 2.0e-3f * shape.shape->radius : 0.0f);
  const float around = arc + slack;
  const Vec3 all{around, around, around};
  const Aabb box{position + rotated.low + min(sweep.translation, Vec3{}) - all,
                 position + rotated.high + max(sweep.translation, Vec3{}) + all};
  // Trees rely on finite boxes; swept_box() ends at the largest float.
  return is_finite(box.low) && is_finite(box.high) ? box : swept_box(shape);
}

// True if exactly one of the two is a sensor and the pair may meet.
bool is_gate(const Proxy& self, const Proxy& other) {
  return self.sensor != other.sensor && may_pair(self, other);
}

bool is_obstacle(const Proxy& self, const Proxy& other, bool continuous) {
  if (self.sensor || other.sensor || !may_pair(self, other)) return false;
  return continuous || !other.pushes;
}

// A shape of a fast body with its sweep.
struct Mover {
  SweptShape whole;
  Core core;
  SweptShape core_swept;
  ImpactScale scale;

  Mover(const ColliderShape& shape, const SweptShape& swept, float min_fraction, bool slides)
      : whole(swept),
        core(make_core(shape.shape, shape.body_from_shape)),
        core_swept(make_swept_shape(core.shape, core.body_from_core, *whole.sweep)) {
    const auto size = double(inner_radius(shape.shape));
    scale = {kTarget * size, kTouching * size, kCoreTarget * size, double(min_fraction), slides};
  }
  Mover(const Mover&) = delete;
  Mover& operator=(const Mover&) = delete;

  // The time of impact of the shape, or only of its core, with `other` before `end`.
  TimeOfImpact impact_with(const SweptShape& other, double end, bool core_only,
                           TriangleHull& triangle) const {
    const SweptShape& own = core_only ? core_swept : whole;
    if (!is_convex(other.shape->kind) && other.shape->kind != ShapeKind::plane)
      return surface_time_of_impact(own, core_swept, other, end, scale, triangle);
    return gyre::convex_time_of_impact(own, core_swept, other, 0.0, end, scale);
  }

  // True if the shape enters `other` before `end` and is clearly outside at `end`. The caller knows whether it was
  // inside at the start, from the update of the contact in float.
  bool crosses(const SweptShape& other, double end, TriangleHull& triangle) const {
    if (other.shape->kind == ShapeKind::plane) return false;  // a half space is entered, not crossed
    if (!is_convex(other.shape->kind))
      return crosses_surface(whole, other, end, kClear * scale.target, scale, triangle);
    if (find_gap(whole, other, end, scale.target).distance <= kClear * scale.target) return false;
    const double before = find_gap(whole, other, 0.0, scale.target).distance;
    // On the surface itself: true if the shape goes in, not out.
    if (before <= 0.0) return find_gap(whole, other, 0.001 * end, scale.target).distance < before;
    return time_of_impact(whole, other, 0.0, end, min(scale.target, 0.5 * before)).hit;
  }
};

// Sweeps that are not finite are skipped.
bool is_sound(const Sweep& sweep) {
  return is_finite(sweep.pose) && is_finite(sweep.translation) && is_finite(sweep.rotation);
}

// The motion from a time to the end of the step.
Sweep remaining_sweep(const Sweep& sweep, double from) {
  if (from == 0.0) return sweep;
  const float remaining = float(1.0 - from);
  return {pose_at(sweep, from), sweep.center, remaining * sweep.translation, remaining * sweep.rotation};
}

// The sweep of a fast body, or what remains of it; other bodies move from time `from` on.
struct SweptPath {
  const FastBody& fast;
  const Sweep& sweep;
  double from = 0.0;
  bool slides = false;
  bool core_only = false;
};

// True if the shape can have a contact with a blocker.
bool is_near_blocker(const ContinuousInput& input, const FastBody& fast, std::uint32_t index) {
  return fast.continuous || input.contacts->near_blockers.test(index);
}

// Lists the shapes in a box that pass the filter, ascending. If the box lies within the shape's fat box, only its
// contacts can be there; a falling body mostly has none.
template <class Filter>
void list_in_box(const ContinuousInput& input, const FastBody& fast, std::uint32_t index, const Aabb& box,
                 const Filter& filter, Array<std::uint32_t>& found) {
  found.clear();
  const Proxy& own = input.proxies[index];
  if (input.contacts == nullptr || !contains(own.fat_box, box)) {
    input.broadphase.query(input.proxies, box, found);
    std::size_t count = 0;
    for (const std::uint32_t other : found)
      if (filter(own, input.proxies[other])) found[count++] = other;
    found.resize_uninitialized(count);
    return;
  }
  if (!is_near_blocker(input, fast, index)) return;
  for_each_contact_of_shape(input.contacts->store, index, [&](std::uint32_t slot) {
    // Most contacts are with pushed shapes. The bit shows this without a read of the contact, which lies anywhere in
    // memory.
    if (!fast.continuous && !input.contacts->ccd_blockers.test(slot)) return;
    const Contact& contact = input.contacts->store.contacts[slot];
    const std::uint32_t other = contact.shape_a == index ? contact.shape_b : contact.shape_a;
    if (!filter(own, input.proxies[other])) return;
    std::size_t index_in_list = found.size();
    while (index_in_list > 0 && found[index_in_list - 1] > other) --index_in_list;
    found.insert_at(index_in_list, other);
  });
}

// Calls visit(swept shape, its index, index of the other, swept other) for each shape that the fast body may come near
// and that passes the filter. `found` is scratch.
template <class Filter, class Visit>
void for_each_on_path(const ContinuousInput& input, const SweptPath& path, Array<std::uint32_t>& found,
                      const Filter& filter, const Visit& visit) {
  for (const std::uint32_t index : input.shapes_of(path.fast.body)) {
    const ColliderShape& shape = input.shapes[index];
    if (!is_convex(shape.shape.kind)) continue;
    const SweptShape whole = make_swept_shape(shape.shape, shape.body_from_shape, path.sweep);
    list_in_box(input, path.fast, index, quick_box(whole), filter, found);
    if (found.empty()) continue;
    const Aabb box = swept_box(whole);
    std::optional<Mover> mover;  // made for the first candidate
    for (const std::uint32_t other : found) {
      if (!overlap(box, input.proxies[other].fat_box)) continue;
      const ColliderShape& obstacle = input.shapes[other];
      if (!input.blocked.empty() &&
          input.blocked.contains(pair_key(path.fast.body, input.proxies[other].body)))
        continue;
      const Sweep all = input.sweep_of(input.proxies[other].body);
      if (!is_sound(all)) continue;
      const Sweep other_sweep = remaining_sweep(all, path.from);
      if (!mover) mover.emplace(shape, whole, path.slides ? 0.0f : path.fast.min_fraction, path.slides);
      visit(*mover, index, other, make_swept_shape(obstacle.shape, obstacle.body_from_shape, other_sweep));
    }
  }
}

// True if the union of the shapes that the mover touches hides all contacts with the obstacle.
bool is_behind_internal_edge(const ContinuousInput& input, std::uint32_t index, std::uint32_t obstacle) {
  if (input.contacts == nullptr) return false;
  bool hidden = false;
  for_each_contact_of_shape(input.contacts->store, index, [&](std::uint32_t slot) {
    const Contact& contact = input.contacts->store.contacts[slot];
    if (contact.shape_a != obstacle && contact.shape_b != obstacle) return;
    hidden = contact.manifold_count == 0 && slot < input.contacts->hidden.size() &&
             input.contacts->hidden.test(slot);
  });
  return hidden;
}

// When a body must halt, and which of its shapes meets which.
struct BodyImpactTime : TimeOfImpact {
  std::uint32_t shape = 0, obstacle = 0;
  bool near_gate = false;  // a sensor may be crossed
};

BodyImpactTime first_impact(const ContinuousInput& input, const SweptPath& path, Array<std::uint32_t>& found,
                            TriangleHull& triangle) {
  BodyImpactTime first;
  for_each_on_path(
      input, path, found,
      [&](const Proxy& self, const Proxy& other) {
        first.near_gate = first.near_gate || self.sensor != other.sensor;
        return is_obstacle(self, other, path.fast.continuous);
      },
      [&](const Mover& mover, std::uint32_t index, std::uint32_t obstacle, const SweptShape& other) {
        if (input.lets_pass != nullptr &&
            (*input.lets_pass)(obstacle, path.sweep.translation - other.sweep->translation))
          return;
        TimeOfImpact impact = mover.impact_with(other, first.time, path.core_only, triangle);
        if (impact.hit && !path.core_only && is_behind_internal_edge(input, index, obstacle))
          impact = mover.impact_with(other, first.time, true, triangle);
        if (!impact.hit || !(impact.time < first.time || !first.hit)) return;
        static_cast<TimeOfImpact&>(first) = impact;
        first.shape = index;
        first.obstacle = obstacle;
      });
  return first;
}

void find_crossings(const ContinuousInput& input, const SweptPath& path, double end,
                    Array<std::uint32_t>& found, Array<std::uint64_t>& crossings, TriangleHull& triangle) {
  for_each_on_path(input, path, found, is_gate,
                   [&](const Mover& mover, std::uint32_t index, std::uint32_t gate, const SweptShape& other) {
                     if (!mover.crosses(other, end, triangle)) return;
                     const bool senses = input.proxies[index].sensor;
                     crossings.push_back(senses ? crossing_key(index, gate) : crossing_key(gate, index));
                   });
}

// The largest share of a displacement along an obstacle after which the shape still touches it where both are then. The
// contact of the next step must find the obstacle there, or the impact would have no response. `drift` is the
// displacement relative to the obstacle.
double touching_share(const ContinuousInput& input, const BodyImpactTime& impact, Pose pose, DVec3 drift) {
  const ColliderShape& own = input.shapes[impact.shape];
  const ColliderShape& other = input.shapes[impact.obstacle];
  const Pose frame =
      pose_at(input.sweep_of(input.proxies[impact.obstacle].body), 1.0) * other.body_from_shape;
  const double touching = kTouching * double(inner_radius(own.shape));
  const DVec3 start = pose.position;
  const auto touches = [&](double share) {
    pose.position = start + share * drift;
    const Pose placed = pose * own.body_from_shape;
    const DQuat back = conjugate(normalized(to_double(frame.orientation)));
    ClosestPair closest;
    return find_closest_points(other.shape,
                               {&own.shape, rotate(back, placed.position - frame.position),
                                back * normalized(to_double(placed.orientation))},
                               touching, closest);
  };
  if (touches(1.0)) return 1.0;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < 12; ++i) {
    const double middle = 0.5 * (low + high);
    (touches(middle) ? low : high) = middle;
  }
  return low;
}

// The sweep of a body that stays in place on a moving and rotating carrier, from a time on.
Sweep ride_on(const Sweep& carrier, const Pose& pose, Vec3 center, double from) {
  const double remaining = 1.0 - from;
  Sweep ride{pose, center, float(remaining) * carrier.translation, float(remaining) * carrier.rotation};
  if (carrier.rotation == Vec3{}) return ride;
  const Pose start = pose_at(carrier, from);
  const auto middle = [](const Pose& of, Vec3 at) { return of.position + DVec3(rotate(of.orientation, at)); };
  const DVec3 beside = middle(pose, center) - middle(start, carrier.center);
  const DQuat rotation = normalized(to_double(from_rotation_vector(ride.rotation)));
  ride.translation += to_float(rotate(rotation, beside) - beside);
  return ride;
}

bool is_still(const Sweep& sweep) { return sweep.translation == Vec3{} && sweep.rotation == Vec3{}; }

// A halted body spends the rest of its step sliding along its obstacle, and moving with it. It does not rotate by
// itself meanwhile, so the plane between the two stays between them. At a second obstacle it follows the crease.
class Slide {
 public:
  Slide(const ContinuousInput& input, const FastBody& fast, Array<std::uint32_t>& found,
        Array<std::uint64_t>& crossings, TriangleHull& triangle)
      : input_(input), fast_(fast), found_(found), crossings_(crossings), triangle_(triangle) {}

  // Computes the motion after `impact`: saved.slide and saved.rotation.
  void run(const Sweep& sweep, const BodyImpactTime& impact, SavedMotion& saved) {
    DVec3 normals[2];
    BodyImpactTime last = impact;
    DVec3 remaining = (1.0 - impact.time) * DVec3(sweep.translation), gone;
    Pose pose = pose_at(sweep, impact.time);
    double from = impact.time;
    for (int k = 0; k < 2; ++k) {
      if (!can_slide(last)) break;
      Sweep ride{pose, sweep.center, {}, {}};
      if (!is_pushed(last)) ride = ride_on(sweep_of(last), pose, sweep.center, from);
      const bool rides = !is_still(ride);
      const DVec3 carried(ride.translation);
      normals[k] = rotate(normalized(to_double(from_rotation_vector(ride.rotation))), last.normal);
      DVec3 drift = along(remaining - carried, normals, k);
      // If only the core was blocked, the shape itself may overlap and need not stay in touch.
      if (!impact.by_core) drift = touching_share(input_, last, pose_at(ride, 1.0), drift) * drift;
      ride.translation = to_float(drift + carried);
      const SweptPath remaining_path{fast_, ride, from, true, impact.by_core};
      const BodyImpactTime second = first_impact(input_, remaining_path, found_, triangle_);
      const double share = second.hit ? second.time : 1.0;
      if (second.near_gate) find_crossings(input_, remaining_path, share, found_, crossings_, triangle_);
      // A moving obstacle carries the body, whatever stands behind it.
      const DVec3 step = share * drift + carried;
      gone += step;
      pose.position += step;
      saved.rotation = ride.rotation;
      if (!second.hit || rides) break;
      remaining = (1.0 - share) * drift;
      from += share * (1.0 - from);
      last = second;
    }
    saved.slide = to_float(gone);
  }

 private:
  Sweep sweep_of(const BodyImpactTime& impact) const {
    return input_.sweep_of(input_.proxies[impact.obstacle].body);
  }
  bool can_slide(const BodyImpactTime& impact) const {
    if (!impact.hit || impact.time >= 1.0 || !(length_squared(impact.normal) > 0.5)) return false;
    return impact.by_core || !is_pushed(impact);
  }
  // Only the sweep of a pushed body itself knows where it will be.
  bool is_pushed(const BodyImpactTime& impact) const { return input_.proxies[impact.obstacle].pushes; }
  // The displacement without the component into the k + 1 obstacles so far.
  static DVec3 along(DVec3 displacement, const DVec3 (&normals)[2], int k) {
    displacement = displacement - max(dot(displacement, normals[k]), 0.0) * normals[k];
    if (k == 0 || dot(displacement, normals[0]) <= 0.0) return displacement;
    const DVec3 crease = cross(normals[0], normals[1]);
    const double squared = length_squared(crease);
    return squared > 1.0e-12 ? (dot(displacement, crease) / squared) * crease : DVec3{};
  }

  const ContinuousInput& input_;
  const FastBody& fast_;
  Array<std::uint32_t>& found_;
  Array<std::uint64_t>& crossings_;
  TriangleHull& triangle_;
};

}  // namespace

Aabb bounds_of_sweep(const ColliderShape& shape, const Sweep& sweep) {
  return swept_box(make_swept_shape(shape.shape, shape.body_from_shape, sweep));
}

void ContinuousCollision::clamp_fast_bodies(const ContinuousInput& input, std::span<const FastBody> fast,
                                            TaskSystem& tasks, std::span<SavedMotion> saved) {
  crossings_.clear();
  if (fast.empty() && input.gates.empty()) return;
  workers_.resize(std::size_t(tasks.worker_count()));
  for (Worker& worker : workers_) worker.crossings.clear();
  test_gates(input);
  for_blocks(tasks, int(fast.size()), kBodiesPerBlock, [&](int begin, int end, int worker) {
    Worker& own = workers_[worker];
    for (int i = begin; i < end; ++i) {
      const FastBody& body = fast[std::size_t(i)];
      const Sweep sweep = input.sweep_of(body.body);
      SavedMotion& out = saved[std::size_t(i)];
      out = {};
      if (!is_sound(sweep)) continue;
      const SweptPath path{body, sweep};
      if (body.only_crosses) {
        find_crossings(input, path, 1.0, own.found, own.crossings, *own.triangle);
        continue;
      }
      BodyImpactTime impact = first_impact(input, path, own.found, *own.triangle);
      // Rounded down: the fraction must not pass the impact.
      const auto fraction = float(impact.time);
      out.fraction = double(fraction) > impact.time ? fraction * (1.0f - 1.2e-7f) : fraction;
      if (impact.near_gate)
        find_crossings(input, path, double(out.fraction), own.found, own.crossings, *own.triangle);
      impact.time = double(out.fraction);
      if (impact.by_core && length_squared(impact.normal) > 0.5) {
        out.impact_normal = to_float(impact.normal);
        out.impact_point = impact.point;
        out.other = input.proxies[impact.obstacle].body;
      }
      // A body in contact that meets the next piece of the same ground at an internal edge must not be lifted over it.
      const bool fresh = !(body.min_fraction > 0.0f) || impact.by_core;
      const bool slides = impact.hit && body.slides &&
                          (fresh || !is_still(input.sweep_of(input.proxies[impact.obstacle].body)));
      if (slides) Slide(input, body, own.found, own.crossings, *own.triangle).run(sweep, impact, out);
    }
  });
  gather_crossings();
  even_out_room();
}

void ContinuousCollision::test_gates(const ContinuousInput& input) {
  for (const GatePair& pair : input.gates) {
    const ColliderShape &shape = input.shapes[pair.convex], &surface = input.shapes[pair.surface];
    const Sweep sweep = input.sweep_of(input.proxies[pair.convex].body);
    const Sweep other = input.sweep_of(input.proxies[pair.surface].body);
    if (!is_sound(sweep) || !is_sound(other)) continue;
    const Mover mover(shape, make_swept_shape(shape.shape, shape.body_from_shape, sweep), 0.0f, false);
    if (!mover.crosses(make_swept_shape(surface.shape, surface.body_from_shape, other), 1.0,
                       *workers_[0].triangle))
      continue;
    const bool senses = input.proxies[pair.convex].sensor;
    workers_[0].crossings.push_back(senses ? crossing_key(pair.convex, pair.surface)
                                           : crossing_key(pair.surface, pair.convex));
  }
}

// Sorts the crossings, so that neither threads nor the broad phase show in their order, and removes duplicates (both
// bodies may be fast).
void ContinuousCollision::gather_crossings() {
  for (const Worker& worker : workers_) {
    for (const std::uint64_t key : worker.crossings) crossings_.push_back(key);
  }
  if (crossings_.empty()) return;
  sort_scratch_.resize(crossings_.size());
  radix_sort_u64(crossings_, sort_scratch_);
  std::size_t count = 1;
  for (std::size_t i = 1; i < crossings_.size(); ++i) {
    if (crossings_[i] != crossings_[count - 1]) crossings_[count++] = crossings_[i];
  }
  crossings_.resize(count);
}

// Workers get different bodies in each run, so each gets the capacity that any of them needed; none grows once warm.
void ContinuousCollision::even_out_room() {
  std::size_t capacity = 0;
  for (const Worker& worker : workers_) capacity = max(capacity, worker.found.capacity());
  for (Worker& worker : workers_) {
    worker.found.reserve(capacity);
    worker.crossings.reserve(crossings_.capacity());
  }
}

}  // namespace gyre
