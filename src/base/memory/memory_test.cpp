// Blocks are aligned and counted, and hooks see every block with its size and cannot change while blocks exist.
#include "base/memory/memory.h"

#include "base/container/array.h"
#include "base/memory/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <vector>

namespace gyre::memory_test {
namespace {

TEST(Memory, AlignedAndCounted) {
  const std::uint64_t bytes_before = total_bytes();
  const std::uint64_t count_before = allocation_count();
  for (const std::size_t bytes : {1u, 63u, 64u, 65u, 4096u, 1000003u}) {
    void* const memory = allocate(bytes);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % kMemoryAlign, 0u);
    std::memset(memory, 0x5a, bytes);
    EXPECT_EQ(total_bytes(), bytes_before + bytes);
    deallocate(memory, bytes);
  }
  EXPECT_EQ(total_bytes(), bytes_before);
  EXPECT_EQ(allocation_count(), count_before + 6);
}

TEST(Memory, NothingForNothing) {
  const std::uint64_t count_before = allocation_count();
  EXPECT_EQ(allocate(0), nullptr);
  deallocate(nullptr, 0);
  EXPECT_EQ(allocation_count(), count_before);
}

unsigned char pattern(std::size_t i) { return static_cast<unsigned char>(i * 7 % 251); }
void fill(void* memory, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) static_cast<unsigned char*>(memory)[i] = pattern(i);
}
bool holds(const void* memory, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) {
    if (static_cast<const unsigned char*>(memory)[i] != pattern(i)) return false;
  }
  return true;
}

