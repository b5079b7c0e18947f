// Changes of existing bodies, shapes and pairs of bodies. See body_commands.h.
#include "world/body_commands.h"

#include "rigid/rigid_step.h"
#include "rigid/sleep/island.h"
#include "world/joint_commands.h"
#include "world/query_sight.h"
#include "world/soft_commands.h"
#include "world/soft_events.h"

namespace gyre {

namespace {

// A body that changes, and all that rests on it.
void wake_with_neighbours(WorldState& s, std::uint32_t body) {
  wake_if_movable(s.rigid, body);
  wake_neighbours(s.rigid, body);
  wake_touching(s.soft, body);
}

std::uint8_t axis_bits(const bool (&axes)[3]) {
  return std::uint8_t((axes[0] ? 1 : 0) | (axes[1] ? 2 : 0) | (axes[2] ? 4 : 0));
}

// The position of a pair in the sorted list, or where it belongs.
std::size_t pair_position(const Array<IgnoredPair>& pairs, IgnoredPair pair) {
  std::size_t low = 0, high = pairs.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const IgnoredPair& at = pairs[middle];
    if (at.a < pair.a || (at.a == pair.a && at.b < pair.b)) {
      low = middle + 1;
    } else {
      high = middle;
    }
  }
  return low;
}
IgnoredPair make_pair(std::uint32_t a, std::uint32_t b) {
  return a < b ? IgnoredPair{a, b} : IgnoredPair{b, a};
}

}  // namespace

void set_mass(WorldState& s, std::uint32_t body, const MassDef& mass) {
  BodyOverrides given;
  if (mass.mass) given.has_mass = 1, given.mass = *mass.mass;
  if (mass.center_of_mass) given.has_center = 1, given.center = *mass.center_of_mass;
  if (mass.inertia) given.has_inertia = 1, given.inertia = *mass.inertia;
  wake_with_neighbours(s, body);
  s.rigid.bodies.overrides.set(body, given);
  refresh_mass(s.rigid, body);
}

void set_density(WorldState& s, std::uint32_t shape, float density) {
  const std::uint32_t body = s.rigid.shapes.bodies[shape];
  wake_with_neighbours(s, body);
  s.rigid.shapes.density[shape] = density;
  refresh_mass(s.rigid, body);
}

void set_locked_axes(WorldState& s, std::uint32_t body, const LockedAxes& locked) {
  RigidWorld& w = s.rigid;
  wake_with_neighbours(s, body);
  w.bodies.flags[body].locked_linear = axis_bits(locked.linear);
  w.bodies.flags[body].locked_angular = axis_bits(locked.angular);
  refresh_inertia(w.bodies, body);
  mark_moved(w, body);
}

void set_can_sleep(WorldState& s, std::uint32_t body, bool can_sleep) {
  if (!can_sleep) wake_if_movable(s.rigid, body);
  s.rigid.bodies.flags[body].can_sleep = can_sleep ? 1 : 0;
}

void set_enabled(WorldState& s, std::uint32_t body, bool enabled) {
  RigidWorld& w = s.rigid;
  BodyFlags& flags = w.bodies.flags[body];
  if (is_disabled(flags) != enabled) return;
  wake_with_neighbours(s, body);  // alone, the body leaves its sleeping group
  flags.frozen = enabled ? kNotFrozen : kDisabled;
  flags.awake = 1;
  w.bodies.sleep[body] = {};
  w.bodies.forces[body].force = w.bodies.forces[body].torque = {};
  w.bodies.awake_stale = true;
  for (const std::uint32_t joint : joints_of(w.bodies, body)) forget_impulses(w, joint);
  for (const ShapeId id : w.bodies.shapes[body]) {
    drop_soft_contacts(s, id.index);
    drop_contacts(w, id.index);
    refresh_proxy(w, id.index);
  }
  refresh_inertia(w.bodies, body);
  refit_body(w, body);
  if (!enabled) return;
  activate_constraints_of(w, body);
  wake_with_neighbours(s, body);
  wake_overlapped(s, body);
}

void set_sensor(WorldState& s, std::uint32_t shape, bool sensor) {
  RigidWorld& w = s.rigid;
  const std::uint32_t body = w.shapes.bodies[shape];
  wake_with_neighbours(s, body);
  drop_soft_contacts(s, shape);
  drop_contacts(w, shape);
  w.shapes.proxies[shape].sensor = sensor;
  refresh_mass(w, body);  // sensors have no mass
  refit_placed_shape(w, shape);
  wake_overlapped(s, body);
}

void set_shape(WorldState& s, std::uint32_t shape, const std::optional<AnyShape>& geometry,
               const std::optional<Transform>& local) {
  RigidWorld& w = s.rigid;
  const std::uint32_t body = w.shapes.bodies[shape];
  wake_with_neighbours(s, body);
  drop_soft_contacts(s, shape);
  drop_contacts(w, shape);
  if (geometry) w.shapes.geometry[shape] = *geometry;
  if (local) w.shapes.body_from_shape.set(shape, {local->position, normalized(local->orientation)});
  refresh_collider(w.shapes, shape);
  refresh_mass(w, body);
  refit_body(w, body);
  wake_overlapped(s, body);
}

bool is_pair_ignored(const RigidWorld& w, std::uint32_t a, std::uint32_t b) {
  const IgnoredPair pair = make_pair(a, b);
  const std::size_t at = pair_position(w.ignored_pairs, pair);
  return at < w.ignored_pairs.size() && w.ignored_pairs[at].a == pair.a && w.ignored_pairs[at].b == pair.b;
}

void set_pair_ignored(WorldState& s, std::uint32_t a, std::uint32_t b, bool ignored) {
  RigidWorld& w = s.rigid;
  if (is_pair_ignored(w, a, b) == ignored) return;
  const IgnoredPair pair = make_pair(a, b);
  const std::size_t at = pair_position(w.ignored_pairs, pair);
  wake_if_movable(w, a);
  wake_if_movable(w, b);
  if (ignored) {
    w.ignored_pairs.insert_at(at, pair);
    block_bodies(w, a, b);
  } else {
    w.ignored_pairs.erase_at(at);
    unblock_bodies(w, a, b);
    for (const std::uint32_t body : {a, b}) {
      for (const ShapeId id : w.bodies.shapes[body]) w.shapes.changed.push_back(id.index);
    }
  }
}

void forget_ignored_pairs(RigidWorld& w, std::uint32_t body) {
  for (std::size_t i = w.ignored_pairs.size(); i-- > 0;) {
    const IgnoredPair pair = w.ignored_pairs[i];
    if (pair.a != body && pair.b != body) continue;
    unblock_bodies(w, pair.a, pair.b);
    w.ignored_pairs.erase_at(i);
  }
}

}  // namespace gyre
