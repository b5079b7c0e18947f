// A hash of the motion, cheap enough for every step of a recording; a hash of the whole state takes half as long as a
// step.
//
// It covers the time, the number of contacts, and pose and velocities of each body that was awake in the step. A
// difference in other state (an accumulated impulse, a timer) shows once it changes a motion; until then only the
// occasional hash of the whole state finds it.
#pragma once

#include "world/world_state.h"

namespace gyre {

// The version of the hashed data. Builds play a recording only if they agree on it.
constexpr std::uint64_t kMotionHashLayout = 1;

// Must be called right after a step, before commands change which bodies are awake.
std::uint64_t hash_motion(const WorldState& state);

}  // namespace gyre
