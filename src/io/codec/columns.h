// The state columns of a world as a value of their own. A snapshot is read into it before the world is changed.
#pragma once

#include "world/world_state.h"

namespace gyre {

// The members that for_each_column visits. The derived parts of `rigid` are empty.
struct StateColumns {
  double time = 0.0;
  std::uint64_t step_count = 0;
  RigidWorld rigid;
  SoftStore soft;
  FluidStore fluids;
};

// Replaces the state of a world by checked columns, derived for the number of this world. Ids stay valid if their
// bodies exist in the columns. Events and problems are cleared, and the log is informed.
void adopt_columns(WorldState& state, StateColumns&& columns);
// Clears the reports of the last step, which belong to the state before the replacement.
void clear_reports(WorldState& state);

}  // namespace gyre
