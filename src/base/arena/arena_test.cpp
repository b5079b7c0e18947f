// Arrays of an arena do not overlap, are aligned, and cost no allocation once it is warm.
#include "base/arena/arena.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>
#include <vector>

namespace gyre::arena_test {
namespace {

TEST(Arena, ArraysAreAlignedAndApart) {
  Arena arena;
  std::mt19937 random(7);
  for (int step = 0; step < 5; ++step) {
    std::vector<std::span<std::uint8_t>> pieces;
    for (int i = 0; i < 300; ++i) {
      const std::span<std::uint8_t> piece = arena.make<std::uint8_t>(random() % 3000);
      ASSERT_EQ(reinterpret_cast<std::uintptr_t>(piece.data()) % 64, 0u);
      std::memset(piece.data(), i & 0xff, piece.size());
      pieces.push_back(piece);
    }
    for (int i = 0; i < 300; ++i) {
      for (const std::uint8_t byte : pieces[static_cast<std::size_t>(i)]) ASSERT_EQ(byte, i & 0xff);
    }
    arena.reset();
  }
}

TEST(Arena, WarmStepsDoNotAllocate) {
  Arena arena;
  const auto step = [&arena](std::size_t scale) {
    for (std::size_t i = 1; i <= 40; ++i) arena.make<double>(i * scale);
    arena.reset();
  };
  step(1000);
  step(1000);
  const std::uint64_t before = allocation_count();
  for (int i = 0; i < 10; ++i) step(1000);
  step(3);
  step(1000);
  EXPECT_EQ(allocation_count(), before);
}

TEST(Arena, CountsBytesInUse) {
  Arena arena;
  EXPECT_EQ(arena.bytes_used(), 0u);
  EXPECT_TRUE(arena.make<int>(0).empty());
  arena.make<std::uint8_t>(1);
  EXPECT_EQ(arena.bytes_used(), 64u);
  arena.make<std::uint8_t>(1000000);
  const std::size_t used = arena.bytes_used();
  EXPECT_EQ(used, 64u + 1000000u);
  EXPECT_GE(arena.capacity(), used);
  arena.reset();
  EXPECT_EQ(arena.bytes_used(), 0u);
  EXPECT_EQ(arena.high_water(), used);
  arena.make<int>(3);
  EXPECT_EQ(arena.high_water(), used);
}

TEST(Arena, ScopesReuseMemory) {
  Arena arena;
  const auto step = [&arena] {
    arena.make<std::uint8_t>(1000);
    for (int part = 0; part < 10; ++part) {
      const ArenaScope scope(arena);
      const std::span<std::uint8_t> outer = arena.make<std::uint8_t>(100000);
      std::memset(outer.data(), 1, outer.size());
      {
        const ArenaScope inner(arena);
        const std::span<std::uint8_t> piece = arena.make<std::uint8_t>(200000);
        std::memset(piece.data(), 2, piece.size());
      }
      for (const std::uint8_t byte : outer) ASSERT_EQ(byte, 1);
    }
    EXPECT_EQ(arena.bytes_used(), 1024u);
  };
  step();
  EXPECT_EQ(arena.high_water(), 1024u + 100032u + 200000u);
  arena.reset();
  EXPECT_LE(arena.capacity(), arena.high_water() / 16 * 17 + 128);
  const std::uint64_t before = allocation_count();
  for (int i = 0; i < 5; ++i) {
    step();
    arena.reset();
  }
  EXPECT_EQ(allocation_count(), before);
}

TEST(Arena, ReleasesMemoryUnusedForLong) {
  Arena arena;
  arena.make<std::uint8_t>(1 << 20);
  for (int i = 0; i < 200; ++i) {
    arena.reset();
    arena.make<std::uint8_t>(20000);
  }
  EXPECT_LT(arena.capacity(), 30000u);
}

TEST(Arena, ReleasesAllMemory) {
  const std::uint64_t before = total_bytes();
  {
    Arena arena;
    for (int i = 0; i < 20; ++i) arena.make<int>(10000);
    Arena other = std::move(arena);
    other.make<int>(5)[4] = 1;
    arena = std::move(other);
    arena.reset();
    EXPECT_GT(total_bytes(), before);
  }
  EXPECT_EQ(total_bytes(), before);
}

TEST(Arena, UnwrittenFloatsShowInDebugBuilds) {
  if (!kAssertsActive) GTEST_SKIP() << "memory is not filled";
  Arena arena;
  for (const float value : arena.make<float>(10)) EXPECT_TRUE(std::isnan(value));
}

}  // namespace
}  // namespace gyre::arena_test
