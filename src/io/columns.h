// The columns of a world as a value of their own: what a snapshot is read into before anything of the world is touched,
// and what the rollback ring and the replay's keyframes keep.
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

// A copy of a state in memory. Keeping one into another reuses its memory; cooked geometry is shared, not copied.
class KeptState {
 public:
  void keep(const WorldState& state);
  // Puts a world back to exactly what keep() saw. The world must be the one that was kept, or one whose columns came from
  // it: nothing is checked.
  void put_back(WorldState& state) const;
  std::uint64_t step_count() const { return columns_.step_count; }
  std::size_t bytes() const;

 private:
  StateColumns columns_;
  Array<std::uint32_t> changed_;  // boxes that the broad phase had not seen yet
};

}  // namespace gyre
