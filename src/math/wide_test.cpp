// The promise of wide.h: every width on every CPU kind gives the bits of width 1, for ordinary numbers, denormals,
// infinities and NaN; width 1 gives the bits of plain C++.
#include "math/wide.h"

#include "random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "math/wide_test_kernels.h"

namespace gyre::wide_test {
namespace {

struct Random : testing_random::Mixed {
  Random() : Mixed{0x94d049bb133111ebu} {}
};

// Numbers of all kinds; every eighth block of 16 has only ordinary ones, so that ordinary results occur often.
std::vector<float> numbers(int count) {
  const float infinity = std::numeric_limits<float>::infinity();
  const float special[] = {0.0f,
                           -0.0f,
                           1.0f,
                           -1.0f,
                           0.5f,
                           2.0f,
                           infinity,
                           -infinity,
                           std::numeric_limits<float>::quiet_NaN(),
                           1.0e-45f,
                           -1.0e-45f,
                           1.0e-39f,
                           -1.1754942e-38f,
                           1.1754944e-38f,
                           3.4028235e38f,
                           -3.4028235e38f,
                           16777216.0f,
                           -2147483648.0f,
                           1.0000001f,
                           0.99999994f};
  Random random;
  std::vector<float> list;
  for (int i = 0; i < count * kWideTestInputs; ++i) {
    const std::uint64_t bits = random.next();
    const float ordinary = float(double(bits >> 11) * 0x1p-50) - 4.0f;
    const int kind = (i / 16) % 8 == 0 ? 0 : int(bits % 4);
    if (kind < 2) {
      list.push_back(ordinary);
    } else if (kind == 2) {
      list.push_back(special[(bits >> 8) % (sizeof special / sizeof special[0])]);
    } else {
      list.push_back(__builtin_bit_cast(float, std::uint32_t(bits >> 32)));  // any float at all
    }
  }
  return list;
}

// The payload of a NaN is not fixed by IEEE 754, so all NaNs count as one. An integer result that looks like this NaN
// is replaced on both sides alike.
std::uint32_t comparable(std::uint32_t bits) {
  return (bits & 0x7fffffffu) > 0x7f800000u ? 0x7fc00000u : bits;
}

constexpr int kCount = 16 * 512;
constexpr std::uint32_t kUnused = 0xdeadbeefu;

std::vector<std::uint32_t> run(WideTest test, int width, const std::vector<float>& inputs) {
  std::vector<std::uint32_t> results(std::size_t(kCount) * kWideTestResults, kUnused);
  test(width, inputs.data(), kCount, results.data());
  return results;
}

void expect_as_width_one(const char* kind, WideTest test) {
  const std::vector<float> inputs = numbers(kCount);
  const std::vector<std::uint32_t> expected = run(run_wide_test_w1, 1, inputs);
  for (const int width : {1, 4, 8, 16}) {
    const std::vector<std::uint32_t> found = run(test, width, inputs);
    int shown = 0;
    for (std::size_t i = 0; i < found.size() && shown < 10; ++i) {
      if (comparable(found[i]) == comparable(expected[i])) continue;
      ++shown;
      const std::size_t row = i / kCount, column = i % kCount;
      ADD_FAILURE() << kind << " width " << width << ", result row " << row << " at " << column << ": "
                    << std::hex << found[i] << " instead of " << expected[i] << " for " << inputs[column]
                    << ", " << inputs[kCount + column] << ", " << inputs[2 * kCount + column];
    }
  }
}

TEST(Wide, BaselineOfEveryWidthIsWidthOne) { expect_as_width_one("w1", run_wide_test_w1); }

#if defined(__x86_64__)
TEST(Wide, Sse2IsWidthOne) { expect_as_width_one("sse2", run_wide_test_sse2); }

TEST(Wide, Avx2IsWidthOne) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "no AVX2 here";
  expect_as_width_one("avx2", run_wide_test_avx2);
}

TEST(Wide, Avx512IsWidthOne) {
  if (!__builtin_cpu_supports("avx512f") || !__builtin_cpu_supports("avx512dq") ||
      !__builtin_cpu_supports("avx512vl") || !__builtin_cpu_supports("avx512bw")) {
    GTEST_SKIP() << "no AVX-512 here";
  }
  expect_as_width_one("avx512", run_wide_test_avx512);
}
#elif defined(__aarch64__)
TEST(Wide, NeonIsWidthOne) { expect_as_width_one("neon", run_wide_test_neon); }
#elif defined(__EMSCRIPTEN__)
TEST(Wide, WasmIsWidthOne) { expect_as_width_one("wasm", run_wide_test_wasm); }
#endif

// Width 1 against the language's own operators: the reference for all other widths.
TEST(Wide, WidthOneIsPlainArithmetic) {
  const std::vector<float> inputs = numbers(kCount);
  for (int i = 0; i < kCount; ++i) {
    const float a = inputs[std::size_t(i)], b = inputs[std::size_t(kCount + i)];
    const Wide<1> x = a, y = b;
    const auto same = [](float found, float expected) {
      return comparable(__builtin_bit_cast(std::uint32_t, found)) ==
             comparable(__builtin_bit_cast(std::uint32_t, expected));
    };
    EXPECT_TRUE(same((x + y).v, a + b));
    EXPECT_TRUE(same((x - y).v, a - b));
    EXPECT_TRUE(same((x * y).v, a * b));
    EXPECT_TRUE(same((x / y).v, a / b));
    EXPECT_TRUE(same((-x).v, -a));
    EXPECT_TRUE(same(sqrt(x).v, std::sqrt(a)));
    EXPECT_TRUE(same(min(x, y).v, a < b ? a : b));
    EXPECT_TRUE(same(max(x, y).v, a > b ? a : b));
    EXPECT_TRUE(same(absolute(x).v, std::fabs(a)));
    EXPECT_TRUE(same(copy_sign(x, y).v, std::copysign(a, b)));
    EXPECT_EQ((x < y)[0], a < b);
    EXPECT_EQ((x >= y)[0], a >= b);
    EXPECT_EQ((x == y)[0], a == b);
    EXPECT_EQ((x != y)[0], a != b);
  }
}

template <int W>
void expect_lanes() {
  alignas(64) float numbers_in[W];
  for (int i = 0; i < W; ++i) numbers_in[i] = float(i) - 1.5f;
  const Wide<W> a = Wide<W>::load(numbers_in);
  for (int i = 0; i < W; ++i) EXPECT_EQ(a[i], numbers_in[i]);
  alignas(64) float stored[W + 1];
  a.store(stored);
  a.store_unaligned(stored + 1);
  for (int i = 0; i < W; ++i) EXPECT_EQ(stored[i + 1], numbers_in[i]);
  EXPECT_EQ(Wide<W>::load_unaligned(stored + 1)[W - 1], numbers_in[W - 1]);

  Wide<W> zero{};
  for (int i = 0; i < W; ++i) EXPECT_EQ(zero[i], 0.0f);
  for (int i = 0; i < W; ++i) EXPECT_TRUE(std::signbit(Wide<W>(-0.0f)[i]));
  EXPECT_TRUE(any(Mask<W>::splat(true)) && all(Mask<W>::splat(true)));
  EXPECT_TRUE(none(Mask<W>::splat(false)) && !all(Mask<W>::splat(false)));
  EXPECT_EQ(to_bits(Mask<W>::splat(true)), (1u << W) - 1u);
  for (int i = 0; i < W; ++i) {
    Wide<W> one{};
    one.set(i, 1.0f);
    const Mask<W> mask = one > 0.5f;
    EXPECT_TRUE(any(mask));
    EXPECT_EQ(all(mask), W == 1);
    EXPECT_EQ(to_bits(mask), 1u << i);
    EXPECT_EQ(to_bits(Mask<W>::of_bits(1u << i)), 1u << i);
    for (int j = 0; j < W; ++j) EXPECT_EQ(mask[j], j == i);
    for (int j = 0; j < W; ++j) EXPECT_EQ(select(mask, a, zero)[j], j == i ? a[j] : 0.0f);
    EXPECT_EQ(truncate(a)[i], int(a[i]));
    EXPECT_EQ(to_float(WideInt<W>(7))[i], 7.0f);
  }
}

// The other widths are compared with these results.
TEST(Wide, LanesLoadsMasks) {
  expect_lanes<1>();
  expect_lanes<4>();
}

}  // namespace
}  // namespace gyre::wide_test
