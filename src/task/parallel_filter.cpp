// All workers filter blocks; each block writes a word of bits, from which the list is then read in order. See
// parallel_filter.h.
#include "task/parallel_filter.h"

#include "task/parallel.h"

namespace gyre {

FilteredList filter_by_blocks(TaskSystem& tasks, Arena& arena, std::size_t count,
                              FunctionRef<FilteredBlock(std::uint32_t, std::uint32_t)> filter_block) {
  constexpr int kBits = 64;
  struct Sum {
    std::uint32_t count = 0, size = 0;
  };
  const std::span<std::uint64_t> words = arena.make<std::uint64_t>((count + kBits - 1) / kBits);
  const auto run_block = [&](int begin, int end, int) {
    const FilteredBlock block = filter_block(std::uint32_t(begin), std::uint32_t(end));
    words[std::size_t(begin / kBits)] = block.bits;
    return Sum{block.count, block.size};
  };
  const Sum sum = reduce_blocks(tasks, int(count), kBits, Sum{}, run_block, [](Sum a, Sum b) {
    return Sum{a.count + b.count, a.size + b.size};
  });
  const std::span<std::uint32_t> list = arena.make<std::uint32_t>(sum.count);
  std::size_t used = 0;
  for (std::size_t word = 0; used < list.size(); ++word) {
    for (std::uint64_t left = words[word]; left != 0; left &= left - 1)
      list[used++] = std::uint32_t(kBits * word) + std::uint32_t(std::countr_zero(left));
  }
  return {list, sum.size};
}

}  // namespace gyre
