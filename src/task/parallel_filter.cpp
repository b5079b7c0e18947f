// Blocks are looked at by all workers, each writes a word of bits; the list is then read off them in order. See choose.h.
#include "task/parallel_filter.h"

#include "task/parallel.h"

namespace gyre {

FilteredList filter_by_blocks(TaskSystem& tasks, Arena& arena, std::size_t count,
                              FunctionRef<FilteredBlock(std::uint32_t, std::uint32_t)> choose_block) {
  constexpr int kBits = 64;
  struct Sum {
    std::uint32_t numbers = 0, size = 0;
  };
  const std::span<std::uint64_t> words = arena.make<std::uint64_t>((count + kBits - 1) / kBits);
  const auto look = [&](int begin, int end, int) {
    const FilteredBlock chosen = choose_block(std::uint32_t(begin), std::uint32_t(end));
    words[std::size_t(begin / kBits)] = chosen.bits;
    return Sum{chosen.numbers, chosen.size};
  };
  const Sum sum = reduce_blocks(tasks, int(count), kBits, Sum{}, look, [](Sum a, Sum b) {
    return Sum{a.numbers + b.numbers, a.size + b.size};
  });
  const std::span<std::uint32_t> list = arena.make<std::uint32_t>(sum.numbers);
  std::size_t used = 0;
  for (std::size_t word = 0; used < list.size(); ++word) {
    for (std::uint64_t left = words[word]; left != 0; left &= left - 1)
      list[used++] = std::uint32_t(kBits * word) + std::uint32_t(std::countr_zero(left));
  }
  return {list, sum.size};
}

}  // namespace gyre
