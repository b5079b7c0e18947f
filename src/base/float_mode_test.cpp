// Rounding and denormals inside a FloatMode, and the host's own mode after it.
#include "base/float_mode.h"

#include <gtest/gtest.h>

#include <cfenv>

#if defined(__SSE2__) && !defined(__EMSCRIPTEN__)
#include <xmmintrin.h>
#endif

namespace gyre::float_mode_test {
namespace {

float third() {
  volatile float one = 1.0f;
  volatile float three = 3.0f;
  return one / three;
}

float half_of_smallest_normal() {
  volatile float smallest = 1.17549435e-38f;
  volatile float half = 0.5f;
  return smallest * half;
}

TEST(FloatMode, RoundsToNearestAndRestores) {
  const float nearest = third();
  if (std::fesetround(FE_DOWNWARD) != 0) GTEST_SKIP() << "one rounding only";
  const float down = third();
  float inside = 0.0f;
  {
    const FloatMode mode;
    inside = third();
  }
  const float after = third();
  std::fesetround(FE_TONEAREST);
  EXPECT_NE(down, nearest);
  EXPECT_EQ(inside, nearest);
  EXPECT_EQ(after, down);
}

TEST(FloatMode, KeepsDenormals) {
  const FloatMode mode;
  EXPECT_GT(half_of_smallest_normal(), 0.0f);
}

#if defined(__SSE2__) && !defined(__EMSCRIPTEN__)
TEST(FloatMode, KeepsDenormalsInAHostThatFlushesThem) {
  const unsigned host = _mm_getcsr();
  const unsigned flushing = host | 0x8040;
  _mm_setcsr(flushing);
  const float outside = half_of_smallest_normal();
  float inside = 0.0f;
  {
    const FloatMode mode;
    {
      const FloatMode nested;
      inside = half_of_smallest_normal();
    }
  }
  const unsigned after = _mm_getcsr();
  _mm_setcsr(host);
  EXPECT_EQ(outside, 0.0f);
  EXPECT_GT(inside, 0.0f);
  EXPECT_EQ(after & 0xffc0u, flushing & 0xffc0u);
}
#endif

}  // namespace
}  // namespace gyre::float_mode_test
