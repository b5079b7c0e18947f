// Islands: bodies that contacts and joints connect fall asleep and wake together.
//
// Waking: an awake body that touches a sleeping one wakes its whole group. Sleeping: if every body of an island has
// been still for long enough and is supported, the island falls asleep as one group, a ring through BodySleep.
// Islands are found by union-find over active contacts and joints, only in steps in which some body is ready to
// sleep.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"

namespace gyre {

// A body may sleep after this much still time.
constexpr float kTimeToSleep = 0.5f;  // s
// From this still time on, the sleep test also looks at contacts and joints, which takes longer.
constexpr float kStillBeforeCloserLook = 0.5f * kTimeToSleep;  // s
// The upper bound of still time. It limits how long a body that moves again may still count as still.
constexpr float kMaxStillTime = 2.0f * kTimeToSleep;
// The share of its sleep speed that is left to a body that no friction holds, or that springs, motors or fields move. It bounds what
// such a body may lose when it is stopped: for most scenes a fraction of a millimetre.
constexpr float kFreeSpeedShare = 1.0f / 20.0f;
// A body that only fields hold approaches its equilibrium ever more slowly.
constexpr float kFloatingSpeedShare = 1.0f / 200.0f;
// A motor that runs at its target velocity moves; at less than this share of it, it is held up.
constexpr float kHeldUpShare = 0.1f;
// The share for islands that nothing supports: they drift until the end of time.
constexpr float kDriftSpeedShare = 1.0e-4f;
// Weight of the pushout speed in the sleep test. A heap that falls asleep keeps its penetration, so bodies that are
// still pushed out must not sleep.
constexpr float kPushoutWeight = 4.0f;

inline bool is_asleep(const RigidWorld& w, std::uint32_t body) {
  return w.bodies.flags[body].type == BodyType::dynamic && w.bodies.flags[body].awake == 0;
}

// Calls fn(body_a, body_b) if the contact or joint connects two bodies. One of the two may be static or kinematic.
template <class Fn>
void visit_contact_edge(const Contact& contact, Fn&& fn) {
  if (contact.manifold_room == 0 || contact.manifold_count == 0 || contact.sensor != 0) return;
  fn(contact.body_a, contact.body_b);
}
template <class Fn>
void visit_joint_edge(const JointRecord& joint, Fn&& fn) {
  if (joint.body_a != kNoBody && joint.body_b != kNoBody)
    fn(std::uint32_t(joint.body_a), std::uint32_t(joint.body_b));
}

// Couplings connect the bodies of their joints in a row.
template <class Fn>
void visit_coupling_edges(const RigidWorld& w, Fn&& fn) {
  for (const CouplingRecord& coupling : w.couplings) {
    if (!is_coupling_enabled(w, coupling)) continue;
    std::uint32_t before = kNoIndex;
    for_each_body_of_coupling(w, coupling, [&](std::uint32_t body) {
      if (before != kNoIndex && before != body) fn(before, body);
      before = body;
    });
  }
}

// Visits the island edges of all contacts, joints and couplings.
template <class Fn>
void for_each_island_edge(const RigidWorld& w, Fn&& fn) {
  for (const Contact& contact : w.contacts.contacts) visit_contact_edge(contact, fn);
  w.joints.ids.for_each_live([&](std::uint32_t slot) { visit_joint_edge(w.joints.records[slot], fn); });
  visit_coupling_edges(w, fn);
}
// Visits the island edges of active contacts and joints in the same order. Edges between sleeping bodies may be among
// them. If fn wakes a body, its edges that come later in the order are visited, too.
template <class Fn>
void for_each_active_edge(const RigidWorld& w, Fn&& fn) {
  const ActiveConstraints& links = w.active_constraints;
  for (std::size_t slot = links.contacts.find_next(0); slot < links.contacts.size();
       slot = links.contacts.find_next(slot + 1))
    visit_contact_edge(w.contacts.contacts[slot], fn);
  for (std::size_t slot = links.joints.find_next(0); slot < links.joints.size();
       slot = links.joints.find_next(slot + 1))
    if (w.joints.ids.live(std::uint32_t(slot))) visit_joint_edge(w.joints.records[slot], fn);
  visit_coupling_edges(w, fn);
}

// True if the body wakes sleeping bodies that it touches: it is dynamic and awake, or kinematic and moving.
bool can_wake_others(const RigidWorld& w, std::uint32_t body);

// The sleep test of one dynamic body.
struct SleepTest {
  bool allowed =
      false;  // may sleep: the user allows it, no force acts on the body, and it is supported (or nothing moves it)
  float speed = 0.0f;  // m/s, of the centre of mass plus that of the farthest point about it
  // m/s: the speed, with pushout, or the mean speed of the displacement in the step, if that is more: errors of joints are removed
  // by displacements without velocity.
  float motion = 0.0f;
  float rest_speed = 0.0f;  // m/s; a body whose motion is less is still
};
// `gravity`: its length, m/s^2. `seconds`: length of the last step.
SleepTest test_sleep(const RigidWorld& w, std::uint32_t body, float seconds);

// Wakes the group of a sleeping body and appends the events to w.events. No effect on an awake body but that its
// still time restarts.
void wake(RigidWorld& w, std::uint32_t body);
void wake_all(RigidWorld& w);
// Wakes all bodies that touch the body or are joined to it, before it is removed or moved.
void wake_neighbours(RigidWorld& w, std::uint32_t body);
// A command halts a kinematic body. The narrow phase of a step works on the poses before it, so sensors have not seen where the last step
// moved the body: their contacts are updated once more.
void show_halt_to_sensors(RigidWorld& w, std::uint32_t body);
// Stage: wakes sleeping bodies that touch awake or moving ones or are joined to them.
void wake_touched(RigidWorld& w);
// Stage: updates the still times of awake bodies and puts still islands to sleep.
void put_to_sleep(RigidWorld& w, Arena& arena, float seconds);
// Puts the island of the body to sleep at once.
void force_sleep(RigidWorld& w, Arena& arena, std::uint32_t body);

}  // namespace gyre
