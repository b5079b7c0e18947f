// Soft constraints: coefficients of a row from a frequency and a damping ratio. The row then behaves like an
// implicit spring and damper on the effective mass and is stable at any stiffness.
//
// Source: E. Catto, "Soft Constraints", GDC 2011, in the form that keeps the rigid effective mass.
#pragma once

#include <gyre/math.h>

namespace gyre {

struct Softness {
  float bias_rate = 0.0f;      // 1/s: bias per metre of error
  float mass_scale = 1.0f;     // share of the rigid impulse
  float impulse_scale = 0.0f;  // share of the accumulated impulse that the row yields
};

inline Softness make_softness(float frequency, float damping_ratio, float h) {
  if (frequency <= 0.0f) return {0.0f, 1.0f, 0.0f};
  const float omega = 2.0f * kPi * frequency;
  const float a1 = 2.0f * damping_ratio + h * omega;
  const float a2 = h * omega * a1;
  const float a3 = 1.0f / (1.0f + a2);
  return {omega / a1, a2 * a3, a3};
}

}  // namespace gyre
