// FlatMap against std::map, and against its documented order.
#include "base/container/flat_map.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>
#include <vector>

namespace gyre::flat_map_test {
namespace {

TEST(FlatMap, Empty) {
  FlatMap<int> map;
  EXPECT_EQ(map.find(0), nullptr);
  EXPECT_FALSE(map.erase(0));
  EXPECT_TRUE(map.entries().empty());
  map.clear();
  EXPECT_EQ(map.bytes(), 0u);
}

TEST(FlatMap, TakesAnyKey) {
  FlatMap<int> map;
  const std::uint64_t keys[] = {0, 1, 0xffffffff, 0x100000000, ~std::uint64_t{0}, std::uint64_t{1} << 63};
  int value = 0;
  for (const std::uint64_t key : keys) map.insert(key, value++);
  value = 0;
  for (const std::uint64_t key : keys) {
    ASSERT_NE(map.find(key), nullptr);
    EXPECT_EQ(*map.find(key), value++);
  }
  EXPECT_EQ(map.size(), 6u);
}

TEST(FlatMap, InsertReplacesAndFindOrInsertKeeps) {
  FlatMap<int> map;
  map.insert(5, 1);
  map.insert(7, 2);
  map.insert(5, 3);
  EXPECT_EQ(map.size(), 2u);
  EXPECT_EQ(map.entries()[0].value, 3);
  EXPECT_EQ(map.find_or_insert(7, 9), 2);
  EXPECT_EQ(++map.find_or_insert(8), 1);
  EXPECT_EQ(*map.find(8), 1);
}

TEST(FlatMap, OwningValues) {
  FlatMap<std::unique_ptr<int>> map;
  for (int i = 0; i < 100; ++i) map.insert(static_cast<std::uint64_t>(i), std::make_unique<int>(i));
  for (int i = 0; i < 100; i += 2) EXPECT_TRUE(map.erase(static_cast<std::uint64_t>(i)));
  for (int i = 1; i < 100; i += 2) EXPECT_EQ(**map.find(static_cast<std::uint64_t>(i)), i);
}

TEST(FlatMap, WarmMapDoesNotAllocate) {
  FlatMap<int> map;
  map.reserve(1000);
  const std::uint64_t before = allocation_count();
  for (int round = 0; round < 3; ++round) {
    for (std::uint64_t i = 0; i < 1000; ++i) map.insert(i * 77, 1);
    map.clear();
  }
  EXPECT_EQ(allocation_count(), before);
}

// Few distinct keys make long shared runs of cells; many make growth.
void compare_with_map(std::uint64_t key_count, std::uint64_t stride) {
  std::mt19937_64 random(11);
  FlatMap<std::uint64_t> map;
  std::map<std::uint64_t, std::uint64_t> oracle;
  std::vector<std::uint64_t> order;
  for (std::uint64_t step = 0; step < 60000; ++step) {
    const std::uint64_t key = random() % key_count * stride;
    const bool known = oracle.count(key) != 0;
    if (random() % 100 < 50) {
      if (!known) order.push_back(key);
      map.insert(key, step);
      oracle[key] = step;
    } else {
      ASSERT_EQ(map.erase(key), known);
      if (!known) continue;
      oracle.erase(key);
      *std::find(order.begin(), order.end(), key) = order.back();
      order.pop_back();
    }
    if (step % 1000 != 0) continue;
    ASSERT_EQ(map.size(), oracle.size());
    for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(map.entries()[i].key, order[i]);
    for (std::uint64_t k = 0; k < key_count; ++k) {
      const auto found = oracle.find(k * stride);
      const std::uint64_t* const value = map.find(k * stride);
      ASSERT_EQ(value != nullptr, found != oracle.end());
      if (value != nullptr) {
        ASSERT_EQ(*value, found->second);
      }
    }
  }
  std::size_t walked = 0;
  map.for_each([&](std::uint64_t key, std::uint64_t& value) {
    EXPECT_EQ(key, order[walked++]);
    value = 1;
  });
  EXPECT_EQ(walked, order.size());
}

TEST(FlatMap, BehavesLikeMap) {
  compare_with_map(13, 1);
  compare_with_map(300, 1);
  compare_with_map(1000, std::uint64_t{1} << 32);
}

}  // namespace
}  // namespace gyre::flat_map_test
