// Vertices that begin inside a body that holds them, as those of a rope that is attached to the middle of a ball. They make no contacts with that body:
// its surface and the attachment would pull them in opposite directions for ever.
//
// In: an entry and its attachments when one of them is made. Out: SoftEntry::inside. From each vertex that is attached to the body, along the elements: all vertices
// whose middle is inside the body, and the first ones outside that overlap it. Vertices that get into the body later are pushed out as ever.
#pragma once

#include "rigid/store/rigid_world.h"
#include "soft/store/soft_store.h"

namespace gyre {

// Adds those of a vertex that is attached to the body now.
void add_inside(const RigidWorld& w, SoftEntry& entry, std::uint32_t body, std::uint32_t particle);
bool is_inside(const SoftEntry& entry, std::uint32_t particle, std::uint32_t body);

}  // namespace gyre
