// A copy of a world's state in memory: what the rollback ring and the replay's keyframes keep.
#pragma once

#include "io/codec/columns.h"

namespace gyre {

// Arrays lie in one block, packed; of manifolds only what is in use. Keeping a state into another reuses its memory. Cooked
// geometry is shared, not copied.
class StateCopy {
 public:
  void save(const WorldState& state);
  // Puts a world back to exactly what keep() saw. The world must be the one that was kept, or one whose columns came from
  // it: nothing is checked.
  void restore(WorldState& state) const;
  std::uint64_t step_count() const { return others_.step_count; }
  std::size_t bytes() const;

 private:
  StateColumns others_;            // the columns that are no arrays, and the events that wait for the next step
  Array<std::byte> packed_;        // the arrays, in the order of for_each_column
  Array<std::uint32_t> changed_;  // boxes that the broad phase had not seen yet
};

}  // namespace gyre
