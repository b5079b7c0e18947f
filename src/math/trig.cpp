// Sine, cosine, arc tangent, arc cosine, exponential and logarithm from IEEE operations alone; see trig.h for the
// errors and sources. Each function handles special values, reduces to a small argument, evaluates a Taylor polynomial
// and reassembles the result.
#include "math/trig.h"

#include "math/wide_double_angle.h"

#include <limits>

namespace gyre {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A number as the unrounded sum of two: 106 bits.
struct Sum {
  double high;
  double low;
};

// a + b without error (D. Knuth).
Sum exact_sum(double a, double b) {
  const double sum = a + b;
  const double b_rounded = sum - a;
  return {sum, (a - (sum - b_rounded)) + (b - b_rounded)};
}

// a * b without error (T. J. Dekker, with G. W. Veltkamp's split into 26 bits); for factors far from the range's ends.
Sum exact_product(double a, double b) {
  constexpr double kSplit = 0x1p27 + 1.0;
  const double a_scaled = kSplit * a, b_scaled = kSplit * b;
  const double a_high = a_scaled - (a_scaled - a), b_high = b_scaled - (b_scaled - b);
  const double a_low = a - a_high, b_low = b - b_high;
  const double product = a * b;
  return {product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

// 2^power for a power of a normal number.
double power_of_two(int power) { return __builtin_bit_cast(double, std::uint64_t(power + 1023) << 52); }

// -------------------------------------------------------------------------------------------- reduction by pi/2

// An angle as quadrant * pi/2 + rest, |rest| at most slightly above pi/4.
struct Reduced {
  Sum rest;
  unsigned quadrant;  // modulo 4
};

// The bits of 2/pi after the binary point, 32 to a word, the highest first.
constexpr std::uint32_t kTwoOverPi[] = {
    0xa2f9836eu, 0x4e441529u, 0xfc2757d1u, 0xf534ddc0u, 0xdb629599u, 0x3c439041u, 0xfe5163abu, 0xdebbc561u,
    0xb7246e3au, 0x424dd2e0u, 0x06492eeau, 0x09d1921cu, 0xfe1deb1cu, 0xb129a73eu, 0xe88235f5u, 0x2ebb4484u,
    0xe99c7026u, 0xb45f7e41u, 0x3991d639u, 0x835339f4u, 0x9c845f8bu, 0xbdf9283bu, 0x1ff897ffu, 0xde05980fu,
    0xef2f118bu, 0x5a0a6d1fu, 0x6d367ecfu, 0x27cb09b7u, 0x4f463f66u, 0x9e5fea2du, 0x7527bac7u, 0xebe5f17bu,
    0x3d0739f7u, 0x8a5292eau, 0x6bfb5fb1u, 0x1f8d5d08u, 0x56033046u, 0xfc7b6babu, 0xf0cfbc20u, 0x9af4361du};

// 32 bits of 2/pi from bit `first` on; the bits before the first are zero.
std::uint32_t bits_of_two_over_pi(int first) {
  if (first <= -32) return 0u;
  if (first < 0) return kTwoOverPi[0] >> -first;
  const int word = first / 32, shift = first % 32;
  if (shift == 0) return kTwoOverPi[word];
  return (kTwoOverPi[word] << shift) | (kTwoOverPi[word + 1] >> (32 - shift));
}

// Payne and Hanek: only x * 2/pi modulo 4 matters, so the bits of 2/pi that make multiples of 4 are left out and 192
// bits are multiplied as integers. `x` is finite and at least 1.
Reduced reduce_huge(double x) {
  constexpr int kWords = 6;
  const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, x);
  const int exponent = int(bits >> 52) - 1075;  // x = mantissa * 2^exponent
  const std::uint64_t mantissa = (bits & ((std::uint64_t(1) << 52) - 1)) | (std::uint64_t(1) << 52);

  // product = mantissa * window modulo 2^192, in words, the highest first; as a number of revolutions it lies in [0,
  // 1).
  std::uint32_t product[kWords];
  const std::uint64_t factor[2] = {mantissa & 0xffffffffu, mantissa >> 32};
  std::uint64_t carry = 0, previous = 0;
  for (int i = kWords - 1; i >= 0; --i) {
    const std::uint64_t word = bits_of_two_over_pi(exponent - 2 + 32 * i);
    // Split so that no sum exceeds 64 bits: two 32x32 products and a carry of at most 33 bits.
    const std::uint64_t low = factor[0] * word;
    const std::uint64_t high = factor[1] * previous;
    const std::uint64_t sum = (low & 0xffffffffu) + (high & 0xffffffffu) + (carry & 0xffffffffu);
    product[i] = std::uint32_t(sum);
    carry = (sum >> 32) + (low >> 32) + (high >> 32) + (carry >> 32);
    previous = word;
  }

  // The top two bits are the quadrant. The others become a fraction of a quadrant in [-1/2, 1/2).
  unsigned quadrant = product[0] >> 30;
  for (int i = 0; i < kWords; ++i)
    product[i] = (product[i] << 2) | (i + 1 < kWords ? product[i + 1] >> 30 : 0u);
  const bool negative = (product[0] >> 31) != 0;
  if (negative) {
    ++quadrant;
    std::uint64_t add = 1;
    for (int i = kWords - 1; i >= 0; --i) {
      add += std::uint64_t(~product[i]);
      product[i] = std::uint32_t(add);
      add >>= 32;
    }
  }
  Sum fraction{0.0, 0.0};
  double weight = negative ? -0x1p-32 : 0x1p-32;
  for (const std::uint32_t word : product) {
    const Sum sum = exact_sum(fraction.high, weight * double(word));
    fraction = exact_sum(sum.high, sum.low + fraction.low);
    weight *= 0x1p-32;
  }

  // Times pi/2 as a sum of two.
  const Sum rest = exact_product(fraction.high, 0x1.921fb54442d18p+0);
  const double low = rest.low + (fraction.high * 0x1.1a62633145c07p-54 + fraction.low * 0x1.921fb54442d18p+0);
  return {exact_sum(rest.high, low), quadrant & 3u};
}

// The integer nearest to `x` (any of the two at a tie), for |x| below 2^30.
int nearest(double x) { return int(x + (x < 0.0 ? -0.5 : 0.5)); }

Reduced reduce(double x) {
  if (!(absolute(x) <= 1.0e5)) {
    const Reduced reduced = reduce_huge(absolute(x));
    if (x > 0.0) return reduced;
    return {{-reduced.rest.high, -reduced.rest.low}, (4u - reduced.quadrant) & 3u};
  }
  // Cody and Waite: pi/2 as a sum of numbers of 33 bits, so that their products with an integer of 16 bits are exact.
  const int quadrant = nearest(x * 0x1.45f306dc9c883p-1);
  const double n = double(quadrant);
  const Sum first = exact_sum(x - n * 0x1.921fb54400000p+0, -(n * 0x1.0b4611a600000p-34));
  const Sum second = exact_sum(first.high, -(n * 0x1.3198a2e000000p-69));
  const double low = (first.low + second.low) - n * 0x1.b839a252049c1p-104;
  return {exact_sum(second.high, low), unsigned(quadrant) & 3u};
}

// Moves `sin` and `cos` of an angle's rest into its quadrant.
template <class Pair, class T>
Pair in_quadrant(T sin, T cos, unsigned quadrant) {
  switch (quadrant) {
    case 0:
      return {sin, cos};
    case 1:
      return {cos, -sin};
    case 2:
      return {-sin, -cos};
    default:
      return {-cos, sin};
  }
}

}  // namespace

SinCosD sin_cos(double radians) {
  const double x = radians;
  if (!is_finite(x)) return {x - x, x - x};
  if (absolute(x) < 0x1p-27) return {x, 1.0};
  const Reduced reduced = reduce(x);
  const double r = reduced.rest.high, low = reduced.rest.low;
  const double z = r * r;
  const double sine_tail =
      -1.0 / 6.0 +
      z * (1.0 / 120.0 +
           z * (-1.0 / 5040.0 +
                z * (1.0 / 362880.0 + z * (-1.0 / 39916800.0 +
                                           z * (1.0 / 6227020800.0 + z * (-1.0 / 1307674368000.0 +
                                                                          z * (1.0 / 355687428096000.0)))))));
  const double cosine_tail =
      1.0 / 24.0 +
      z * (-1.0 / 720.0 +
           z * (1.0 / 40320.0 +
                z * (-1.0 / 3628800.0 +
                     z * (1.0 / 479001600.0 + z * (-1.0 / 87178291200.0 + z * (1.0 / 20922789888000.0))))));
  const double sin = r + (r * z * sine_tail + low * (1.0 - 0.5 * z));
  const double half = 0.5 * z;
  const double head = 1.0 - half;  // its rounding error is added back
  const double cos = head + (((1.0 - head) - half) + (z * z * cosine_tail - r * low));
  return in_quadrant<SinCosD>(sin, cos, reduced.quadrant);
}

SinCos sin_cos(float radians) {
  const double x = double(radians);
  if (!(absolute(x) <= 1.0e9)) {
    const SinCosD wide = sin_cos(x);
    return {float(wide.sin), float(wide.cos)};
  }
  // pi/2 as a sum of numbers of 23, 23 and 53 bits: products with an integer below 2^30 are exact, except the last.
  const int quadrant = nearest(x * 0x1.45f306dc9c883p-1);
  const double n = double(quadrant);
  const double r = ((x - n * 0x1.921fb4p+0) - n * 0x1.4442dp-24) - n * 0x1.8469898cc5170p-48;
  const double z = r * r;
  const double sin =
      r * (1.0 + z * (-1.0 / 6.0 + z * (1.0 / 120.0 + z * (-1.0 / 5040.0 +
                                                           z * (1.0 / 362880.0 + z * (-1.0 / 39916800.0))))));
  const double cos =
      1.0 + z * (-0.5 + z * (1.0 / 24.0 +
                             z * (-1.0 / 720.0 +
                                  z * (1.0 / 40320.0 + z * (-1.0 / 3628800.0 + z * (1.0 / 479001600.0))))));
  return in_quadrant<SinCos>(float(sin), float(cos), unsigned(quadrant) & 3u);
}

// ---------------------------------------------------------------------------------------------------- arc functions

double atan2(double y, double x) {
  if (x != x || y != y) return kNaN;
  if (y == 0.0) return x < 0.0 ? kPiDouble : 0.0;
  double rise = absolute(y), run = absolute(x);
  if (rise == kInfinity && run == kInfinity) rise = run = 1.0;
  // Scaled away from the ends of the range, where the products below would overflow or lose bits.
  const double largest = max(rise, run);
  const double scale = largest > 0x1p900 ? 0x1p-100 : (largest < 0x1p-900 ? 0x1p100 : 1.0);
  rise *= scale;
  run *= scale;

  AngleSum<1> angle = angle_in_quadrant(WideDouble<1>(rise), WideDouble<1>(run));
  if (x < 0.0) angle = mirrored({0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53}, angle);
  const double result = (angle.head + angle.rest).v;
  return y < 0.0 ? -result : result;
}

float atan2(float y, float x) { return float(atan2(double(y), double(x))); }

double acos(double x) {
  if (x != x) return kNaN;
  if (x >= 1.0) return 0.0;
  if (x <= -1.0) return kPiDouble;
  return atan2(std::sqrt((1.0 - x) * (1.0 + x)), x);
}

float acos(float x) { return float(acos(double(x))); }

// --------------------------------------------------------------------------------------- exponential and logarithm

// ln 2 as a sum of two; the first has 32 bits, so its product with an exponent is exact.
constexpr Sum kLn2{0x1.62e42feep-1, 0x1.a39ef35793c76p-33};

double exp(double x) {
  if (x != x) return x;
  if (x > 709.8) return kInfinity;
  if (x < -745.2) return 0.0;
  const int power = nearest(x * 0x1.71547652b82fep+0);
  const double n = double(power);
  const Sum r = exact_sum(x - n * kLn2.high, -(n * kLn2.low));
  const double h = r.high;
  // Coefficients 1/2! ... 1/13!.
  const double tail =
      0.5 +
      h * (1.0 / 6.0 +
           h * (1.0 / 24.0 +
                h * (1.0 / 120.0 +
                     h * (1.0 / 720.0 +
                          h * (1.0 / 5040.0 +
                               h * (1.0 / 40320.0 +
                                    h * (1.0 / 362880.0 +
                                         h * (1.0 / 3628800.0 +
                                              h * (1.0 / 39916800.0 + h * (1.0 / 479001600.0 +
                                                                           h * (1.0 / 6227020800.0)))))))))));
  const double value = 1.0 + (h + (r.low + h * h * tail));
  // In two steps, so that neither the largest nor the denormal results pass through an infinity or a zero.
  const int half = power / 2;
  return value * power_of_two(half) * power_of_two(power - half);
}

double log(double x) {
  if (x != x || x == kInfinity) return x;
  if (x <= 0.0) return x == 0.0 ? -kInfinity : kNaN;
  int power = 0;
  if (x < 0x1p-1022) {
    x *= 0x1p54;
    power = -54;
  }
  // x = mantissa * 2^power, mantissa in [sqrt(1/2), sqrt(2)).
  const std::uint64_t bits = __builtin_bit_cast(std::uint64_t, x);
  power += int(bits >> 52) - 1023;
  double mantissa =
      __builtin_bit_cast(double, (bits & ((std::uint64_t(1) << 52) - 1)) | (std::uint64_t(1023) << 52));
  if (mantissa > 1.4142135623730951) {
    mantissa *= 0.5;
    ++power;
  }
  // ln(1 + f) = 2 artanh(s), s = f / (2 + f), arranged as f - f^2/2 + s (f^2/2 + R) so that the exact f leads.
  const double n = double(power);
  const double f = mantissa - 1.0;
  const double s = f / (2.0 + f);
  const double z = s * s;
  const double series =
      2.0 * z *
      (1.0 / 3.0 +
       z * (1.0 / 5.0 +
            z * (1.0 / 7.0 + z * (1.0 / 9.0 + z * (1.0 / 11.0 +
                                                   z * (1.0 / 13.0 +
                                                        z * (1.0 / 15.0 +
                                                             z * (1.0 / 17.0 +
                                                                  z * (1.0 / 19.0 + z * (1.0 / 21.0))))))))));
  const double half_square = 0.5 * f * f;
  const Sum head = exact_sum(n * kLn2.high, f);
  return head.high + (head.low + (n * kLn2.low + (s * (half_square + series) - half_square)));
}

}  // namespace gyre
