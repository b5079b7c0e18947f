// Lists of the indices for which a test holds, found by all workers, in ascending order.
#pragma once

#include "base/arena/arena.h"
#include "base/container/bitset.h"
#include "base/function_ref.h"
#include "task/task_system.h"

#include <bit>
#include <span>

namespace gyre {

struct FilteredList {
  std::span<const std::uint32_t> list;  // ascending
  std::size_t size = 0;                 // sum over the list
};

// The result of a block of 64 indices: the bits of those that passed, their number, and the sum of their sizes.
struct FilteredBlock {
  std::uint64_t bits = 0;
  std::uint32_t count = 0, size = 0;

  void add(int bit, std::uint32_t how_large) {
    if (how_large == 0) return;
    bits |= std::uint64_t{1} << bit;
    ++count;
    size += how_large;
  }
};

// filter_block(begin, end) returns the result of a block. The list lies in `arena`.
FilteredList filter_by_blocks(TaskSystem& tasks, Arena& arena, std::size_t count,
                              FunctionRef<FilteredBlock(std::uint32_t, std::uint32_t)> filter_block);

// The indices below `count` whose size is not zero. size_of(index) is called once for each and may return a bool. The
// list lies in `arena`.
template <class SizeOf>
FilteredList parallel_filter(TaskSystem& tasks, Arena& arena, std::size_t count, SizeOf&& size_of) {
  return filter_by_blocks(tasks, arena, count, [&](std::uint32_t begin, std::uint32_t end) {
    FilteredBlock block;
    for (std::uint32_t i = begin; i < end; ++i) block.add(int(i - begin), size_of(i));
    return block;
  });
}
// The same for the indices in all of the sets; size_of is called for these only.
template <class SizeOf, class... More>
FilteredList parallel_filter_among(TaskSystem& tasks, Arena& arena, SizeOf&& size_of, const Bitset& set,
                                   const More&... more) {
  std::size_t size = set.size();
  ((size = more.size() < size ? more.size() : size), ...);
  return filter_by_blocks(tasks, arena, size, [&](std::uint32_t begin, std::uint32_t) {
    FilteredBlock block;
    for (std::uint64_t left = (set.words()[begin / 64] & ... & more.words()[begin / 64]); left != 0;
         left &= left - 1) {
      const int bit = std::countr_zero(left);
      block.add(bit, size_of(begin + std::uint32_t(bit)));
    }
    return block;
  });
}

}  // namespace gyre
