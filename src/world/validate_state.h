// Checks all structures of a world against each other and reports the first rule that is broken; docs/architecture.md
// lists these rules. Slow: for tests, debug builds and the search for bugs.
//
// state_check.cpp checks less: that loaded columns can be a state.
#pragma once

#include "world/stages.h"

#include <gyre/result.h>

#include <optional>

namespace gyre {

struct WorldState;

// Code none, or a message with the broken rule and its object. `after`: the last stage that ended; none between two
// steps. Some rules hold only after some stages.
Error validate_state(const WorldState& state, std::optional<StageName> after = {});

}  // namespace gyre
