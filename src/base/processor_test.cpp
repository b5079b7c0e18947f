#include "base/processor.h"

#include <gtest/gtest.h>

namespace gyre::processor_test {
namespace {

bool is_a_width(int lanes) { return lanes == 1 || lanes == 4 || lanes == 8 || lanes == 16; }

TEST(Processor, HasTheLanesOfKernels) {
  EXPECT_TRUE(is_a_width(max_lanes())) << max_lanes();
  EXPECT_TRUE(is_a_width(best_lanes())) << best_lanes();
  EXPECT_LE(best_lanes(), max_lanes());
}

TEST(Processor, HasNoMoreThanItsInstructions) {
#if defined(__x86_64__)
  EXPECT_GE(max_lanes(), 4);
  EXPECT_EQ(max_lanes() >= 8, __builtin_cpu_supports("avx2") != 0);
  if (max_lanes() == 16) {
    for (const int has : {__builtin_cpu_supports("avx512f"), __builtin_cpu_supports("avx512vl"),
                          __builtin_cpu_supports("avx512dq"), __builtin_cpu_supports("avx512bw")}) {
      EXPECT_NE(has, 0);
    }
  }
#else
  EXPECT_LE(max_lanes(), 4);
#endif
}

TEST(Processor, LimitsTheRequestedLanes) {
  EXPECT_EQ(lanes_for(0), best_lanes());
  EXPECT_EQ(lanes_for(1), 1);
  EXPECT_EQ(lanes_for(4), max_lanes() < 4 ? max_lanes() : 4);
  EXPECT_EQ(lanes_for(16), max_lanes());
  EXPECT_EQ(lanes_for(1000), max_lanes());
}

}  // namespace
}  // namespace gyre::processor_test
