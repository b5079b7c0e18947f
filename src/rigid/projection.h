// Pushing overlap apart, the bodies' side: the kernels (solver/contact_project.h) work on displacements in the place of
// velocities, so these are put by before and put back after, and the displacements are then made.
#pragma once

#include "rigid/body_store.h"

#include <span>

namespace gyre {

struct KeptVelocity {
  Vec3 linear, angular;
};

// Keeps the velocities of the bodies in `list`, element by element in `kept`, and clears them.
void begin_projection(BodyStore& bodies, std::span<const std::uint32_t> list, std::span<KeptVelocity> kept);
// Moves and turns the bodies by what stands in the place of their velocities, and puts these back.
void end_projection(BodyStore& bodies, std::span<const std::uint32_t> list, std::span<const KeptVelocity> kept);

}  // namespace gyre
