// Joints of bodies that a sweep took back: what hangs on them comes after.
#pragma once

#include "base/arena.h"
#include "rigid/rigid_world.h"

#include <span>

namespace gyre {

// Moves the bodies that hang on `stopped` (as this step will leave them) until their joints are
// closed again: places and orientations alone, no velocities. Bodies that were stopped stay but for a little.
// Only joints that hold a point are.
bool closes_joint(const RigidWorld& w, std::uint32_t joint);
void close_joints(RigidWorld& w, std::span<const std::uint32_t> stopped, Arena& arena);

}  // namespace gyre
