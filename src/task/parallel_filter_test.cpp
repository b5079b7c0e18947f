// The same list for any number of workers, ascending, with the sum of its sizes.
#include "task/parallel_filter.h"

#include <gtest/gtest.h>

#include <vector>

namespace gyre::parallel_filter_test {
namespace {

TEST(Choose, SameListForAnyWorkers) {
  for (const std::uint32_t count : {0u, 1u, 63u, 64u, 65u, 1000u}) {
    std::vector<std::uint32_t> expected;
    std::size_t size = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (i % 7 % 3 != 0) expected.push_back(i), size += i % 7 % 3;
    }
    for (const int workers : {1, 2, 5}) {
      TaskSystem tasks(workers);
      Arena arena;
      const FilteredList block =
          parallel_filter(tasks, arena, count, [](std::uint32_t i) { return i % 7 % 3; });
      EXPECT_EQ(std::vector<std::uint32_t>(block.list.begin(), block.list.end()), expected);
      EXPECT_EQ(block.size, size);
    }
  }
}

TEST(Choose, NoneAndAll) {
  TaskSystem tasks(2);
  Arena arena;
  EXPECT_TRUE(parallel_filter(tasks, arena, 300, [](std::uint32_t) { return 0u; }).list.empty());
  const FilteredList all = parallel_filter(tasks, arena, 300, [](std::uint32_t) { return 1u; });
  ASSERT_EQ(all.list.size(), 300u);
  EXPECT_EQ(all.list[299], 299u);
}

}  // namespace
}  // namespace gyre::parallel_filter_test
