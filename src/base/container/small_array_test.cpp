// A small array behaves as a vector, and allocates only beyond its own room.
#include "base/container/small_array.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

namespace gyre::small_array_test {
namespace {

TEST(SmallArray, AgreesWithAVector) {
  std::mt19937 random(5);
  SmallArray<std::uint32_t, 2> list;
  std::vector<std::uint32_t> expected;
  for (std::uint32_t round = 0; round < 3000; ++round) {
    const std::size_t at = random() % (expected.size() + 1);
    // Grows in the first half and shrinks in the second.
    if (random() % 3000 > round || at == expected.size()) {
      list.insert_at(at, round);
      expected.insert(expected.begin() + std::ptrdiff_t(at), round);
    } else {
      list.erase_at(at);
      expected.erase(expected.begin() + std::ptrdiff_t(at));
    }
    ASSERT_EQ(std::vector<std::uint32_t>(list.begin(), list.end()), expected);
  }
  SmallArray<std::uint32_t, 2> copy = list;
  const SmallArray<std::uint32_t, 2> moved = std::move(list);
  EXPECT_EQ(std::vector<std::uint32_t>(moved.begin(), moved.end()), expected);
  copy.push_back(7);
  EXPECT_EQ(copy.size(), moved.size() + 1);
}

TEST(SmallArray, AllocatesOnlyBeyondItsRoom) {
  const std::uint64_t before = total_bytes();
  {
    SmallArray<std::uint32_t, 2> list;
    list.push_back(1);
    list.push_back(2);
    EXPECT_EQ(total_bytes(), before);
    list.push_back(3);
    EXPECT_EQ(total_bytes(), before + list.bytes());
    SmallArray<std::uint32_t, 2> other;
    other.push_back(4);
    other = std::move(list);
    EXPECT_EQ(other.size(), 3u);
    EXPECT_EQ(total_bytes(), before + other.bytes());
    other.clear();
    EXPECT_EQ(total_bytes(), before);
  }
  EXPECT_EQ(total_bytes(), before);
  static_assert(sizeof(SmallArray<std::uint32_t, 2>) == 16);
}

}  // namespace
}  // namespace gyre::small_array_test
