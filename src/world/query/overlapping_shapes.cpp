// Shapes that overlap a shape of the world at the present poses: what is inside a sensor, and the sleepers that a command put something
// onto.
//
// In: a shape, and a broad phase that has received all boxes. Out: shapes in order of index, each tested exactly.
#include <gyre/world.h>

#include "base/float_mode.h"
#include "collision/query/query.h"
#include "rigid/sleep/island.h"
#include "world/query_sight.h"
#include "world/world_state.h"

namespace gyre {

namespace {

// Calls found(other) for each shape that may pair with `shape`, that `accepts`, and that overlaps or touches it; ascending.
template <class Accepts, class Found>
void for_each_overlapping(const RigidWorld& w, std::uint32_t shape, Array<std::uint32_t>& candidates,
                          Accepts&& accepts, Found&& found) {
  const auto pose_of = [&](std::uint32_t i) {
    return origin_pose(w.bodies, w.shapes.bodies[i]) * w.shapes.body_from_shape[i];
  };
  const auto all = [](std::uint32_t) { return true; };
  const QueryInput input{w.shapes.colliders, w.shapes.proxies, *w.broadphase, pose_of, all};
  const Proxy& own = w.shapes.proxies[shape];
  candidates.clear();
  w.broadphase->query(w.shapes.proxies, own.fat_box, candidates);
  for (const std::uint32_t other : candidates) {
    const Proxy& proxy = w.shapes.proxies[other];
    if (!may_pair(own, proxy) || !accepts(other)) continue;
    if (!w.joints.blocked.empty() && w.joints.blocked.contains(pair_key(own.body, proxy.body))) continue;
    if (do_shapes_overlap(input, shape, other)) found(other);
  }
}

// The box of all vertices with their radius, rounded outward.
Aabb box_of(const SoftEntry& entry) {
  const Particles& p = entry.body.particles;
  DVec3 low = p.place(0), high = low;
  for (int i = 1; i < p.count; ++i) {
    const DVec3 at = p.place(i);
    low = {min(low.x, at.x), min(low.y, at.y), min(low.z, at.z)};
    high = {max(high.x, at.x), max(high.y, at.y), max(high.z, at.z)};
  }
  return grow({to_float(low), to_float(high)},
              entry.radius + 1.0e-6f * float(max(length(low), length(high))));
}

void wake_overlapped_soft(WorldState& s, std::uint32_t shape) {
  const Proxy& proxy = s.rigid.shapes.proxies[shape];
  s.soft.for_each([&](SoftEntry& entry) {
    if (entry.is_awake()) return;
    Proxy own;
    own.filter = entry.settings().filter, own.body = kNoIndex, own.motion = ProxyMotion::moving;
    if (may_pair(own, proxy) && overlap(box_of(entry), proxy.fat_box)) wake(entry);
  });
}

}  // namespace

void wake_overlapped(WorldState& s, std::uint32_t body) {
  RigidWorld& w = s.rigid;
  if (w.bodies.flags[body].type == BodyType::dynamic) return;
  const bool any_sleeps = w.bodies.sleeping_count > 0;
  if (any_sleeps && !w.bodies.shapes[body].empty()) show_changes(s);
  for (const ShapeId id : w.bodies.shapes[body]) {
    if (w.shapes.proxies[id.index].sensor) continue;
    if (!s.soft.empty()) wake_overlapped_soft(s, id.index);
    if (!any_sleeps) continue;
    const auto sleeps = [&](std::uint32_t other) {
      return !w.shapes.proxies[other].sensor && is_asleep(w, w.shapes.bodies[other]);
    };
    for_each_overlapping(w, id.index, w.listed, sleeps,
                         [&](std::uint32_t other) { wake(w, w.shapes.bodies[other]); });
  }
}

std::size_t World::sensor_visitors(ShapeId sensor, std::span<ShapeId> out) const {
  const FloatMode mode;
  if (!exists(sensor) || state_->stepping || !state_->rigid.shapes.proxies[sensor.index].sensor) return 0;
  show_changes(*state_);
  const RigidWorld& w = state_->rigid;
  Array<std::uint32_t> candidates;
  std::size_t count = 0;
  const auto all = [](std::uint32_t) { return true; };
  for_each_overlapping(w, sensor.index, candidates, all, [&](std::uint32_t visitor) {
    if (count < out.size()) out[count] = shape_id(w, visitor);
    ++count;
  });
  return count;
}

}  // namespace gyre
