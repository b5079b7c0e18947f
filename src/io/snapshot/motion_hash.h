// A hash of what moves: cheap enough for every step of a recording, where one of the whole state would cost as much as half a step.
//
// It covers the time, how many contacts there are, and of each body that was awake in the step its place, orientation
// and velocities: whatever goes on to change how anything moves shows in it in that very step. What does so later (an impulse
// that is kept, a timer) is found by the hash of the whole state, now and then.
#pragma once

#include "world/world_state.h"

namespace gyre {

// To be raised with what is hashed: recordings are played by builds that mean the same.
constexpr std::uint64_t kMotionHashLayout = 1;

// Right after a step, before commands: which bodies were awake is known only then.
std::uint64_t hash_motion(const WorldState& state);

}  // namespace gyre
