// Finds the first difference of two worlds that should be equal: stage of the step, column and row.
#pragma once

#include "world/world_state.h"

#include <gyre/replay.h>

#include <vector>

namespace gyre {

// The hash of every record of every column at one moment.
struct StateTrace {
  struct Column {
    const char* name = nullptr;
    std::vector<std::uint64_t> rows;
  };
  const char* stage = nullptr;
  std::vector<Column> columns;
};

StateTrace trace_state(const WorldState& state, const char* stage);

// Steps both worlds by `seconds`. Compares them before the step, after each stage and at the end. True if they
// differ; then stage, column and row of `difference` are set.
bool step_and_compare(WorldState& a, WorldState& b, float seconds, Difference& difference);

}  // namespace gyre
