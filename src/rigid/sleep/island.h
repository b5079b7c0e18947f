// Islands: bodies that hang together by contacts and joints rest and wake together.
//
// Waking: a body that is awake and touches a sleeping one wakes its whole group. Sleeping: when every body of an island has
// hardly moved for a while and something holds it up, the island sleeps as one group (a ring through BodySleep). Islands
// are found anew, by union-find over contacts and joints of awake bodies, only in steps in which somebody could rest.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"

namespace gyre {

// A body rests after so long without motion.
constexpr float kTimeToSleep = 0.5f;  // s
// More is not counted, so that what rested for long is not excused for longer.
constexpr float kMaxStillTime = 2.0f * kTimeToSleep;
// Motion that counts as none: this share of sqrt(gravity * reach), the body's natural speed.
constexpr float kSleepSpeedShare = 0.015f;
// Being pushed apart counts as faster motion than it is: a heap that falls asleep keeps the overlap that it has then.
constexpr float kPushoutWeight = 4.0f;

// Calls fn(body_a, body_b) where a contact or joint binds two bodies; either may be one that nothing moves.
template <class Fn>
void visit_contact_edge(const Contact& contact, Fn&& fn) {
  if (contact.manifold_room == 0 || contact.manifold_count == 0 || contact.sensor != 0) return;
  fn(contact.body_a, contact.body_b);
}
template <class Fn>
void visit_joint_edge(const JointRecord& joint, Fn&& fn) {
  if (joint.body_a != kNoBody && joint.body_b != kNoBody) fn(std::uint32_t(joint.body_a), std::uint32_t(joint.body_b));
}

// Of every contact and joint.
template <class Fn>
void for_each_island_edge(const RigidWorld& w, Fn&& fn) {
  for (const Contact& contact : w.contacts.contacts) visit_contact_edge(contact, fn);
  w.joints.ids.for_each_live([&](std::uint32_t slot) { visit_joint_edge(w.joints.records[slot], fn); });
}
// The same, in the same order, of those of which a body goes along in the step: of others that sleep, or of some of them, too. Where fn
// wakes a body, those of its contacts and joints that are yet to come are among them.
template <class Fn>
void for_each_active_edge(const RigidWorld& w, Fn&& fn) {
  const ActiveConstraints& links = w.active_constraints;
  for (std::size_t slot = links.contacts.find_next(0); slot < links.contacts.size(); slot = links.contacts.find_next(slot + 1))
    visit_contact_edge(w.contacts.contacts[slot], fn);
  for (std::size_t slot = links.joints.find_next(0); slot < links.joints.size(); slot = links.joints.find_next(slot + 1))
    if (w.joints.ids.live(std::uint32_t(slot))) visit_joint_edge(w.joints.records[slot], fn);
}

// Whether the body can disturb a sleeping one: it is awake and dynamic, or kinematic and moving.
bool can_wake_others(const RigidWorld& w, std::uint32_t body);

// What decides whether a dynamic body counts as still.
struct SleepTest {
  bool allowed =
      false;  // it is allowed to, no force acts on it, and something holds it up (or nothing pulls or moves it)
  float speed = 0.0f;       // m/s, of its centre of mass and of its farthest point about that
  float pushout = 0.0f;      // m, by overlap in the last step
  float rest_speed = 0.0f;  // m/s, slower is still
};
// `pull`: the length of gravity, m/s^2.
SleepTest test_sleep(const RigidWorld& w, std::uint32_t body, float gravity);

// Wakes a body's group; nothing if it is awake. Events are added to w.events.
void wake(RigidWorld& w, std::uint32_t body);
void wake_all(RigidWorld& w);
// Wakes everything that touches the body or is joined to it (before it is removed or moved away).
void wake_neighbours(RigidWorld& w, std::uint32_t body);
// Stage: wakes sleeping bodies that awake or moving ones have come to touch or are joined to.
void wake_touched(RigidWorld& w);
// Stage: updates the rest timers of awake bodies and puts resting islands to sleep.
void put_to_sleep(RigidWorld& w, Arena& arena, float seconds);
// Puts the body's whole island to sleep now.
void force_sleep(RigidWorld& w, Arena& arena, std::uint32_t body);

}  // namespace gyre
