// Commands on ropes, cloths and solids: checked and executed like those of command.h; and sums over them.
#pragma once

#include "world/command.h"

#include <gyre/world.h>

namespace gyre {

Error check(const WorldState& state, const AddSoft& c);
Error check(const WorldState& state, const RemoveSoft& c);
Error check(const WorldState& state, const AttachSoft& c);
Error check(const WorldState& state, const ReleaseSoft& c);
Error check(const WorldState& state, const AttachPoint& c);
Error check(const WorldState& state, const ReleasePoints& c);
Error check(const WorldState& state, const SetVertices& c);
Error check(const WorldState& state, const SetVertexLimits& c);

CommandResult execute(WorldState& state, const AddSoft& c);
CommandResult execute(WorldState& state, const RemoveSoft& c);
CommandResult execute(WorldState& state, const AttachSoft& c);
CommandResult execute(WorldState& state, const ReleaseSoft& c);
CommandResult execute(WorldState& state, const AttachPoint& c);
CommandResult execute(WorldState& state, const ReleasePoints& c);
CommandResult execute(WorldState& state, const SetVertices& c);
CommandResult execute(WorldState& state, const SetVertexLimits& c);

// True if what the id names exists.
bool is_soft(const WorldState& state, SoftId id);
SoftId soft_id(const WorldState& state, std::uint32_t slot);
// Wakes what touches a body, or hangs on it, that a command changes.
void wake_touching(SoftStore& soft, std::uint32_t body);
// A body is about to be removed: releases what is attached to it.
void forget_body(SoftStore& soft, std::uint32_t body);

void add_soft_energy(const SoftStore& soft, DVec3 gravity, Energy& energy);
void add_soft_momentum(const SoftStore& soft, Momentum& momentum);

}  // namespace gyre
