// Internal edges: separate bodies laid flush are one surface, and a body that slides across must not catch on the edge
// between them (ghost collisions). Edges within one mesh are the work of geometry/manifold_mesh/mesh_axis.h.
//
// In: contacts that were just updated. Out: the same contacts without the points that the union of the bodies would not
// produce.
//
// A point p of B with the normal n (out of B) lies on the surface of the union only if no body A that contains p
// extends beyond p along n; otherwise the way out of B leads into A. For a ball on A beside the edge of B, the nearest
// point of the union is on A. A corner looks alike, but there B rises above A along the normal of A's own contact, so
// its point stays. The body that contains p need not be touched yet: a point beside the seam of the next two tiles is
// inside the one that comes after. Both tests need only support points and are exact for convex bodies; steps below
// kFlushShare do not count. Meshes and height fields are surfaces: a surface hides a point that lies on it if it continues, level, in the
// direction in which the normal leans; of the other surface only the touched triangle must not rise.
#pragma once

#include "base/arena/arena.h"
#include "collision/contact/collide.h"

namespace gyre {

// In sizes of the contact: bodies with smaller gaps or steps are flush.
constexpr float kFlushShare = 0.01f;

// Kept between steps for its memory only.
struct InternalEdgeScratch {
  struct Found {
    std::uint32_t slot;
    std::uint8_t manifolds;  // bits
  };
  Bitset hidden;  // contacts
  Array<Found> found;
};

// Removes manifolds from contacts of a moving and a static shape, if another static shape that the same mover touches
// hides them. Such a contact gets a full update in the next step. `on_static`: see TouchChanges.
void remove_internal_edge_contacts(ContactStore& store, const CollideInput& input, const Bitset& on_static,
                                   Arena& arena, TaskSystem& tasks, InternalEdgeScratch& scratch);

}  // namespace gyre
