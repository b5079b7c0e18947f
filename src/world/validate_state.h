// Walks the structures of a whole world and finds the first rule that is broken: what docs/architecture.md calls the promises
// of the parts to each other. Slow: for tests, debug builds and people who hunt a bug.
//
// state_check.cpp asks less: whether columns that came from outside can be a state at all.
#pragma once

#include "world/stages.h"

#include <gyre/result.h>

#include <optional>

namespace gyre {

struct WorldState;

// Code none, or the rule and where it is broken, in words. `after`: the stage of the step that has just ended; none between
// two steps. Some rules hold only after some stages.
Error validate_state(const WorldState& state, std::optional<StageName> after = {});

}  // namespace gyre
