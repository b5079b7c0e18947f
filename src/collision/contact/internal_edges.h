// Separate bodies laid flush are one surface: what slides from one onto the next must not catch on the edge between them.
//
// In: contacts that were just looked at. Out: those of them without points that no surface of the whole would have made.
//
// A point p of B with the normal n (out of B) belongs to the surface of the whole only if no body A that holds p goes on
// beyond p along n: otherwise the way out of B leads through A. For a ball over A, beside the edge of B, the nearest point of
// the whole is on A. In a corner that is not so although it looks alike: there B rises out of A, along the normal of A's own
// contact. Both are questions about farthest points, exact for convex bodies; steps of less than kFlushShare count as none.
// Meshes and height fields are surfaces: one of them hides a point that lies on it if it goes on, level, the way that the
// normal leans, and of the other only the triangle that is touched must not rise.
#pragma once

#include "base/arena/arena.h"
#include "collision/contact/collide.h"

namespace gyre {

// In sizes of the contact: bodies that part or step by less are flush.
constexpr float kFlushShare = 0.01f;

// Kept from step to step only for its memory.
struct InternalEdgeScratch {
  struct Found {
    std::uint32_t slot;
    std::uint8_t manifolds;  // bits
  };
  Bitset hidden;  // contacts
  Array<Found> found;
};

// Takes those manifolds from every contact of a moving shape with a resting one that another resting shape, touched by it
// too, hides. Such a contact is looked at anew in the next step.
// `beside_resting`: see TouchChanges.
void remove_internal_edge_contacts(ContactStore& store, const CollideInput& input, const Bitset& on_static,
                                   Arena& arena, TaskSystem& tasks, InternalEdgeScratch& scratch);

}  // namespace gyre
