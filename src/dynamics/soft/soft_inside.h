// Vertices that begin inside a body that holds them, as those of a rope that is attached to the middle of a ball, make no contacts with that body: its surface
// and the attachment would pull them in opposite directions for ever. SoftEntry::inside has them: from each vertex that is attached to the body, or corner of a point that is, along the
// elements, all vertices whose middle is inside the body, and the first ones outside that overlap it. Vertices that get into the body later are pushed out as ever.
#pragma once

#include "rigid/store/rigid_world.h"
#include "soft/store/soft_store.h"

#include <cstdint>

namespace gyre {

constexpr double kAnyDepth = 1.0e9;  // m, more than any shape has

// Adds those of a vertex that is attached to the body now.
void add_inside(const RigidWorld& w, SoftEntry& entry, std::uint32_t body, std::uint32_t particle);
bool is_inside(const SoftEntry& entry, std::uint32_t particle, std::uint32_t body);

}  // namespace gyre
