// Bitset against std::vector<bool>, and the ends of words.
#include "base/container/bitset.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace gyre::bitset_test {
namespace {

std::vector<std::size_t> list(const Bitset& bits) {
  std::vector<std::size_t> found;
  bits.for_each_set([&found](std::size_t i) { found.push_back(i); });
  return found;
}

TEST(Bitset, Empty) {
  Bitset bits;
  EXPECT_EQ(bits.size(), 0u);
  EXPECT_FALSE(bits.any());
  EXPECT_FALSE(bits.test(0));
  EXPECT_EQ(bits.find_next(0), 0u);
  EXPECT_TRUE(list(bits).empty());
}

TEST(Bitset, WordBorders) {
  for (const std::size_t size : {1u, 63u, 64u, 65u, 127u, 128u, 129u}) {
    Bitset bits(size);
    bits.set(0);
    bits.set(size - 1);
    EXPECT_TRUE(bits.test(size - 1));
    EXPECT_FALSE(bits.test(size));
    EXPECT_EQ(bits.count(), size == 1 ? 1u : 2u);
    EXPECT_EQ(bits.find_next(1), size == 1 ? size : size - 1);
    bits.clear(0);
    EXPECT_EQ(bits.find_next(0), size == 1 ? size : size - 1);
  }
}

TEST(Bitset, DropsBitsBeyondTheSize) {
  Bitset bits(200);
  for (std::size_t i = 0; i < 200; ++i) bits.set(i);
  bits.resize(70);
  bits.resize(200);
  EXPECT_EQ(bits.count(), 70u);
  EXPECT_EQ(bits.find_next(70), 200u);
}

TEST(Bitset, UniteGrows) {
  Bitset a(10), b(100);
  a.set(3);
  b.set(3);
  b.set(99);
  a.unite(b);
  EXPECT_EQ(list(a), (std::vector<std::size_t>{3, 99}));
  Bitset c(5);
  c.set(1);
  a.unite(c);
  EXPECT_EQ(a.size(), 100u);
  EXPECT_EQ(list(a), (std::vector<std::size_t>{1, 3, 99}));
}

TEST(Bitset, MayClearWhileWalking) {
  Bitset bits(300);
  for (std::size_t i = 0; i < 300; i += 3) bits.set(i);
  std::size_t seen = 0;
  bits.for_each_set([&](std::size_t i) {
    bits.clear(i);
    ++seen;
  });
  EXPECT_EQ(seen, 100u);
  EXPECT_FALSE(bits.any());
}

TEST(Bitset, BehavesLikeBools) {
  std::mt19937 random(3);
  Bitset bits(777);
  std::vector<bool> bools(777);
  for (int step = 0; step < 20000; ++step) {
    const std::size_t i = random() % 777;
    const bool value = random() % 4 == 0;
    bits.assign(i, value);
    bools[i] = value;
    if (step % 500 != 0) continue;
    std::vector<std::size_t> expected;
    for (std::size_t k = 0; k < 777; ++k) {
      ASSERT_EQ(bits.test(k), bools[k]);
      if (bools[k]) expected.push_back(k);
    }
    ASSERT_EQ(list(bits), expected);
    ASSERT_EQ(bits.count(), expected.size());
    std::vector<std::size_t> by_next;
    for (std::size_t k = bits.find_next(0); k < bits.size(); k = bits.find_next(k + 1)) by_next.push_back(k);
    ASSERT_EQ(by_next, expected);
  }
  bits.reset_all();
  EXPECT_EQ(bits, Bitset(777));
  bits.set_all();
  EXPECT_EQ(bits.count(), 777u);
  bits.resize(778);
  EXPECT_FALSE(bits.test(777)) << "nothing beyond the size was set";
}

}  // namespace
}  // namespace gyre::bitset_test
