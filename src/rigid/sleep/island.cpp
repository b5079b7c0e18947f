#include "rigid/sleep/island.h"

#include "base/container/disjoint_sets.h"
#include "collision/contact/pair_update.h"
#include "rigid/sleep/support.h"

namespace gyre {

namespace {

bool is_dynamic(const RigidWorld& w, std::uint32_t body) { return is_movable(w.bodies.flags[body]); }

// Disjoint sets of bodies; the root of an island is its lowest body.
class Islands {
 public:
  // The islands of awake bodies. All bodies that touch them are awake by now, so no member of such an island sleeps.
  static Islands awake(const RigidWorld& w, Arena& arena) {
    Islands islands(w, arena);
    for_each_active_edge(w, [&](std::uint32_t a, std::uint32_t b) { islands.link(w, a, b); });
    return islands;
  }
  static Islands all(const RigidWorld& w, Arena& arena) {
    Islands islands(w, arena);
    for_each_island_edge(w, [&](std::uint32_t a, std::uint32_t b) { islands.link(w, a, b); });
    return islands;
  }
  std::uint32_t root(std::uint32_t i) const { return sets_.of(i); }

 private:
  Islands(const RigidWorld& w, Arena& arena) : sets_(arena.make<std::uint32_t>(w.bodies.motion.size())) {}
  void link(const RigidWorld& w, std::uint32_t a, std::uint32_t b) {
    if (is_dynamic(w, a) && is_dynamic(w, b)) sets_.unite(a, b);
  }

