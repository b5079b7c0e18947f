// The errors stated in trig.h, measured densely against the C library in 80-bit (or wider) arithmetic, and the special
// values. The library is allowed here: it is the oracle.
#include "math/trig.h"

#include "random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace gyre::trig_test {
namespace {

constexpr float kInfinityF = std::numeric_limits<float>::infinity();
constexpr double kInfinityD = std::numeric_limits<double>::infinity();
constexpr float kNaNF = std::numeric_limits<float>::quiet_NaN();
constexpr double kNaND = std::numeric_limits<double>::quiet_NaN();

// Error of `found` in units in the last place of type T at the size of `exact`.
template <class T>
double ulps(T found, long double exact) {
  int exponent = 0;
  std::frexp(exact, &exponent);
  const int lowest = std::numeric_limits<T>::min_exponent;
  const long double unit =
      std::ldexp(1.0L, (exponent < lowest ? lowest : exponent) - std::numeric_limits<T>::digits);
  return double(std::fabs((long double)found - exact) / unit);
}

// A generator of its own, so that the inputs are the same everywhere.
struct Random : testing_random::Mixed {
  Random() : Mixed{0x9e3779b97f4a7c15u} {}
  // A finite double of any size.
  double any_double() {
    for (;;) {
      const double value = __builtin_bit_cast(double, next());
      if (is_finite(value)) return value;
    }
  }
};

double worst(double so_far, double now) { return now > so_far ? now : so_far; }

TEST(Trig, FloatSinCosOverTheWholeRange) {
  double error = 0.0;
  for (std::uint64_t bits = 0; bits < 0x7f800000u; bits += 4099) {
    const float x = __builtin_bit_cast(float, std::uint32_t(bits));
    const SinCos found = sin_cos(x);
    error = worst(error, ulps(found.sin, sinl((long double)x)));
    error = worst(error, ulps(found.cos, cosl((long double)x)));
    const SinCos mirrored = sin_cos(-x);
    ASSERT_EQ(mirrored.sin, -found.sin) << x;
    ASSERT_EQ(mirrored.cos, found.cos) << x;
  }
  EXPECT_LE(error, 0.501);
}

TEST(Trig, FloatSinCosAtMultiplesOfRightAngles) {
  // Reduction errors show first where the sine or the cosine nearly vanishes.
  double error = 0.0;
  for (int k = -200000; k <= 200000; k += 7) {
    const float nearest = float(double(k) * 0.25 * kPiDouble);
    for (const float x :
         {std::nextafter(nearest, -kInfinityF), nearest, std::nextafter(nearest, kInfinityF)}) {
      const SinCos found = sin_cos(x);
      error = worst(error, ulps(found.sin, sinl((long double)x)));
      error = worst(error, ulps(found.cos, cosl((long double)x)));
    }
  }
  EXPECT_LE(error, 0.501);
}

TEST(Trig, DoubleSinCosSmallMediumAndHuge) {
  Random random;
  double error = 0.0;
  const double limits[] = {1.0, 10.0, 1.0e4, 1.0e5, 1.01e5, 1.0e9, 1.0e16};
  for (const double limit : limits) {
    for (int i = 0; i < 60000; ++i) {
      const double x = random.between(-limit, limit);
      const SinCosD found = sin_cos(x);
      error = worst(error, ulps(found.sin, sinl((long double)x)));
      error = worst(error, ulps(found.cos, cosl((long double)x)));
    }
  }
  for (int i = 0; i < 100000; ++i) {
    const double x = random.any_double();
    const SinCosD found = sin_cos(x);
    error = worst(error, ulps(found.sin, sinl((long double)x)));
    error = worst(error, ulps(found.cos, cosl((long double)x)));
  }
  EXPECT_LE(error, 1.0);
}

TEST(Trig, DoubleSinCosNearMultiplesOfPi) {
  double error = 0.0;
  for (int k = 1; k < 300000; k += 11) {
    const double x = double(k) * 0.5 * kPiDouble;
    const SinCosD found = sin_cos(x);
    error = worst(error, ulps(found.sin, sinl((long double)x)));
    error = worst(error, ulps(found.cos, cosl((long double)x)));
  }
  EXPECT_LE(error, 1.0);
  // The double closest to a multiple of pi/2 (W. Kahan's worst case): the cosine is 4.687165924254624e-19.
  const SinCosD hardest = sin_cos(0x1.6ac5b262ca1ffp+849);
  EXPECT_NEAR(absolute(hardest.cos), 4.687165924254624e-19, 1.0e-33);
  EXPECT_EQ(absolute(hardest.sin), 1.0);
}

TEST(Trig, BothReductionsAgreeAtTheirBorder) {
  const SinCosD below = sin_cos(1.0e5), above = sin_cos(std::nextafter(1.0e5, 2.0e5));
  EXPECT_NEAR(below.sin, above.sin, 3.0e-11);
  EXPECT_NEAR(below.cos, above.cos, 3.0e-11);
}

TEST(Trig, SinCosSpecialValues) {
  EXPECT_EQ(sin_cos(0.0f).sin, 0.0f);
  EXPECT_EQ(sin_cos(0.0f).cos, 1.0f);
  EXPECT_TRUE(std::signbit(sin_cos(-0.0f).sin));
  EXPECT_TRUE(std::signbit(sin_cos(-0.0).sin));
  EXPECT_EQ(sin_cos(1.0e-45f).sin, 1.0e-45f);
  EXPECT_EQ(sin_cos(5.0e-324).sin, 5.0e-324);
  for (const float x : {kInfinityF, -kInfinityF, kNaNF}) {
    EXPECT_TRUE(std::isnan(sin_cos(x).sin));
    EXPECT_TRUE(std::isnan(sin_cos(x).cos));
    EXPECT_TRUE(std::isnan(sin_cos(double(x)).sin));
    EXPECT_TRUE(std::isnan(sin_cos(double(x)).cos));
  }
  // Signs of the four quadrants.
  for (int quadrant = -8; quadrant < 8; ++quadrant) {
    const SinCos s = sin_cos((float(quadrant) + 0.5f) * 0.5f * kPi);
    const int q = quadrant & 3;
    EXPECT_EQ(s.sin > 0.0f, q < 2);
    EXPECT_EQ(s.cos > 0.0f, q == 0 || q == 3);
  }
}

TEST(Trig, AtanWithinItsError) {
  Random random;
  double float_error = 0.0, double_error = 0.0;
  for (int i = 0; i < 300000; ++i) {
    // Directions evenly around, and numbers of very different sizes.
    const bool even = i % 2 == 0;
    const double y = even ? random.between(-1, 1) : random.any_double();
    const double x = even ? random.between(-1, 1) : y * (1.0 / 1024.0) * random.between(-2e4, 2e4);
    if (x == 0.0 || y == 0.0 || !is_finite(x)) continue;
    double_error = worst(double_error, ulps(atan2(y, x), atan2l((long double)y, (long double)x)));
    const float yf = float(y), xf = float(x);
    if (xf == 0.0f || yf == 0.0f || !is_finite(xf) || !is_finite(yf)) continue;
    float_error = worst(float_error, ulps(atan2(yf, xf), atan2l((long double)yf, (long double)xf)));
  }
  EXPECT_LE(float_error, 0.501);
  EXPECT_LE(double_error, 2.0);
}

TEST(Trig, AtanSpecialValues) {
  EXPECT_EQ(atan2(0.0f, 0.0f), 0.0f);
  EXPECT_EQ(atan2(-0.0f, -0.0f), 0.0f);
  EXPECT_EQ(atan2(0.0f, 1.0f), 0.0f);
  EXPECT_EQ(atan2(0.0f, -1.0f), kPi);
  EXPECT_EQ(atan2(-0.0f, -1.0f), kPi);
  EXPECT_EQ(atan2(1.0f, 0.0f), 0.5f * kPi);
  EXPECT_EQ(atan2(-1.0f, 0.0f), -0.5f * kPi);
  EXPECT_EQ(atan2(3.0f, 3.0f), 0.25f * kPi);
  EXPECT_EQ(atan2(kInfinityF, 2.0f), 0.5f * kPi);
  EXPECT_EQ(atan2(-kInfinityF, kInfinityF), -0.25f * kPi);
  EXPECT_EQ(atan2(2.0f, -kInfinityF), kPi);
  EXPECT_EQ(atan2(2.0f, kInfinityF), 0.0f);
  EXPECT_TRUE(std::isnan(atan2(kNaNF, 1.0f)));
  EXPECT_TRUE(std::isnan(atan2(1.0f, kNaNF)));
  EXPECT_EQ(atan2(5.0e-324, 5.0e-324), 0.25 * kPiDouble);
  EXPECT_EQ(atan2(1.7e308, 1.7e308), 0.25 * kPiDouble);
  EXPECT_EQ(atan2(5.0e-324, 1.0e308), 0.0);
}

TEST(Trig, AcosWithinItsError) {
  Random random;
  double float_error = 0.0, double_error = 0.0;
  for (int i = 0; i < 300000; ++i) {
    double x = random.between(-1, 1);
    if (i % 3 == 0) x = 1.0 - x * x * x * x * 1.0e-6;  // near the steep end
    if (i % 3 == 1) x = x * x * x * x * 1.0e-3;
    double_error = worst(double_error, ulps(acos(x), acosl((long double)x)));
    const float xf = float(x);
    float_error = worst(float_error, ulps(acos(xf), acosl((long double)xf)));
  }
  EXPECT_LE(float_error, 0.501);
  EXPECT_LE(double_error, 2.0);
}

TEST(Trig, AcosSpecialValues) {
  EXPECT_EQ(acos(1.0f), 0.0f);
  EXPECT_EQ(acos(-1.0f), kPi);
  EXPECT_EQ(acos(0.0f), 0.5f * kPi);
  EXPECT_EQ(acos(1.5f), 0.0f);
  EXPECT_EQ(acos(-kInfinityF), kPi);
  EXPECT_TRUE(std::isnan(acos(kNaNF)));
}

TEST(Trig, ExpWithinItsError) {
  Random random;
  double error = 0.0;
  for (int i = 0; i < 300000; ++i) {
    const double x = i % 2 == 0 ? random.between(-700.0, 700.0) : random.between(-1.0, 1.0);
    error = worst(error, ulps(exp(x), expl((long double)x)));
  }
  EXPECT_LE(error, 1.0);
  EXPECT_EQ(exp(0.0), 1.0);
  EXPECT_EQ(exp(800.0), kInfinityD);
  EXPECT_EQ(exp(-800.0), 0.0);
  EXPECT_EQ(exp(kInfinityD), kInfinityD);
  EXPECT_EQ(exp(-kInfinityD), 0.0);
  EXPECT_TRUE(std::isnan(exp(kNaND)));
  EXPECT_TRUE(is_finite(exp(709.78)));
  EXPECT_LE(ulps(exp(-740.0), expl(-740.0L)), 1.0);  // a denormal result
}

TEST(Trig, LogWithinItsError) {
  Random random;
  double error = 0.0;
  for (int i = 0; i < 300000; ++i) {
    const double x = i % 2 == 0 ? absolute(random.any_double()) : random.between(0.5, 2.0);
    if (x == 0.0 || x == 1.0) continue;
    error = worst(error, ulps(log(x), logl((long double)x)));
  }
  EXPECT_LE(error, 1.0);
  EXPECT_EQ(log(1.0), 0.0);
  EXPECT_EQ(log(0.0), -kInfinityD);
  EXPECT_EQ(log(kInfinityD), kInfinityD);
  EXPECT_TRUE(std::isnan(log(-1.0)));
  EXPECT_TRUE(std::isnan(log(kNaND)));
  EXPECT_LE(ulps(log(5.0e-324), logl((long double)5.0e-324)), 1.0);
}

// GCC 12's SLP vectoriser on x86 drops the rounding of neighbouring doubles to float and back, also at strict settings.
// Gyre is built with -fno-tree-slp-vectorize there; this test shows if the flag is missing.
__attribute__((noinline)) void through_float(double (&pair)[2]) {
  const float x = float(pair[0]), y = float(pair[1]);
  pair[0] = double(x);
  pair[1] = double(y);
}

TEST(Trig, CompilerRoundsToFloatWhereTheCodeSaysSo) {
  volatile double exact = 0.1;  // volatile: not computed at compile time
  double pair[2] = {exact, exact + 0.1};
  through_float(pair);
  EXPECT_EQ(pair[0], 0x1.99999ap-4);
  EXPECT_EQ(pair[1], 0x1.99999ap-3);
}

// One hash of many results: it changes when a compiler, platform or flag changes any bit of any of them.
TEST(Trig, TheSameBitsEverywhere) {
  Random random;
  std::uint64_t hash = 14695981039346656037u;
  const auto mix = [&hash](double value) {
    hash = (hash ^ __builtin_bit_cast(std::uint64_t, value)) * 1099511628211u;
    hash ^= hash >> 29;
  };
  for (int i = 0; i < 20000; ++i) {
    const double x = random.between(-100.0, 100.0), y = random.between(-100.0, 100.0);
    const SinCosD wide = sin_cos(x * y * y * y * y);
    const SinCos narrow = sin_cos(float(x));
    mix(wide.sin);
    mix(wide.cos);
    mix(double(narrow.sin));
    mix(double(narrow.cos));
    mix(atan2(y, x));
    mix(acos(0.01 * x));
    mix(exp(x));
    mix(log(absolute(y)));
  }
  EXPECT_EQ(hash, 10681177527986682695u);
}

}  // namespace
}  // namespace gyre::trig_test
