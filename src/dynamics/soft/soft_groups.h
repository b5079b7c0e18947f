// Groups of cloths and solids whose surfaces may touch each other within a step. A group sleeps and wakes as one, so that no surface that moves
// meets one that sleeps.
//
// In: positions and velocities. Out: by slot, the lowest slot of its group; ropes and free slots are groups of their own.
#pragma once

#include "base/arena/arena.h"
#include "soft/store/soft_store.h"

#include <gyre/math.h>

#include <span>

namespace gyre {

// `gravity` in m/s^2, by which what is awake may gain speed in the step of `seconds`.
std::span<const std::uint32_t> group_soft(const SoftStore& soft, float gravity, float seconds, Arena& arena);

}  // namespace gyre
