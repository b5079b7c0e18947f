// The engine's access to the state of a World, and a World made of a state. Users have neither; io and debug, which
// work on the state, use it.
#pragma once

#include "world/world_state.h"

#include <gyre/world.h>

#include <memory>
#include <utility>

namespace gyre {

struct WorldAccess {
  static WorldState& state(World& world) { return *world.state_; }
  static const WorldState& state(const World& world) { return *world.state_; }
  static World make(std::unique_ptr<WorldState> state) { return World(std::move(state)); }
};

inline WorldState& state_of(World& world) { return WorldAccess::state(world); }
inline const WorldState& state_of(const World& world) { return WorldAccess::state(world); }

}  // namespace gyre
