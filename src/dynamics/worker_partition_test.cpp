// Shares are consecutive ranges of bodies with about as many contacts each, whatever the islands.
#include "dynamics/worker_partition.h"

#include "task/task_system.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace gyre::worker_partition_test {
namespace {

constexpr std::uint32_t kNone = ColoringPair::kNone;

TEST(PartitionOfBodies, OneWorkerOrFewContactsAreOneShare) {
  Arena arena;
  const std::vector<ColoringPair> many(1000, ColoringPair{0, 1}), few(20, ColoringPair{0, 1});
  EXPECT_EQ(partition_bodies(many, 2, 1, arena).count(), 1);
  const WorkerPartition one = partition_bodies(few, 2, 4, arena);
  EXPECT_EQ(one.count(), 1);
  EXPECT_EQ(one.of(1u), 0);
  EXPECT_EQ(one.of(ColoringPair{kNone, 1}), 0);
}

TEST(PartitionOfBodies, AreRunsOfBodiesWithAsManyContacts) {
  std::mt19937 random(3);
  const auto below = [&](std::uint32_t most) { return std::uint32_t(random() % most); };
  for (int repeat = 0; repeat < 40; ++repeat) {
    Arena arena;
    const std::uint32_t bodies = 50 + below(2000), contacts = 300 + below(9000);
    const int workers = 2 + int(below(TaskSystem::kMaxWorkers - 1));
    std::vector<ColoringPair> pairs;
    std::vector<int> of_body(bodies, 0);
    for (std::uint32_t i = 0; i < contacts; ++i) {
      // The first bodies get more contacts. Some contacts have one immovable body, as A or as B.
      const std::uint32_t a = below(bodies), b = below(a + 1), kind = below(5);
      pairs.push_back({kind == 0 ? kNone : a, kind == 1 ? kNone : b});
      ++of_body[WorkerPartition::second_of(pairs.back())];
    }
    const WorkerPartition partition = partition_bodies(pairs, bodies, workers, arena);
    ASSERT_EQ(partition.count(), workers);
    ASSERT_EQ(partition.of_body.size(), bodies);
    for (std::uint32_t i = 0; i < bodies; ++i) {
      ASSERT_LT(partition.of(i), workers);
      if (i > 0) {
        ASSERT_GE(partition.of(i), partition.of(i - 1));
      }
    }
    std::vector<int> sums(std::size_t(workers), 0);
    for (const ColoringPair& pair : pairs) ++sums[std::size_t(partition.of(pair))];
    // A body is in one share with all its contacts.
    const int most = int(contacts) / workers + 1 + *std::max_element(of_body.begin(), of_body.end());
    for (const int sum : sums) EXPECT_LE(sum, most);
  }
}

TEST(PartitionOfBodies, BoundsAreWholeBlocks) {
  const std::uint32_t starts[] = {0, 23, 24, 100};
  int bounds[5];
  find_share_bounds(starts, 130, 16, bounds);
  EXPECT_EQ(bounds[0], 0);
  EXPECT_EQ(bounds[1], 1);
  EXPECT_EQ(bounds[2], 2);
  EXPECT_EQ(bounds[3], 6);
  EXPECT_EQ(bounds[4], 9);
}

}  // namespace
}  // namespace gyre::worker_partition_test