// From and to sizes that are copied, sizes that the heap changes and sizes in large pages.
TEST(Memory, ReallocationKeepsTheContent) {
  const std::uint64_t bytes_before = total_bytes();
  std::size_t bytes = 1;
  void* memory = allocate(bytes);
  fill(memory, bytes);
  void* const between = allocate(100'000);  // the memory behind it is in use
  for (const std::size_t wanted : {100u, 5000u, 200'001u, 3'000'000u, 150'000u, 1'000'064u, 9'000'000u,
                                   5'000'000u, 64u, 700'000u, 700'000u}) {
    const std::size_t kept = std::min(bytes, wanted);
    memory = reallocate(memory, bytes, wanted, kept);
    bytes = wanted;
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(memory) % kMemoryAlign, 0u) << wanted;
    EXPECT_TRUE(holds(memory, kept)) << wanted;
    EXPECT_EQ(total_bytes(), bytes_before + 100'000 + bytes);
    fill(memory, bytes);
  }
  memory = reallocate(memory, bytes, 0, 0);
  EXPECT_EQ(memory, nullptr);
  memory = reallocate(memory, 0, 640, 0);
  EXPECT_NE(memory, nullptr);
  deallocate(memory, 640);
  deallocate(between, 100'000);
  EXPECT_EQ(total_bytes(), bytes_before);
}

// Blocks of the heap begin a large page only by chance.
TEST(Memory, LargeBlocksBeginALargePageAndSmallOnesDoNot) {
  if (!kHasLargePages) GTEST_SKIP() << "no large pages here";
  const auto begins_a_page = [](void* memory) {
    return reinterpret_cast<std::uintptr_t>(memory) % kLargePage == 0;
  };
  constexpr std::size_t kFrom = 512 * 1024;  // as gyre/memory.h says
  std::vector<void*> small;
  for (int i = 0; i < 8; ++i) small.push_back(allocate(kFrom - 1));
  EXPECT_FALSE(std::all_of(small.begin(), small.end(), begins_a_page));
  std::size_t bytes = kFrom;
  void* memory = allocate(bytes);
  EXPECT_TRUE(begins_a_page(memory));
  for (const std::size_t wanted : {kFrom * 9, kFrom * 2, kFrom - 1, kFrom, kFrom * 5}) {
    memory = reallocate(memory, bytes, wanted, std::min(bytes, wanted));
    bytes = wanted;
    EXPECT_TRUE(begins_a_page(memory) || bytes < kFrom) << bytes;
  }
  deallocate(memory, bytes);
  for (void* const block : small) deallocate(block, kFrom - 1);
}

// After a large block was freed, the heap keeps smaller blocks in one range, moves them there byte by byte, and loses
// alignment. The blocks between and behind have odd sizes and stay.
TEST(Memory, StaysAlignedWhereTheHeapMovesIt) {
  const std::uint64_t bytes_before = total_bytes();
  void* volatile large = std::malloc(24'000'000);
  std::free(large);
  std::vector<void*> between, blocks;
  constexpr std::size_t kBytes = 150'000, kMore = 400'000;
  for (std::size_t i = 0; i < 16; ++i) {
    blocks.push_back(allocate(kBytes));
    fill(blocks.back(), kBytes);
    between.push_back(std::malloc(1000 + 16 * i));
  }
  for (void*& block : blocks) {
    block = reallocate(block, kBytes, kMore, kBytes);
    between.push_back(std::malloc(1008 + 16 * between.size()));
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % kMemoryAlign, 0u);
    EXPECT_TRUE(holds(block, kBytes));
  }
  for (void* const block : blocks) deallocate(block, kMore);
  for (void* const block : between) std::free(block);
  EXPECT_EQ(total_bytes(), bytes_before);
}

struct Meter {
  std::size_t out = 0;
  int taken = 0;
  int returned = 0;
  int changed = 0;
};

AllocatorHooks metered(Meter& meter) {
  return {.allocate =
              [](std::size_t bytes, std::size_t align, void* user) {
                Meter& m = *static_cast<Meter*>(user);
                m.out += bytes;
                ++m.taken;
                void* memory = nullptr;
                return posix_memalign(&memory, align, bytes) == 0 ? memory : nullptr;
              },
          .deallocate =
              [](void* memory, std::size_t bytes, void* user) {
                Meter& m = *static_cast<Meter*>(user);
                m.out -= bytes;
                ++m.returned;
                std::free(memory);
              },
          .user = &meter};
}

TEST(Memory, HooksSeeEveryBlock) {
  Meter meter;
  ASSERT_EQ(total_bytes(), 0u) << "a test before this one leaked";
  ASSERT_TRUE(set_allocator(metered(meter)));
  {
    Array<int> numbers;
    for (int i = 0; i < 1000; ++i) numbers.push_back(i);
    EXPECT_EQ(meter.out, numbers.bytes());
    EXPECT_FALSE(set_allocator({})) << "blocks must go back where they came from";
    numbers.push_back(1);
  }
  EXPECT_EQ(meter.out, 0u);
  EXPECT_GT(meter.taken, 3);
  EXPECT_EQ(meter.taken, meter.returned);
  ASSERT_TRUE(set_allocator({}));
  const int taken = meter.taken;
  Array<int> more{1, 2, 3};
  EXPECT_EQ(meter.taken, taken) << "the default heap is back";
}

// The hook resizes large blocks only; without one they are allocated, copied and freed.
TEST(Memory, HooksMayChangeSizes) {
  for (const bool changes : {false, true}) {
    Meter meter;
    AllocatorHooks hooks = metered(meter);
    if (changes) {
      hooks.reallocate = [](void* memory, std::size_t old_bytes, std::size_t bytes, std::size_t align,
                            void* user) {
        EXPECT_GE(std::min(old_bytes, bytes), 128u * 1024u);
        Meter& m = *static_cast<Meter*>(user);
        ++m.changed;
        m.out += bytes - old_bytes;
        void* moved = nullptr;
        if (posix_memalign(&moved, align, bytes) != 0) return moved;
        std::memcpy(moved, memory, std::min(old_bytes, bytes));
        std::free(memory);
        return moved;
      };
    }
    ASSERT_TRUE(set_allocator(hooks));
    {
      Array<int> numbers;
      for (int i = 0; i < 200'000; ++i) numbers.push_back(i);
      EXPECT_EQ(meter.out, numbers.bytes());
      EXPECT_EQ(meter.changed > 0, changes);
      for (int i = 0; i < 200'000; ++i) ASSERT_EQ(numbers[i], i);
    }
    EXPECT_EQ(meter.out, 0u);
    EXPECT_EQ(meter.taken, meter.returned);
    ASSERT_TRUE(set_allocator({}));
  }
}

TEST(MemoryDeath, RunningOutEndsTheProgram) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  EXPECT_DEATH(
      {
        set_allocator({.allocate = [](std::size_t, std::size_t, void*) -> void* { return nullptr; },
                       .deallocate = [](void*, std::size_t, void*) {}});
        Array<int> numbers;
        numbers.push_back(1);
      },
      "there is memory");
}

}  // namespace
}  // namespace gyre::memory_test
