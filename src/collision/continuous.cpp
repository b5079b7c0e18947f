// The stage that clamps fast bodies. See continuous.h.
#include "collision/continuous.h"

#include "base/sort.h"
#include "collision/fat_box.h"
#include "collision/swept_surface.h"
#include "task/parallel.h"

namespace gyre {
namespace {

constexpr int kBlock = 4;  // bodies: each is work enough
constexpr float kCoreShare = 0.5f;
// In inner radii of the moving shape. What is left must lie within what collide() looks for, and so near that it counts as
// touching there.
constexpr double kTarget = 0.0025;
constexpr double kTouching = 0.01;
constexpr double kClear = 0.01;       // of the target: nearer than that, the next look at the contact decides
constexpr double kCoreTarget = 0.05;  // of the core's radius

// A box around the whole way of a shape, turning included: around both ends, and the bulge between.
Aabb swept_box(const SweptShape& shape) {
  const WorldBox start = world_box(*shape.shape, shape.sweep->pose * shape.body_from_shape);
  const WorldBox end = world_box(*shape.shape, pose_at(*shape.sweep, 1.0) * shape.body_from_shape);
  const double radius = double(shape.radius);
  const double bulge = min(0.125 * radius * double(length_squared(shape.sweep->turned)), 2.0 * radius);
  const DVec3 all{bulge, bulge, bulge};
  const auto lower = [](DVec3 a, DVec3 b) { return DVec3{min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)}; };
  const auto upper = [](DVec3 a, DVec3 b) { return DVec3{max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)}; };
  return round_outward({lower(start.low, end.low) - all, upper(start.high, end.high) + all});
}

// Whether one of the two is a sensor that the other may visit.
bool is_gate(const Proxy& self, const Proxy& other) {
  return self.sensor != other.sensor && may_pair(self, other);
}

bool is_obstacle(const Proxy& self, const Proxy& other, bool continuous) {
  if (self.sensor || other.sensor || !may_pair(self, other)) return false;
  return continuous || !other.pushes;
}

// The shape of a fast body on its way.
struct Mover {
  SweptShape whole;
  Core core;
  SweptShape core_swept;
  ImpactScale scale;

  Mover(const ColliderShape& shape, const Sweep& sweep)
      : whole(make_swept_shape(shape.shape, shape.body_from_shape, sweep)),
        core(make_core(shape.shape, shape.body_from_shape, kCoreShare)),
        core_swept(make_swept_shape(core.ball, core.body_from_ball, sweep)) {
    const auto size = double(inner_radius(shape.shape));
    scale = {kTarget * size, kTouching * size, kCoreTarget * double(core.ball.radius)};
  }
  Mover(const Mover&) = delete;
  Mover& operator=(const Mover&) = delete;

  // First time before `end` at which the shape must stop in front of `other`; `end` if it need not.
  double impact_with(const SweptShape& other, double end, TriangleHull& triangle) const {
    if (!is_convex(other.shape->kind) && other.shape->kind != ShapeKind::plane) {
      return impact_with_surface(whole, core_swept, other, end, scale, triangle);
    }
    const bool touching = find_gap(whole, other, 0.0, scale.touching).distance <= scale.touching;
    if (!touching) {
      const Impact impact = time_of_impact(whole, other, 0.0, end, scale.target);
      return impact.hit ? impact.time : end;
    }
    if (find_gap(core_swept, other, 0.0, scale.core_target).distance <= scale.core_target) return end;
    const Impact impact = time_of_impact(core_swept, other, 0.0, end, scale.core_target);
    return impact.hit ? impact.time : end;
  }

  // Whether the shape comes into `other` before `end` and is clearly out of it at `end`. Whether it was inside as the step
  // began is for the caller to know: the look at the contact decided that, in float.
  bool crosses(const SweptShape& other, double end) const {
    if (!is_convex(other.shape->kind)) return false;
    if (find_gap(whole, other, end, scale.target).distance <= kClear * scale.target) return false;
    const double before = find_gap(whole, other, 0.0, scale.target).distance;
    // At the very surface: on its way in or out.
    if (before <= 0.0) return find_gap(whole, other, 0.001 * end, scale.target).distance < before;
    return time_of_impact(whole, other, 0.0, end, min(scale.target, 0.5 * before)).hit;
  }
};

// What is not finite is for others to deal with.
bool is_sound(const Sweep& sweep) {
  return is_finite(sweep.pose) && is_finite(sweep.moved) && is_finite(sweep.turned);
}

