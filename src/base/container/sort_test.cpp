// The sorts against the standard ones, including stability and keys that differ in few bytes.
#include "base/container/sort.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace gyre::sort_test {
namespace {

using Keys = std::vector<std::uint64_t>;

Keys random_keys(std::size_t count, std::uint64_t mask) {
  std::mt19937_64 random(count);
  Keys keys(count);
  for (std::uint64_t& key : keys) key = (random() & mask) | (0x0123000000000000 & ~mask);
  return keys;
}

constexpr std::size_t kSizes[] = {0, 1, 2, 3, 15, 16, 17, 31, 33, 47, 48, 49, 255, 256, 1000, 20000};
constexpr std::uint64_t kMasks[] = {
    0, 0xff, 0xff00, 0x3, 0xffff0000ffff, ~std::uint64_t{0}, 0xff00000000000000};

TEST(Sort, RadixSortsKeys) {
  for (const std::size_t size : kSizes) {
    for (const std::uint64_t mask : kMasks) {
      Keys keys = random_keys(size, mask);
      Keys expected = keys;
      std::sort(expected.begin(), expected.end());
      Keys scratch(size);
      radix_sort_u64(keys, scratch);
      ASSERT_EQ(keys, expected) << size << " keys, mask " << mask;
      radix_sort_u64(keys, scratch);
      ASSERT_EQ(keys, expected) << "sorted input";
    }
  }
}

TEST(Sort, RadixTakesValuesAlongInOrder) {
  for (const std::size_t size : kSizes) {
    for (const std::uint64_t mask : kMasks) {
      Keys keys = random_keys(size, mask);
      std::vector<std::pair<std::uint64_t, std::uint32_t>> expected;
      std::vector<std::uint32_t> values;
      for (std::uint32_t i = 0; i < size; ++i) {
        values.push_back(i);
        expected.emplace_back(keys[i], i);
      }
      std::stable_sort(expected.begin(), expected.end(),
                       [](const auto& a, const auto& b) { return a.first < b.first; });
      Keys scratch_keys(size);
      std::vector<std::uint32_t> scratch_values(size);
      radix_sort_pairs(keys, values, scratch_keys, scratch_values);
      for (std::size_t i = 0; i < size; ++i) {
        ASSERT_EQ(keys[i], expected[i].first);
        ASSERT_EQ(values[i], expected[i].second) << "equal keys keep their order";
      }
    }
  }
}

TEST(Sort, MergeIsStable) {
  struct Item {
    int key;
    int place;
    bool operator==(const Item&) const = default;
  };
  const auto less = [](const Item& a, const Item& b) { return a.key < b.key; };
  std::mt19937 random(1);
  for (const std::size_t size : kSizes) {
    for (const int kinds : {1, 3, 1000000}) {
      std::vector<Item> items;
      for (std::size_t i = 0; i < size; ++i) {
        items.push_back({static_cast<int>(random()) % kinds, static_cast<int>(i)});
      }
      std::vector<Item> expected = items;
      std::stable_sort(expected.begin(), expected.end(), less);
      std::vector<Item> scratch(size);
      merge_sort(std::span<Item>(items), std::span<Item>(scratch), less);
      ASSERT_EQ(items, expected) << size << " items of " << kinds << " kinds";
    }
  }
}

TEST(Sort, MergeMovesOwners) {
  std::vector<std::string> words;
  for (int i = 0; i < 500; ++i)
    words.push_back("a word that needs the heap " + std::to_string(i * 7919 % 500));
  std::vector<std::string> expected = words;
  std::sort(expected.begin(), expected.end());
  std::vector<std::string> scratch(words.size());
  merge_sort(std::span<std::string>(words), std::span<std::string>(scratch),
             [](const std::string& a, const std::string& b) { return a < b; });
  EXPECT_EQ(words, expected);
}

TEST(Sort, MergeWithoutScratchForAFewItems) {
  int items[] = {3, 1, 2};
  merge_sort(std::span<int>(items), std::span<int>(), [](int a, int b) { return a > b; });
  EXPECT_EQ(items[0], 3);
  EXPECT_EQ(items[1], 2);
  EXPECT_EQ(items[2], 1);
}

}  // namespace
}  // namespace gyre::sort_test
