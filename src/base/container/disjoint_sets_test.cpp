// Sets are what a search through all pairs that were united says.
#include "base/container/disjoint_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

namespace gyre::disjoint_sets_test {
namespace {

// By member: the lowest that hangs together with it.
std::vector<std::uint32_t> search(std::size_t count,
                                  const std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
  std::vector<std::uint32_t> lowest(count);
  for (std::uint32_t i = 0; i < count; ++i) lowest[i] = i;
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& [a, b] : pairs) {
      const std::uint32_t low = std::min(lowest[a], lowest[b]);
      changed = changed || lowest[a] != low || lowest[b] != low;
      lowest[a] = lowest[b] = low;
    }
  }
  return lowest;
}

TEST(DisjointSets, AreNamedByTheLowestThatHangsTogether) {
  std::mt19937 random(11);
  const auto below = [&](std::uint32_t most) { return std::uint32_t(random() % most); };
  for (int repeat = 0; repeat < 50; ++repeat) {
    const std::uint32_t count = 1 + below(60);
    std::vector<std::uint32_t> room(count);
    const DisjointSets sets(room);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (std::uint32_t n = below(60); n > 0; --n) {
      pairs.push_back({below(count), below(count)});
      sets.unite(pairs.back().first, pairs.back().second);
    }
    const std::vector<std::uint32_t> expected = search(count, pairs);
    for (std::uint32_t i = 0; i < count; ++i) EXPECT_EQ(sets.of(i), expected[i]);
    sets.flatten();
    EXPECT_EQ(room, expected);
  }
}

TEST(DisjointSets, FlattenWhatWasNeverAskedFor) {
  std::vector<std::uint32_t> room(5);
  const DisjointSets sets(room);
  sets.unite(3, 4), sets.unite(2, 3), sets.unite(1, 2), sets.unite(0, 1);
  sets.flatten();
  EXPECT_EQ(room, (std::vector<std::uint32_t>{0, 0, 0, 0, 0}));
}

TEST(DisjointSets, LeaveOutWhatIsNoMember) {
  std::vector<std::uint32_t> room(6);
  const std::vector<std::uint32_t> members{1, 2, 4, 5};
  const DisjointSets sets(room, members);
  sets.unite(4, 2), sets.unite(5, 4);
  sets.flatten(members);
  constexpr std::uint32_t kNoSet = DisjointSets::kNoSet;
  EXPECT_EQ(room, (std::vector<std::uint32_t>{kNoSet, 1, 2, kNoSet, 2, 2}));
  EXPECT_TRUE(sets.has(1));
  EXPECT_FALSE(sets.has(3));
}

}  // namespace
}  // namespace gyre::disjoint_sets_test
