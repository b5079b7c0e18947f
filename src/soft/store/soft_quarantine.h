// Quarantine of soft matter, as bodies have it: an entry that a step left without finite places is frozen where it was when the step began. It then moves
// no more and touches nothing, so that the rest of the world goes on. SetVertices ends the quarantine.
//
// In: entries before and after the solve of a step. Out: the entries that were frozen, by slot.
#pragma once

#include "soft/store/soft_store.h"

namespace gyre {

// Keeps the places of all awake entries, before the solve.
void keep_good_places(SoftStore& soft);
// Freezes awake entries whose places or velocities are not finite, and appends their slots to `frozen`. Impulses that are not finite are forgotten.
void quarantine_soft(SoftStore& soft, Array<std::uint32_t>& frozen);

}  // namespace gyre
