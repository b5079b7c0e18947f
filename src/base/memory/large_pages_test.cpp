// Blocks in large pages keep their content in every size, wherever they move, and the system is asked for large pages.
#include "base/memory/large_pages.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace gyre::large_pages_test {
namespace {

class LargePages : public testing::Test {
 protected:
  void SetUp() override {
    if (!kHasLargePages) GTEST_SKIP() << "no large pages here";
  }
};

unsigned char pattern(std::size_t i) { return static_cast<unsigned char>(i * 11 % 241); }
void fill(void* memory, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) static_cast<unsigned char*>(memory)[i] = pattern(i);
}
// The first byte with another value; `bytes` if there is none.
std::size_t first_fault(const void* memory, std::size_t bytes) {
  std::size_t i = 0;
  while (i < bytes && static_cast<const unsigned char*>(memory)[i] == pattern(i)) ++i;
  return i;
}

// In half of the sizes something is mapped behind the block, so that it must move.
TEST_F(LargePages, EverySizeKeepsTheContent) {
  std::vector<void*> behind;
  std::size_t bytes = 1;
  void* block = map_large_pages(bytes);
  ASSERT_NE(block, nullptr);
  fill(block, bytes);
  bool moved = false;
  for (const std::size_t wanted :
       {kLargePage, kLargePage + 1, 3 * kLargePage, 5 * kLargePage - 1, kLargePage / 2, 9 * kLargePage,
        4 * kLargePage, std::size_t{100}, 2 * kLargePage}) {
    if (behind.size() < 5) behind.push_back(map_large_pages(1));
    void* const next = remap_large_pages(block, bytes, wanted);
    ASSERT_NE(next, nullptr);
    moved = moved || next != block;
    block = next;
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(block) % kLargePage, 0u) << wanted;
    const std::size_t kept = std::min(bytes, wanted);
    EXPECT_EQ(first_fault(block, kept), kept) << wanted;
    bytes = wanted;
    fill(block, bytes);
  }
  EXPECT_TRUE(moved) << "nothing was ever mapped behind";
  unmap_large_pages(block, bytes);
  for (void* const other : behind) unmap_large_pages(other, 1);
}

TEST_F(LargePages, BeginAsZeroAlsoAfterTheyGrew) {
  void* block = map_large_pages(kLargePage);
  ASSERT_NE(block, nullptr);
  fill(block, kLargePage);
  block = remap_large_pages(block, kLargePage, 3 * kLargePage);
  ASSERT_NE(block, nullptr);
  const auto* const bytes = static_cast<const unsigned char*>(block);
  EXPECT_TRUE(
      std::all_of(bytes + kLargePage, bytes + 3 * kLargePage, [](unsigned char b) { return b == 0; }));
  unmap_large_pages(block, 3 * kLargePage);
}

TEST_F(LargePages, MoreThanThereIsIsRefusedAndNothingLost) {
  constexpr std::size_t kTooMuch = SIZE_MAX / 4;
  EXPECT_EQ(map_large_pages(kTooMuch), nullptr);
  EXPECT_EQ(map_large_pages(SIZE_MAX), nullptr);
  void* const block = map_large_pages(kLargePage);
  ASSERT_NE(block, nullptr);
  fill(block, kLargePage);
  EXPECT_EQ(remap_large_pages(block, kLargePage, kTooMuch), nullptr);
  EXPECT_EQ(remap_large_pages(block, kLargePage, SIZE_MAX), nullptr);
  EXPECT_EQ(first_fault(block, kLargePage), kLargePage);
  unmap_large_pages(block, kLargePage);
}

// Small pages that the process has mapped, used or not; 0 if the system does not tell.
std::size_t mapped_pages() {
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages;
}

// Blocks are cut out of larger ranges, and moves leave a range behind.
TEST_F(LargePages, NothingStaysMapped) {
  if (mapped_pages() == 0) GTEST_SKIP() << "this system does not tell";
  const std::size_t before = mapped_pages();
  constexpr std::size_t kRounds = 50;
  for (std::size_t i = 0; i < kRounds; ++i) {
    void* block = map_large_pages(1);
    void* const behind = map_large_pages(1);
    block = remap_large_pages(block, 1, 4 * kLargePage);
    block = remap_large_pages(block, 4 * kLargePage, 2 * kLargePage);
    ASSERT_NE(block, nullptr);
    unmap_large_pages(block, 2 * kLargePage);
    unmap_large_pages(behind, 1);
  }
  // Less than a large page a round: the test's own heap may grow meanwhile.
  EXPECT_LT(mapped_pages(), before + kRounds * kLargePage / 4096 / 4);
}

// The first line and the flags of the range in the system's list that begins with `memory`; empty if there is none.
std::string flags_of_range(const void* memory) {
  char begin[32];
  std::snprintf(begin, sizeof begin, "%lx-",
                static_cast<unsigned long>(reinterpret_cast<std::uintptr_t>(memory)));
  std::ifstream ranges("/proc/self/smaps");
  bool found = false;
  for (std::string line; std::getline(ranges, line);) {
    if (line.compare(0, std::strlen(begin), begin) == 0) found = true;
    if (found && line.compare(0, 8, "VmFlags:") == 0) return line + ' ';
  }
  return {};
}

TEST_F(LargePages, TheSystemIsAskedForThem) {
  if (!std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled")) GTEST_SKIP() << "this system has none";
  void* block = map_large_pages(3 * kLargePage);
  ASSERT_NE(block, nullptr);
  const std::string flags = flags_of_range(block);
  if (flags.empty()) GTEST_SKIP() << "this system does not tell";
  EXPECT_NE(flags.find(" hg "), std::string::npos) << flags;
  void* const behind = map_large_pages(1);
  block = remap_large_pages(block, 3 * kLargePage, 7 * kLargePage);
  ASSERT_NE(block, nullptr);
  EXPECT_NE(flags_of_range(block).find(" hg "), std::string::npos) << "lost by the move";
  unmap_large_pages(block, 7 * kLargePage);
  unmap_large_pages(behind, 1);
}

}  // namespace
}  // namespace gyre::large_pages_test
