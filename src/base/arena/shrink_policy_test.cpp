// Memory is released after it was too large for long, and not before.
#include "base/arena/shrink_policy.h"

#include <gtest/gtest.h>

namespace gyre::shrink_policy_test {
namespace {

constexpr int kSteps = 63;

TEST(ShrinkPolicy, RestsAfterManyStepsOfLittleUse) {
  ShrinkPolicy clock;
  const std::size_t allocated = 1 << 20;
  for (int i = 0; i < kSteps - 1; ++i) EXPECT_FALSE(clock.should_shrink(allocated / 8, allocated));
  // After one busy step the count starts again.
  EXPECT_FALSE(clock.should_shrink(allocated / 2, allocated));
  for (int i = 0; i < kSteps - 1; ++i)
    EXPECT_FALSE(clock.should_shrink(i == 20 ? allocated / 4 : 100, allocated));
  EXPECT_TRUE(clock.should_shrink(100, allocated));
  EXPECT_EQ(clock.max_needed(), allocated / 4);
}

TEST(ShrinkPolicy, LeavesSmallMemoryAlone) {
  ShrinkPolicy clock;
  for (int i = 0; i < 10 * kSteps; ++i) EXPECT_FALSE(clock.should_shrink(0, 10000));
}

TEST(ShrinkPolicy, TrimsAnArray) {
  ShrinkPolicy clock;
  Array<int> array;
  array.reserve(100000);
  for (int i = 0; i < kSteps; ++i) {
    EXPECT_EQ(array.capacity(), 100000u);
    clock.trim(array, i == 5 ? 30 : 0);
  }
  EXPECT_EQ(array.capacity(), 60u);
}

}  // namespace
}  // namespace gyre::shrink_policy_test
