#include "rigid/store/active_constraints.h"

#include "rigid/store/rigid_world.h"

namespace gyre {

namespace {

// With fewer sleeping bodies for each awake one, the search for active constraints costs more than it saves.
constexpr std::size_t kAwakeForOneAsleep = 4;

void add(Bitset& set, std::uint32_t slot) {
  if (slot >= set.size()) set.resize(slot + 1);
  set.set(slot);
}

void resize_to_all(RigidWorld& w) {
  w.active_constraints.contacts.resize(w.contacts.contacts.size());
  w.active_constraints.joints.resize(w.joints.ids.capacity());
}

}  // namespace

void activate_constraints_of(RigidWorld& w, std::uint32_t body) {
  for_each_contact_of_body(w, body, [&](std::uint32_t slot) { add(w.active_constraints.contacts, slot); });
  for (const std::uint32_t slot : joints_of(w.bodies, body)) activate_joint(w, slot);
}

void activate_joint(RigidWorld& w, std::uint32_t joint) { add(w.active_constraints.joints, joint); }

void activate_all_constraints(RigidWorld& w) {
  resize_to_all(w);
  w.active_constraints.contacts.set_all();
  w.active_constraints.joints.set_all();
}

void find_active_constraints(RigidWorld& w) {
  const BodyStore& bodies = w.bodies;
  // Islands may have fallen asleep between the pieces of an adaptive step.
  refresh_awake(w.bodies);
  if (w.active_constraints.all || kAwakeForOneAsleep * bodies.sleeping_count < bodies.awake.size())
    return activate_all_constraints(w);
  resize_to_all(w);
  w.active_constraints.contacts.reset_all();
  w.active_constraints.joints.reset_all();
  for (const std::uint32_t body : bodies.awake) activate_constraints_of(w, body);
  for (const std::uint32_t shape : w.shapes.changed)
    for_each_contact_of_shape(w.contacts, shape,
                              [&](std::uint32_t slot) { add(w.active_constraints.contacts, slot); });
}

}  // namespace gyre
