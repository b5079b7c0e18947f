// Series of angles in double, H side by side: the kernels of exponential_map (math/rotation.h) and atan2 (math/trig.h),
// which use them with one lane. Lane i has the bits of one lane.
#pragma once

#include "math/wide_double.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// sin(a) / a and cos(a) by their series in a^2, for a <= 1/2: no division, no root, nothing special at zero.
constexpr double kMaxHalfAngleSquare = 0.25;
template <int H>
struct HalfAngle {
  WideDouble<H> sine_over_angle, cosine;
};
template <int H>
GYRE_INLINE HalfAngle<H> half_angle_of(WideDouble<H> square) {
  const WideDouble<H> z = square;
  return {1.0 + z * (-1.0 / 6.0 +
                     z * (1.0 / 120.0 +
                          z * (-1.0 / 5040.0 +
                               z * (1.0 / 362880.0 + z * (-1.0 / 39916800.0 + z * (1.0 / 6227020800.0)))))),
          1.0 + z * (-0.5 + z * (1.0 / 24.0 +
                                 z * (-1.0 / 720.0 + z * (1.0 / 40320.0 + z * (-1.0 / 3628800.0 +
                                                                               z * (1.0 / 479001600.0))))))};
}

// An angle as an unrounded sum.
template <int H>
struct AngleSum {
  WideDouble<H> head, rest;
};
// a + b without error (D. Knuth).
template <int H>
GYRE_INLINE AngleSum<H> exact_sum(WideDouble<H> a, WideDouble<H> b) {
  const WideDouble<H> sum = a + b;
  const WideDouble<H> b_rounded = sum - a;
  return {sum, (a - (sum - b_rounded)) + (b - b_rounded)};
}
// `whole` - `angle` as an unrounded sum, for angles beyond pi/2 or pi.
template <int H>
GYRE_INLINE AngleSum<H> mirrored(AngleSum<1> whole, AngleSum<H> angle) {
  const AngleSum<H> reflected = exact_sum(WideDouble<H>(whole.head.v), -angle.head);
  return {reflected.head, reflected.rest + (WideDouble<H>(whole.rest.v) - angle.rest)};
}
// The angle of (run, rise); neither is negative, and both are away from the ends of the range.
template <int H>
GYRE_INLINE AngleSum<H> angle_in_quadrant(WideDouble<H> rise, WideDouble<H> run) {
  // atan(t) = atan(c) + atan((t - c) / (1 + t c)) with c the nearest of 0, 1/8, ... 1; the argument of the second term
  // is at most 1/16.
  constexpr double kHead[9] = {0.0,
                               0x1.fd5ba9aac2f6ep-4,
                               0x1.f5b75f92c80ddp-3,
                               0x1.6f61941e4def1p-2,
                               0x1.dac670561bb4fp-2,
                               0x1.1e00babdefeb4p-1,
                               0x1.4978fa3269ee1p-1,
                               0x1.700a7c5784634p-1,
                               0x1.921fb54442d18p-1};
  constexpr double kRest[9] = {0.0,
                               -0x1.cd37686760c17p-59,
                               0x1.8ab6e3cf7afbdp-57,
                               -0x1.c63aae6f6e918p-56,
                               0x1.a2b7f222f65e2p-56,
                               -0x1.928df287a668fp-58,
                               0x1.2419a87f2a458p-56,
                               -0x1.8c34d25aadef6p-56,
                               0x1.1a62633145c07p-55};
  const WideDouble<H> high = max(rise, run), low = min(rise, run);
  const WideDouble<H> t = low / high;
  const WideDouble<H> eighth = whole_part(8.0 * t + 0.5);
  WideDouble<H> u = t;
  AngleSum<H> base{0.0, 0.0};
  if (!all_at_most(eighth, 0.0)) {
    const WideDouble<H> c = 0.125 * eighth;
    u = (low - c * high) / (high + c * low);  // where c is 0, this is t
    GYRE_UNROLL
    for (int i = 0; i < H; ++i) {
      const int index = int(eighth[i]);
      base.head.set(i, kHead[index]), base.rest.set(i, kRest[index]);
    }
  }
  const WideDouble<H> z = u * u;
  const WideDouble<H> tail =
      -1.0 / 3.0 +
      z * (1.0 / 5.0 + z * (-1.0 / 7.0 + z * (1.0 / 9.0 + z * (-1.0 / 11.0 + z * (1.0 / 13.0)))));
  const AngleSum<H> sum = exact_sum(base.head, u);
  const AngleSum<H> angle{sum.head, sum.rest + (base.rest + u * z * tail)};
  // Mirrored out of the first eighth of the circle.
  const AngleSum<H> other = mirrored({0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54}, angle);
  return {select_above(rise, run, other.head, angle.head), select_above(rise, run, other.rest, angle.rest)};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
