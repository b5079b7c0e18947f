// Hits: contacts that are struck hard in a step. How fast their points close is looked at before the solve, whether they
// met is known after it.
#pragma once

#include "base/arena/arena.h"
#include "rigid/solve/contact_lists.h"
#include "rigid/store/rigid_world.h"
#include "task/task_system.h"

namespace gyre {

// A hit, before those of all batches are put into the order of their contacts.
struct SlotHit {
  std::uint32_t slot = 0;
  ContactHit hit;
};

// How fast points that bore nothing yet are closing as the step begins: should they meet in it, that is the hit. Returns whether
// one of them is fast enough to be told.
bool record_hit_approach(const RigidWorld& w, const Contact& contact, Manifold& manifold);
// Those contacts of a batch that were struck hard in this step.
void find_hits(const RigidWorld& w, const ContactLists& contacts, Array<SlotHit>& hits, Arena& arena,
               TaskSystem& tasks);
// A blow outside of the solve, whose points' approach was noted before it.
void report_hit(RigidWorld& w, const Contact& contact, const Manifold& manifold, float impulse);
// The events of all batches, in contact order.
void report_hits(RigidWorld& w, std::span<SlotHit> hits, Arena& arena);

}  // namespace gyre
