// A paged array behaves as an array whose elements never move.
#include "base/container/paged_array.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace gyre::paged_array_test {
namespace {

struct Record {
  std::uint64_t words[5] = {9};
};

TEST(PagedArray, AgreesWithAVector) {
  std::mt19937 random(2);
  PagedArray<Record, 8> paged;
  std::vector<Record> expected;
  for (std::uint64_t round = 0; round < 2000; ++round) {
    if (random() % 10 == 0) {
      const std::size_t count = random() % 100;
      paged.resize(count);
      expected.resize(count);
    }
    if (expected.empty()) continue;
    const std::size_t i = random() % expected.size();
    paged[i].words[1] = round;
    expected[i].words[1] = round;
    PagedArray<Record, 8> copy;
    copy.resize(random() % 50);
    copy = paged;
    const PagedArray<Record, 8> moved = std::move(copy);
    ASSERT_EQ(moved.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k) {
      ASSERT_EQ(moved[k].words[0], expected[k].words[0]);
      ASSERT_EQ(moved[k].words[1], expected[k].words[1]);
    }
  }
}

TEST(PagedArray, GrowsWithoutMovingOrWaste) {
  const std::uint64_t before = total_bytes();
  {
    PagedArray<Record, 64> paged;
    paged.resize(1);
    const Record* const first = &paged[0];
    for (std::size_t count = 1; count < 10000; ++count) paged.resize(count);
    EXPECT_EQ(&paged[0], first);
    EXPECT_LE(paged.bytes(), (paged.size() + 64) * sizeof(Record) + 256 * sizeof(void*));
    EXPECT_EQ(total_bytes(), before + paged.bytes());
    paged.resize(65);
    EXPECT_LE(paged.bytes(), 128 * sizeof(Record) + 256 * sizeof(void*));
  }
  EXPECT_EQ(total_bytes(), before);
}

}  // namespace
}  // namespace gyre::paged_array_test
