// Blocks are the same for any number of workers, each runs once, and sums have the same bits.
#include "task/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <mutex>
#include <utility>
#include <vector>

namespace gyre::parallel_test {
namespace {

using Blocks = std::vector<std::pair<int, int>>;

Blocks blocks_seen(TaskSystem& tasks, int count, int block_size) {
  std::mutex mutex;
  Blocks seen;
  for_blocks(tasks, count, block_size, [&](int begin, int end, int worker) {
    EXPECT_GE(worker, 0);
    EXPECT_LT(worker, tasks.worker_count());
    const std::lock_guard<std::mutex> lock(mutex);
    seen.emplace_back(begin, end);
  });
  std::sort(seen.begin(), seen.end());
  return seen;
}

TEST(ForBlocks, SameBlocksForAnyWorkers) {
  TaskSystem one(1), two(2), seven(7);
  for (const int count : {0, 1, 63, 64, 65, 1000}) {
    Blocks expected;
    for (int begin = 0; begin < count; begin += 64) expected.emplace_back(begin, std::min(begin + 64, count));
    EXPECT_EQ(blocks_seen(one, count, 64), expected);
    EXPECT_EQ(blocks_seen(two, count, 64), expected);
    EXPECT_EQ(blocks_seen(seven, count, 64), expected);
  }
}

TEST(ForBlocks, HugeCountsDoNotOverflow) {
  TaskSystem tasks(2);
  const Blocks seen = blocks_seen(tasks, 2147483647, 1 << 30);
  EXPECT_EQ(seen, (Blocks{{0, 1 << 30}, {1 << 30, 2147483647}}));
}

TEST(ForBlocks, PlainWritesAreSeenAfterwards) {
  TaskSystem tasks(4);
  std::vector<int> values(5000);
  for (int round = 1; round <= 200; ++round) {
    for_blocks(tasks, 5000, 32, [&](int begin, int end, int) {
      for (int i = begin; i < end; ++i) ++values[static_cast<std::size_t>(i)];
    });
    ASSERT_EQ(std::count(values.begin(), values.end(), round), 5000);
  }
}

// A host with one thread that begins with the last worker: each worker does its own share first, then those of the
// others.
TEST(ForBlocks, WorkersBeginWithTheirShareInEveryLoop) {
  const HostTasks host{.run =
                           [](void*, int count, void (*task)(void*, int), void* context) {
                             for (int i = count - 1; i >= 0; --i) task(context, i);
                           },
                       .worker_count = 3};
  TaskSystem tasks(host);
  for (const int block_size : {1, 10, 64}) {
    std::vector<int> order;
    for_blocks(tasks, 9 * block_size, block_size, [&](int begin, int, int worker) {
      EXPECT_EQ(worker, 2);
      order.push_back(begin / block_size);
    });
    EXPECT_EQ(order, (std::vector<int>{6, 7, 8, 0, 1, 2, 3, 4, 5}));
  }
}

TEST(SideBySide, DoesEachPieceOnce) {
  for (const int workers : {1, 2, 4}) {
    TaskSystem tasks(workers);
    int done[3] = {};
    run_parallel(
        tasks, [&] { ++done[0]; }, [&] { ++done[1]; }, [&] { ++done[2]; });
    EXPECT_EQ(done[0], 1);
    EXPECT_EQ(done[1], 1);
    EXPECT_EQ(done[2], 1);
  }
}

float sum_of(TaskSystem& tasks, const std::vector<float>& values) {
  return reduce_blocks(
      tasks, static_cast<int>(values.size()), 50, 0.0f,
      [&](int begin, int end, int) {
        float sum = 0.0f;
        for (int i = begin; i < end; ++i) sum += values[static_cast<std::size_t>(i)];
        return sum;
      },
      [](float a, float b) { return a + b; });
}

TEST(ReduceBlocks, SumsHaveTheSameBits) {
  std::vector<float> values;
  for (int i = 0; i < 12345; ++i)
    values.push_back(1.0f / static_cast<float>(i % 977 + 1) * (i % 3 == 0 ? -1.0f : 1.0f));
  TaskSystem one(1);
  const float expected = sum_of(one, values);
  for (int workers = 2; workers <= 8; ++workers) {
    TaskSystem tasks(workers);
    for (int round = 0; round < 20; ++round) {
      ASSERT_EQ(__builtin_bit_cast(std::uint32_t, sum_of(tasks, values)),
                __builtin_bit_cast(std::uint32_t, expected));
    }
  }
}

TEST(ReduceBlocks, CombinesInBlockOrder) {
  // Not commutative: digits in base 10, so any other order gives another number.
  TaskSystem tasks(5);
  const auto digits = [&](int count) {
    return reduce_blocks(
        tasks, count, 2, std::uint64_t{9},
        [](int begin, int, int) { return static_cast<std::uint64_t>(begin / 2); },
        [](std::uint64_t a, std::uint64_t b) { return a * 10 + b; });
  };
  for (int round = 0; round < 100; ++round) ASSERT_EQ(digits(19), 90123456789u);
  EXPECT_EQ(digits(0), 9u);
  EXPECT_EQ(digits(1), 90u);
}

TEST(Parallel, WarmLoopsDoNotAllocate) {
  TaskSystem tasks(4);
  const std::vector<float> values(1000, 1.0f);
  sum_of(tasks, values);
  const std::uint64_t before = allocation_count();
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(sum_of(tasks, values), 1000.0f);
    for_blocks(tasks, 1000, 10, [](int, int, int) {});
  }
  EXPECT_EQ(allocation_count(), before);
}

}  // namespace
}  // namespace gyre::parallel_test
