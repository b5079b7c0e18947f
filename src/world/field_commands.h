// Commands on fields, and explosions: checked and executed like those of command.h.
#pragma once

#include "rigid/store/field_record.h"
#include "world/command.h"

#include <span>

namespace gyre {

struct RigidWorld;

Error check(const WorldState& state, const AddField& c);
Error check(const WorldState& state, const SetField& c);
Error check(const WorldState& state, const RemoveField& c);
Error check(const WorldState& state, const Explode& c);

CommandResult execute(WorldState& state, const AddField& c);
CommandResult execute(WorldState& state, const SetField& c);
CommandResult execute(WorldState& state, const RemoveField& c);
CommandResult execute(WorldState& state, const Explode& c);

// True if the field of an id exists.
bool is_field(const WorldState& state, FieldId id);
// Why loaded fields cannot be a state; null if they can.
const char* fault_in_fields(const RigidWorld& w);

}  // namespace gyre