// Calls visit(shape on its way, its proxy, the other's index, the other on its way) for all that the shapes of a fast body
// may come near and that `wanted` says yes to. `found` is scratch.
template <class Wanted, class Visit>
void for_each_in_the_way(const ContinuousInput& input, const FastBody& fast, const Sweep& sweep,
                         Array<std::uint32_t>& found, const Wanted& wanted, const Visit& visit) {
  for (const std::uint32_t index : input.shapes_of(fast.body)) {
    const ColliderShape& shape = input.shapes[index];
    if (!is_convex(shape.shape.kind)) continue;
    const Mover mover(shape, sweep);
    found.clear();
    input.broadphase.query(input.proxies, swept_box(mover.whole), found);
    for (const std::uint32_t other : found) {
      if (!wanted(input.proxies[index], input.proxies[other])) continue;
      const ColliderShape& obstacle = input.shapes[other];
      if (!input.blocked.empty() && input.blocked.contains(pair_key(fast.body, input.proxies[other].body)))
        continue;
      const Sweep other_sweep = input.sweep_of(input.proxies[other].body);
      if (!is_sound(other_sweep)) continue;
      visit(mover, index, other, make_swept_shape(obstacle.shape, obstacle.body_from_shape, other_sweep));
    }
  }
}

double first_impact(const ContinuousInput& input, const FastBody& fast, const Sweep& sweep,
                    Array<std::uint32_t>& found, TriangleHull& triangle) {
  double end = 1.0;
  for_each_in_the_way(
      input, fast, sweep, found,
      [&](const Proxy& self, const Proxy& other) { return is_obstacle(self, other, fast.continuous); },
      [&](const Mover& mover, std::uint32_t, std::uint32_t index, const SweptShape& other) {
        if (input.lets_pass != nullptr && (*input.lets_pass)(index, sweep.moved - other.sweep->moved)) return;
        end = min(end, mover.impact_with(other, end, triangle));
      });
  return end;
}

void find_crossings(const ContinuousInput& input, const FastBody& fast, const Sweep& sweep, double end,
                    Array<std::uint32_t>& found, Array<std::uint64_t>& crossings) {
  for_each_in_the_way(
      input, fast, sweep, found, is_gate,
      [&](const Mover& mover, std::uint32_t index, std::uint32_t gate, const SweptShape& other) {
        if (!mover.crosses(other, end)) return;
        const bool senses = input.proxies[index].sensor;
        crossings.push_back(senses ? crossing_key(index, gate) : crossing_key(gate, index));
      });
}

}  // namespace

void ContinuousCollision::clamp_fast_bodies(const ContinuousInput& input, std::span<const FastBody> fast,
                                            TaskSystem& tasks, std::span<float> fractions) {
  crossings_.clear();
  if (fast.empty()) return;
  workers_.resize(std::size_t(tasks.worker_count()));
  for (Worker& worker : workers_) worker.crossings.clear();
  for_blocks(tasks, int(fast.size()), kBlock, [&](int begin, int end, int worker) {
    Worker& own = workers_[worker];
    for (int i = begin; i < end; ++i) {
      const FastBody& body = fast[std::size_t(i)];
      const Sweep sweep = input.sweep_of(body.body);
      fractions[std::size_t(i)] = 1.0f;
      if (!is_sound(sweep)) continue;
      const double time = first_impact(input, body, sweep, own.found, *own.triangle);
      // Rounded down: the fraction must not pass the impact.
      const auto fraction = float(time);
      const float kept = max(double(fraction) > time ? fraction * (1.0f - 1.2e-7f) : fraction, body.least);
      fractions[std::size_t(i)] = kept;
      find_crossings(input, body, sweep, double(kept), own.found, own.crossings);
    }
  });
  gather_crossings();
}

// In an order that neither threads nor the broad phase know of, each pair once although both may be fast.
void ContinuousCollision::gather_crossings() {
  for (const Worker& worker : workers_) {
    for (const std::uint64_t key : worker.crossings) crossings_.push_back(key);
  }
  if (crossings_.empty()) return;
  sort_scratch_.resize(crossings_.size());
  radix_sort_u64(crossings_, sort_scratch_);
  std::size_t kept = 1;
  for (std::size_t i = 1; i < crossings_.size(); ++i) {
    if (crossings_[i] != crossings_[kept - 1]) crossings_[kept++] = crossings_[i];
  }
  crossings_.resize(kept);
}

}  // namespace gyre
