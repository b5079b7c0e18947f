// Lists of numbers that are found in one order and needed by list: a counting sort. The first pass counts the items of
// each list, the second fills the lists; each list keeps the order of its items.
#pragma once

#include "base/arena/arena.h"

#include <cstdint>
#include <span>

namespace gyre {

class BucketedLists {
 public:
  BucketedLists(std::size_t lists, Arena& arena) : ends_(arena.make<std::uint32_t>(lists)) {
    for (std::uint32_t& end : ends_) end = 0;
  }
  void count(std::uint32_t list) { ++ends_[list]; }
  // After all counts: allocates the items.
  void make_room(Arena& arena) { items_ = arena.make<std::uint32_t>(start_lists()); }
  // The same with memory of the caller, for all items or more.
  void make_room(std::span<std::uint32_t> room) { items_ = room.first(start_lists()); }
  void add(std::uint32_t list, std::uint32_t item) { items_[ends_[list]++] = item; }
  // After all items were added.
  std::span<const std::uint32_t> of(std::size_t list) const {
    const std::uint32_t begin = list == 0 ? 0 : ends_[list - 1];
    return items_.subspan(begin, ends_[list] - begin);
  }

 private:
  // Turns each count into the index of the list's next item. Returns the number of items.
  std::uint32_t start_lists() {
    std::uint32_t sum = 0;
    for (std::uint32_t& end : ends_) {
      const std::uint32_t count = end;
      end = sum;
      sum += count;
    }
    return sum;
  }

  std::span<std::uint32_t> ends_;
  std::span<std::uint32_t> items_;
};

}  // namespace gyre
