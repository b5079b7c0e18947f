// Finds hit events: contacts with a hard impact in a step. Approach speeds are recorded before the solve, which then decides whether the
// points met.
#pragma once

#include "base/arena/arena.h"
#include "rigid/solve/contact_lists.h"
#include "rigid/store/rigid_world.h"
#include "task/task_system.h"

namespace gyre {

// A hit event with the slot of its contact, by which the events of all batches are sorted.
struct SlotHit {
  std::uint32_t slot = 0;
  ContactHit hit;
};

// Records the approach speeds of points without load as the step begins. True if one exceeds the hit speed.
bool record_hit_approach(const RigidWorld& w, const Contact& contact, Manifold& manifold);
// Finds the hits among the contacts of a batch in this step.
void find_hits(const RigidWorld& w, const ContactLists& contacts, Array<SlotHit>& hits, Arena& arena,
               TaskSystem& tasks);
// Reports an impact outside of the solve. The approach of its points was recorded before.
void report_hit(RigidWorld& w, const Contact& contact, const Manifold& manifold, float impulse);
// Reports the hits of all batches in contact order.
void report_hits(RigidWorld& w, std::span<SlotHit> hits, Arena& arena);

}  // namespace gyre
