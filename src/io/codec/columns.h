// The columns of a world as a value of their own: what a snapshot is read into before anything of the world is touched.
#pragma once

#include "world/world_state.h"

namespace gyre {

// Has what for_each_column walks over. The derived parts of `rigid` are empty.
struct StateColumns {
  double time = 0.0;
  std::uint64_t step_count = 0;
  RigidWorld rigid;
};

// Replaces the state of a world by checked columns whose derived parts are built, for this world's number. Ids stay valid
// as far as the columns know their bodies; events and problems are forgotten; the log is told.
void adopt_columns(WorldState& state, StateColumns&& columns);
// What a world whose state is replaced tells about its last step is of another history now.
void clear_reports(WorldState& state);

}  // namespace gyre
