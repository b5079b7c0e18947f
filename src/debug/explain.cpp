// explain: why a body is awake, which bodies touch it, which joints pull it; as ids and as words. See <gyre/debug.h>.
#include "base/float_mode.h"
#include "debug/islands.h"
#include "debug/step_length.h"
#include "debug/words.h"
#include "rigid/sleep/island.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gyre/debug.h>

namespace gyre {

namespace {

class Inquiry {
 public:
  Inquiry(const RigidWorld& w, std::uint32_t body) : w_(w), body_(body), islands_(find_islands(w)) {}

  void answer(Explanation& out);

 private:
  AwakeReason own_reason(std::uint32_t body) const;
  bool is_awake_member(std::uint32_t body) const {
    return islands_.roots[body] == islands_.roots[body_] && w_.bodies.flags[body].awake != 0;
  }
  std::uint32_t shortest_still() const;
  std::uint32_t moving_support() const;
  void find_reason(Explanation& out) const;
  void find_touching(Explanation& out) const;
  void find_joints(Explanation& out) const;

  const RigidWorld& w_;
  std::uint32_t body_;
  IslandMap islands_;
};

// The reason why the body itself does not sleep; `settling` if there is none.
AwakeReason Inquiry::own_reason(std::uint32_t body) const {
  const BodyFlags& flags = w_.bodies.flags[body];
  if (is_disabled(flags)) return AwakeReason::disabled;
  if (flags.frozen != 0) return AwakeReason::frozen;
  if (flags.type == BodyType::fixed) return AwakeReason::fixed;
  if (flags.type == BodyType::kinematic) return AwakeReason::kinematic;
  if (flags.awake == 0) return AwakeReason::asleep;
  if (w_.settings.sleeping == 0) return AwakeReason::sleeping_off;
  if (flags.can_sleep == 0) return AwakeReason::may_not_sleep;
  const SleepTest test = test_sleep(w_, body, w_.settings.last_step);
  if (!test.allowed && flags.constraint_use == 0) return AwakeReason::unsupported;
  if (test.motion > test.rest_speed) return AwakeReason::moving;
  return AwakeReason::settling;
}

// The body of the island with the shortest still time, for which the whole island waits. Among equals the explained
// body.
std::uint32_t Inquiry::shortest_still() const {
  std::uint32_t shortest = body_;
  w_.bodies.ids.for_each_live([&](std::uint32_t i) {
    if (!is_movable(w_.bodies.flags[i]) || !is_awake_member(i)) return;
    if (w_.bodies.sleep[i].still_time < w_.bodies.sleep[shortest].still_time) shortest = i;
  });
  return shortest;
}

// The lowest moving kinematic body that a body of the island touches or is joined to; the explained body if none.
std::uint32_t Inquiry::moving_support() const {
  std::uint32_t found = body_;
  for_each_island_edge(w_, [&](std::uint32_t a, std::uint32_t b) {
    if (is_movable(w_.bodies.flags[a])) {
      const std::uint32_t other = a;
      a = b;
      b = other;
    }
    if (is_movable(w_.bodies.flags[a]) || !can_wake_others(w_, a)) return;
    if (islands_.roots[b] == islands_.roots[body_] && (found == body_ || a < found)) found = a;
  });
  return found;
}

void Inquiry::find_reason(Explanation& out) const {
  out.reason = own_reason(body_);
  if (out.reason != AwakeReason::settling) return;
  const std::uint32_t shortest = shortest_still();
  if (shortest != body_) {
    out.reason = AwakeReason::neighbor;
    out.cause = body_id(w_, shortest);
    out.cause_reason = own_reason(shortest);
    return;
  }
  const std::uint32_t support = moving_support();
  if (support == body_) return;
  out.reason = AwakeReason::moving_support;
  out.cause = body_id(w_, support);
  out.cause_reason = AwakeReason::kinematic;
}

// The entry of a body in a list that is sorted by index.
TouchingBody& entry_of(std::vector<TouchingBody>& list, BodyId body) {
  auto at = list.begin();
  while (at != list.end() && at->body.index < body.index) ++at;
  if (at == list.end() || at->body.index != body.index) at = list.insert(at, TouchingBody{body});
  return *at;
}

void Inquiry::find_touching(Explanation& out) const {
  for (const ShapeId id : w_.bodies.shapes[body_]) {
    for_each_contact_of_shape(w_.contacts, id.index, [&](std::uint32_t slot) {
      const Contact& contact = w_.contacts.contacts[slot];
      if (contact.manifold_count == 0 || contact.sensor != 0) return;
      const std::uint32_t other = contact.body_a == body_ ? contact.body_b : contact.body_a;
      TouchingBody& entry = entry_of(out.touching, body_id(w_, other));
      for (const Manifold& manifold : manifolds_of(w_.contacts, contact)) {
        entry.points += manifold.count;
        bool bears = false;
        for (int k = 0; k < manifold.count; ++k) {
          entry.force += inverse_step_length(w_) * manifold.points[k].total_impulse;
          entry.depth = max(entry.depth, 0.0f - manifold.points[k].separation);
          bears = bears || manifold.points[k].total_impulse > 0.0f;
        }
        if (bears && manifold.sliding != 0) entry.sliding = true;
      }
    });
  }
}

void Inquiry::find_joints(Explanation& out) const {
  for (const std::uint32_t slot : joints_of(w_.bodies, body_)) {
    const JointRecord& joint = w_.joints.records[slot];
    const std::int32_t other = joint.body_a == std::int32_t(body_) ? joint.body_b : joint.body_a;
    PullingJoint pulling;
    pulling.joint = joint_id(w_, slot);
    pulling.kind = joint.kind;
    if (other != kNoBody) pulling.other = body_id(w_, std::uint32_t(other));
    pulling.force = inverse_step_length(w_) * length(joint.total_linear);
    pulling.torque = inverse_step_length(w_) * length(joint.total_angular);
    out.joints.push_back(pulling);
  }
}

void Inquiry::answer(Explanation& out) {
  find_touching(out);
  find_joints(out);
  const std::uint32_t root = islands_.roots[body_];
  if (root != kNoIsland) {
    const SleepTest test = test_sleep(w_, body_, w_.settings.last_step);
    out.speed = test.speed;
    out.rest_speed = test.rest_speed;
    out.still_seconds = w_.bodies.sleep[body_].still_time;
    out.seconds_to_sleep = kTimeToSleep;
    out.island = body_id(w_, root);
    out.island_bodies = int(islands_.sizes[root]);
  }
  find_reason(out);
}

}  // namespace

const char* to_string(AwakeReason reason) {
  switch (reason) {
    case AwakeReason::none:
      return "none";
    case AwakeReason::fixed:
      return "fixed";
    case AwakeReason::kinematic:
      return "kinematic";
    case AwakeReason::frozen:
      return "frozen";
    case AwakeReason::disabled:
      return "disabled";
    case AwakeReason::asleep:
      return "asleep";
    case AwakeReason::sleeping_off:
      return "sleeping_off";
    case AwakeReason::may_not_sleep:
      return "may_not_sleep";
    case AwakeReason::unsupported:
      return "unsupported";
    case AwakeReason::moving:
      return "moving";
    case AwakeReason::settling:
      return "settling";
    case AwakeReason::neighbor:
      return "neighbor";
    case AwakeReason::moving_support:
      return "moving_support";
  }
  return "unknown";
}

Explanation explain(const World& world, BodyId body, const BodyNames& names) {
  const FloatMode mode;
  Explanation out;
  if (world.exists(body)) Inquiry(state_of(world).rigid, body.index).answer(out);
  write_words(out, body, names);
  return out;
}

}  // namespace gyre
