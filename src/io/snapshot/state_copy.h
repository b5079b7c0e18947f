// A copy of the state of a world in memory, for the rollback ring and the keyframes of the replay.
#pragma once

#include "io/codec/columns.h"

namespace gyre {

// Arrays are packed in one block, without unused manifolds. Saving again reuses the memory. Cooked geometry is
// shared, not copied.
class StateCopy {
 public:
  void save(const WorldState& state);
  // Restores exactly the saved state. `state` must be of the world that was saved, or of one whose columns came from
  // it; nothing is checked.
  void restore(WorldState& state) const;
  std::uint64_t step_count() const { return others_.step_count; }
  std::size_t bytes() const;

 private:
  StateColumns others_;            // the columns that are not arrays, and the events of the next step
  Array<std::byte> packed_;        // the arrays, in the order of for_each_column
  Array<std::uint32_t> changed_;   // boxes that the broad phase had not seen
};

}  // namespace gyre
