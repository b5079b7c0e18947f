// Commands on gases and liquids: checked and executed like those of command.h.
#pragma once

#include "world/command.h"

#include <gyre/world.h>

namespace gyre {

Error check(const WorldState& state, const AddFluid& c);
Error check(const WorldState& state, const RemoveFluid& c);
Error check(const WorldState& state, const SetEmitters& c);
Error check(const WorldState& state, const SetFluidPose& c);
Error check(const WorldState& state, const SetFluidVelocity& c);

CommandResult execute(WorldState& state, const AddFluid& c);
CommandResult execute(WorldState& state, const RemoveFluid& c);
CommandResult execute(WorldState& state, const SetEmitters& c);
CommandResult execute(WorldState& state, const SetFluidPose& c);
CommandResult execute(WorldState& state, const SetFluidVelocity& c);

// True if what the id names exists.
bool is_fluid(const WorldState& state, FluidId id);

// Liquids; gases are left out, whose boxes mostly are open.
void add_fluid_energy(const WorldState& state, Energy& energy);
void add_fluid_momentum(const WorldState& state, Momentum& momentum);

}  // namespace gyre
