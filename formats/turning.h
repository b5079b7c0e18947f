// Sines and cosines for pictures, by the engine's own trigonometry: the same on every machine.
#pragma once

#include <gyre/math.h>

namespace gyre {

constexpr float kHalfTurn = 3.14159265358979f;  // rad

struct Turn {
  float cosine, sine;
};
inline Turn turn_of(float radians) {
  const SinCos both = sin_cos(radians);
  return {both.cos, both.sin};
}
inline float tangent(float radians) {
  const SinCos both = sin_cos(radians);
  return both.sin / both.cos;
}

}  // namespace gyre
