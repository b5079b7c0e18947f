// Hits: contacts that are struck hard in a step. How fast their points close is looked at before the solve, whether they
// met is known after it.
#pragma once

#include "rigid/solve/solve_step.h"

namespace gyre {

// How fast points that bore nothing yet are closing as the step begins: should they meet in it, that is the hit. Returns whether
// one of them is fast enough to be told.
bool note_approach(const RigidWorld& w, const Contact& contact, Manifold& manifold);
// Those contacts of a batch that were struck hard in this step.
void note_hits(const RigidWorld& w, BatchScratch& s, Arena& arena, TaskSystem& tasks);
// A blow outside of the solve, whose points' approach was noted before it.
void report_impulse(RigidWorld& w, const Contact& contact, const Manifold& manifold, float impulse);
// The events of all batches, in contact order.
void report_hits(RigidWorld& w, std::span<SlotHit> hits, Arena& arena);

}  // namespace gyre
