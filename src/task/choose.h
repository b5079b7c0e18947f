// Lists of those among many that something is to be done for, found by all workers.
#pragma once

#include "base/arena.h"
#include "task/parallel.h"

#include <bit>
#include <span>

namespace gyre {

struct Chosen {
  std::span<const std::uint32_t> list;  // ascending
  std::size_t size = 0;                 // of all of them
};

// Those numbers below `count` whose size is not zero: size_of(number), asked of each once, may tell yes or no only. The list is of
// `arena`.
template <class SizeOf>
Chosen choose(TaskSystem& tasks, Arena& arena, std::size_t count, SizeOf&& size_of) {
  // In blocks of one word of bits each.
  constexpr int kBits = 64;
  struct Sum {
    std::uint32_t numbers = 0, size = 0;
  };
  const std::span<std::uint64_t> words = arena.make<std::uint64_t>((count + kBits - 1) / kBits);
  const auto look = [&](int begin, int end, int) {
    Sum sum;
    std::uint64_t bits = 0;
    for (int i = begin; i < end; ++i) {
      const std::uint32_t size = size_of(static_cast<std::uint32_t>(i));
      if (size == 0) continue;
      bits |= std::uint64_t{1} << (i - begin);
      ++sum.numbers;
      sum.size += size;
    }
    words[static_cast<std::size_t>(begin / kBits)] = bits;
    return sum;
  };
  const Sum sum = reduce_blocks(tasks, static_cast<int>(count), kBits, Sum{}, look, [](Sum a, Sum b) {
    return Sum{a.numbers + b.numbers, a.size + b.size};
  });
  const std::span<std::uint32_t> list = arena.make<std::uint32_t>(sum.numbers);
  std::size_t used = 0;
  for (std::size_t word = 0; used < list.size(); ++word) {
    for (std::uint64_t left = words[word]; left != 0; left &= left - 1)
      list[used++] =
          static_cast<std::uint32_t>(kBits * word) + static_cast<std::uint32_t>(std::countr_zero(left));
  }
  return {list, sum.size};
}

}  // namespace gyre
