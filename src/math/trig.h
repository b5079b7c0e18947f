// Trigonometry, exponential and logarithm with the same bits for every compiler, C library and CPU: computed with IEEE
// + - * / and sqrt only, never fused, never through the C library. The float functions are declared in <gyre/math.h>.
//
// Largest error found by the dense tests against 80-bit arithmetic, in units in the last place (ulp) of the result:
//   float  sin_cos, atan2, acos     0.501 (they are computed in double and rounded once), for every finite argument
//   double sin_cos                  1.0, for every finite argument
//   double atan2, acos              2.0
//   double exp, log                 1.0
// NaN gives NaN; the sine and cosine of an infinity are NaN.
//
// Sources: W. J. Cody and W. Waite, "Software Manual for the Elementary Functions" (1980), argument reduction by a
// constant in several pieces; M. Payne and R. Hanek, "Radian reduction for trigonometric functions" (1983), reduction
// of huge arguments; T. J. Dekker, "A floating-point technique for extending the available precision" (1971). The
// polynomials are Taylor series, cut where the remainder is below a tenth of an ulp.
#pragma once

#include <gyre/math.h>

namespace gyre {

struct SinCosD {
  double sin;
  double cos;
};

SinCosD sin_cos(double radians);
// The angle of the point (x, y) in [-pi, pi]. A zero y counts as +0 (so the negative x axis is at +pi); (0, 0) gives 0.
double atan2(double y, double x);
// The angle in [0, pi] whose cosine is `x`, clamped to [-1, 1].
double acos(double x);
// e to the power `x`: 0 far below, infinity far above.
double exp(double x);
// The natural logarithm: -infinity for 0, NaN below.
double log(double x);

}  // namespace gyre