  DisjointSets sets_;
};

// Appends `body` to the ring of its group, whose lowest body is `root`.
void fall_asleep(RigidWorld& w, std::uint32_t body, std::uint32_t root) {
  BodySleep& sleep = w.bodies.sleep[body];
  sleep.group = root;
  if (body == root) {
    sleep.next_in_group = body;
  } else {
    sleep.next_in_group = w.bodies.sleep[root].next_in_group;
    w.bodies.sleep[root].next_in_group = body;
  }
  w.bodies.flags[body].awake = 0;
  clear_motion(w.bodies.motion[body]);
  w.bodies.awake_stale = true;
  ++w.bodies.sleeping_count;
  w.events.sleep_changes.push_back({body_id(w, body), true});
}

// The radius with which the rotation of a body counts as speed. A body without shapes has the radius of gyration of its inertia.
float radius_for_sleep(const BodyMass& mass) {
  const float spread = mass.inertia.xx + mass.inertia.yy + mass.inertia.zz;
  return max(mass.bounding_radius, mass.mass > 0.0f ? std::sqrt(spread / mass.mass) : 0.0f);
}

bool is_weightless(const RigidWorld& w, std::uint32_t body) {
  return w.settings.gravity == Vec3{} || w.bodies.forces[body].gravity_scale == 0.0f;
}

float full_sleep_speed(const RigidWorld& w, std::uint32_t body, float radius) {
  const float own = sleep_speed_of(w.bodies, body);
  return own > 0.0f ? own : sleep_share(w) * std::sqrt(reference_gravity(w.settings) * radius);
}

SleepTest test_at_first_sight(const RigidWorld& w, std::uint32_t body, float radius, float seconds) {
  const BodyFlags& flags = w.bodies.flags[body];
  const BodyMotion& motion = w.bodies.motion[body];
  const BodyForces& forces = w.bodies.forces[body];
  const bool moves = motion.linear_velocity != Vec3{} || motion.angular_velocity != Vec3{};
  SleepTest test;
  // A free body has no support: it never stops once it moves.
  test.allowed = flags.can_sleep != 0 && (flags.constraint_use != 0 || !moves) && forces.force == Vec3{} &&
                 forces.torque == Vec3{} && (flags.constraint_use != 0 || is_weightless(w, body));
  test.speed = length(motion.linear_velocity) + radius * length(motion.angular_velocity);
  // A wedged or jointed body may be pushed out in every step and return. Its pushout counts no more than its net
  // motion.
  const float pushout =
      min(motion.pushout, length(motion.delta_position) + radius * length(motion.delta_rotation));
  test.motion = test.speed + kPushoutWeight * pushout / seconds;
  test.rest_speed = full_sleep_speed(w, body, radius);
  if (body < w.field_rest.size() && w.field_rest[body].acts != kNoFields) {
    // A body in a field may be slow for a moment at a turning point, so its velocity must be constant, too.
    const FieldRest& field = w.field_rest[body];
    if (field.acts == kFieldsOnly && sleep_speed_of(w.bodies, body) == 0.0f)
      test.rest_speed *= kFloatingSpeedShare;
    const float change = length(motion.linear_velocity - field.linear) +
                         radius * length(motion.angular_velocity - field.angular);
    const float max_change = test.rest_speed * w.settings.last_step / kTimeToSleep;
    test.allowed = test.allowed && field.is_unsteady == 0 && change <= max_change;
  }
  return test;
}

// Looks at what may keep a body moving that is slow now.
void look_closer(const RigidWorld& w, std::uint32_t body, float radius, float seconds, SleepTest& test) {
  const float free_speed = min(test.rest_speed, kFreeSpeedShare * full_sleep_speed(w, body, radius));
  if (!joints_of(w.bodies, body).empty()) {
    const BodyMotion& motion = w.bodies.motion[body];
    const float displacement = length(motion.delta_position) + radius * length(motion.delta_rotation);
    test.motion = max(test.motion, displacement / seconds);
  }
  if (sleep_speed_of(w.bodies, body) > 0.0f) return;
  if (!joints_of(w.bodies, body).empty()) {
    const JointDrives drives = find_joint_drives(w, body, radius);
    if (drives.any) test.rest_speed = min(free_speed, kHeldUpShare * drives.slowest);
  }
  if (test.motion > free_speed && test.motion <= test.rest_speed &&
      !is_held_by_friction(w, body, test.speed, kTimeToSleep, seconds))
    test.rest_speed = free_speed;
}

// The change of the still time. A body below its sleep speed accumulates still time. Above it, still time shrinks in
// proportion to the excess: a limb of a heap that slips once by a hair does not keep thousands awake, and a body that
// starts to move loses all still time within a step or two.
float still_time_gain(const SleepTest& test, float seconds) {
  if (test.motion <= test.rest_speed) return seconds;
  return test.rest_speed > 0.0f ? seconds * (1.0f - test.motion / test.rest_speed) : -kMaxStillTime;
}

void update_still_times(RigidWorld& w, float seconds, bool& any_ready) {
  for (const std::uint32_t i : w.bodies.awake) {
    if (w.bodies.flags[i].type != BodyType::dynamic) continue;
    const float radius = radius_for_sleep(w.bodies.masses[i]);
    SleepTest test = test_at_first_sight(w, i, radius, seconds);
    float& still = w.bodies.sleep[i].still_time;
    if (test.allowed && test.motion <= test.rest_speed && still >= kStillBeforeCloserLook)
      look_closer(w, i, radius, seconds, test);
    still = test.allowed ? clamp(still + still_time_gain(test, seconds), 0.0f, kMaxStillTime) : 0.0f;
    if (still >= kTimeToSleep) any_ready = true;
  }
}

}  // namespace

bool can_wake_others(const RigidWorld& w, std::uint32_t body) {
  const BodyFlags& flags = w.bodies.flags[body];
  if (flags.frozen != 0 || flags.awake == 0) return false;
  if (flags.type == BodyType::dynamic) return true;
  const BodyMotion& motion = w.bodies.motion[body];
  return flags.type == BodyType::kinematic &&
         (motion.linear_velocity != Vec3{} || motion.angular_velocity != Vec3{});
}

SleepTest test_sleep(const RigidWorld& w, std::uint32_t body, float seconds) {
  if (!(seconds > 0.0f)) seconds = 1.0f;  // before the first step nothing was displaced
  const float radius = radius_for_sleep(w.bodies.masses[body]);
  SleepTest test = test_at_first_sight(w, body, radius, seconds);
  look_closer(w, body, radius, seconds, test);
  return test;
}

void wake(RigidWorld& w, std::uint32_t body) {
  if (!is_asleep(w, body)) {
    w.bodies.sleep[body].still_time = 0.0f;
    return;
  }
  const std::uint32_t first = w.bodies.sleep[body].group == kNoGroup ? body : w.bodies.sleep[body].group;
  std::uint32_t i = first;
  do {
    BodySleep& sleep = w.bodies.sleep[i];
    const std::uint32_t next = sleep.group == kNoGroup ? first : sleep.next_in_group;
    sleep = {};
    w.bodies.flags[i].awake = 1;
    activate_constraints_of(w, i);
    w.events.sleep_changes.push_back({body_id(w, i), false});
    i = next;
  } while (i != first);
  w.bodies.awake_stale = true;
}

void wake_all(RigidWorld& w) {
  w.bodies.ids.for_each_live([&](std::uint32_t body) {
    if (is_dynamic(w, body)) wake(w, body);
  });
}

void wake_neighbours(RigidWorld& w, std::uint32_t body) {
  for (const ShapeId id : w.bodies.shapes[body]) {
    for (const std::uint32_t slot : list_contacts_of_shape(w.contacts, id.index, w.listed)) {
      const Contact& contact = w.contacts.contacts[slot];
      const std::uint32_t other = contact.body_a == body ? contact.body_b : contact.body_a;
      if (contact.manifold_count > 0 && is_dynamic(w, other)) wake(w, other);
    }
  }
  for (const std::uint32_t slot : joints_of(w.bodies, body)) {
    const JointRecord& joint = w.joints.records[slot];
    for (const std::int32_t end : {joint.body_a, joint.body_b}) {
      if (end != kNoBody && std::uint32_t(end) != body && is_dynamic(w, std::uint32_t(end)))
        wake(w, std::uint32_t(end));
    }
  }
}

void show_halt_to_sensors(RigidWorld& w, std::uint32_t body) {
  for (const ShapeId id : w.bodies.shapes[body]) {
    bool any = false;
    for_each_contact_of_shape(w.contacts, id.index, [&](std::uint32_t slot) {
      Contact& contact = w.contacts.contacts[slot];
      if (contact.sensor == 0) return;
      contact.cached_distance = kUnseen;
      any = true;
    });
    // A changed shape has active contacts in the next step.
    if (any) w.shapes.changed.push_back(id.index);
  }
}

void wake_touched(RigidWorld& w) {
  refresh_awake(w.bodies);
  if (w.bodies.sleeping_count == 0) return;
  // A woken body wakes its own neighbours, also across edges that were visited before. Colours and batches contain
  // awake bodies only, so no sleeping body may be connected to one of them.
  bool woken = true;
  while (woken) {
    woken = false;
    const auto disturb = [&](std::uint32_t sleeper, std::uint32_t other) {
      if (!is_asleep(w, sleeper) || !can_wake_others(w, other)) return;
      wake(w, sleeper);
      woken = true;
    };
    for_each_active_edge(w, [&](std::uint32_t a, std::uint32_t b) { disturb(a, b), disturb(b, a); });
  }
}

namespace {

// Marks islands without weight that nothing supports and that move: they drift on. (With weight they would fall.)
void mark_drifting(const RigidWorld& w, Islands& islands, Arena& arena, std::span<std::uint8_t> is_restless) {
  bool any = false;
  for (const std::uint32_t i : w.bodies.awake) any = any || (is_dynamic(w, i) && is_weightless(w, i));
  if (!any) return;
  const std::span<std::uint8_t> is_supported = arena.make<std::uint8_t>(is_restless.size());
  for (std::uint8_t& s : is_supported) s = 0;
  for_each_active_edge(w, [&](std::uint32_t a, std::uint32_t b) {
    if (is_dynamic(w, a) && !is_dynamic(w, b)) is_supported[islands.root(a)] = 1;
    if (is_dynamic(w, b) && !is_dynamic(w, a)) is_supported[islands.root(b)] = 1;
  });
  for (const std::uint32_t i : w.bodies.awake) {
    if (!is_dynamic(w, i)) continue;
    if (!is_weightless(w, i)) is_supported[islands.root(i)] = 1;
    for (const std::uint32_t slot : joints_of(w.bodies, i)) {
      const JointRecord& joint = w.joints.records[slot];
      if (joint.body_a == kNoBody || joint.body_b == kNoBody) is_supported[islands.root(i)] = 1;
    }
  }
  for (const std::uint32_t i : w.bodies.awake) {
    if (!is_dynamic(w, i) || is_supported[islands.root(i)] != 0) continue;
    const BodyMotion& motion = w.bodies.motion[i];
    const float radius = radius_for_sleep(w.bodies.masses[i]);
    const float speed = length(motion.linear_velocity) + radius * length(motion.angular_velocity);
    const float share = sleep_speed_of(w.bodies, i) > 0.0f ? 1.0f : kDriftSpeedShare;
    if (speed > share * full_sleep_speed(w, i, radius)) is_restless[islands.root(i)] = 1;
  }
}

}  // namespace

void put_to_sleep(RigidWorld& w, Arena& arena, float seconds) {
  if (w.settings.sleeping == 0) return;
  bool any_ready = false;
  update_still_times(w, seconds, any_ready);
  if (!any_ready) return;
  Islands islands = Islands::awake(w, arena);
  const std::span<std::uint8_t> is_restless = arena.make<std::uint8_t>(w.bodies.motion.size());
  for (std::uint8_t& r : is_restless) r = 0;
  for (const std::uint32_t i : w.bodies.awake) {
    if (is_dynamic(w, i) && w.bodies.sleep[i].still_time < kTimeToSleep) is_restless[islands.root(i)] = 1;
  }
  mark_drifting(w, islands, arena, is_restless);
  for_each_active_edge(w, [&](std::uint32_t a, std::uint32_t b) {
    // A body on a moving kinematic body does not sleep.
    if (is_dynamic(w, a) && !is_dynamic(w, b) && can_wake_others(w, b)) is_restless[islands.root(a)] = 1;
    if (is_dynamic(w, b) && !is_dynamic(w, a) && can_wake_others(w, a)) is_restless[islands.root(b)] = 1;
  });
  for (const std::uint32_t i : w.bodies.awake) {
    if (!is_dynamic(w, i)) continue;
    const std::uint32_t root = islands.root(i);
    if (is_restless[root] == 0) fall_asleep(w, i, root);
  }
}

void force_sleep(RigidWorld& w, Arena& arena, std::uint32_t body) {
  if (!is_dynamic(w, body) || is_asleep(w, body)) return;
  refresh_awake(w.bodies);
  Islands islands = Islands::all(w, arena);
  const std::uint32_t root = islands.root(body);
  for (const std::uint32_t i : w.bodies.awake) {
    if (is_dynamic(w, i) && islands.root(i) == root) fall_asleep(w, i, root);
  }
}

}  // namespace gyre
