// Writes the program of sub-steps (task/program) line by line into memory that was counted before.
#pragma once

#include "base/check.h"
#include "base/noinline.h"
#include "task/program.h"

#include <cstdint>
#include <span>

namespace gyre {

// The table of stages, written into memory that is large enough for it.
class ProgramWriter {
 public:
  explicit ProgramWriter(std::span<Stage> room) : room_(room) {}

  // (Out of line: it is called in fifty places.)
  GYRE_COLD void add(void (*kernel)(void*, int, int, int), void* context, int blocks, int per_claim = 1,
                     const int* bounds = nullptr) {
    if (blocks == 0) return;
    GYRE_ASSERT(used_ < room_.size(), "the program has more stages than were counted");
    room_[used_++] = {kernel, context, blocks, per_claim, bounds};
  }
  // A line for each group: what a group holds, `items_per_block` in a block; those that are serial in one go.
  template <class Group>
  void add_groups(void (*kernel)(void*, int, int, int), std::span<Group> groups,
                  std::uint32_t items_per_block, int per_claim) {
    for (Group& group : groups) {
      const int blocks = int((group.count + items_per_block - 1) / items_per_block);
      add(kernel, &group, blocks, group.serial ? blocks : per_claim, group.bounds);
    }
  }
  std::span<const Stage> stages() const { return room_.first(used_); }

 private:
  std::span<Stage> room_;
  std::size_t used_ = 0;
};

}  // namespace gyre
