// Angles of W vectors in the plane and of W rotations, in float: the wide twins of atan2 in math/trig.h and of
// to_rotation_vector in math/rotation.h, with fewer digits.
#pragma once

#include "math/wide_vec.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

constexpr float kWidePi = 3.14159265f;

// The angle of (x, y) in (-pi, pi], within 3e-7; 0 for the zero vector. Folded to |t| <= tan(pi / 8), then Taylor's
// series.
template <int W>
GYRE_INLINE Wide<W> atan2(Wide<W> y, Wide<W> x) {
  const Wide<W> ax = absolute(x), ay = absolute(y);
  const Wide<W> low = min(ax, ay), high = max(ax, ay);
  const Mask<W> folded = low > 0.41421356f * high;  // atan(t) = pi / 4 + atan((t - 1) / (t + 1))
  const Wide<W> above = select(folded, low - high, low), below = select(folded, low + high, high);
  const Wide<W> t = keep(high > 0.0f, above / below);
  const Wide<W> z = t * t;
  const Wide<W> tail =
      -1.0f / 11.0f + z * (1.0f / 13.0f + z * (-1.0f / 15.0f + z * (1.0f / 17.0f + z * (-1.0f / 19.0f))));
  const Wide<W> series = -1.0f / 3.0f + z * (1.0f / 5.0f + z * (-1.0f / 7.0f + z * (1.0f / 9.0f + z * tail)));
  Wide<W> angle = keep(folded, Wide<W>(0.25f * kWidePi)) + (t + t * (z * series));
  angle = select(ay > ax, 0.5f * kWidePi - angle, angle);
  angle = select(x < 0.0f, kWidePi - angle, angle);
  return copy_sign(angle, y);
}

// The angle plus the multiple of 2 pi that brings it nearest to `near`.
template <int W>
GYRE_INLINE Wide<W> unwrapped(Wide<W> angle, Wide<W> near) {
  // Adding 1.5 * 2^23 rounds to the nearest integer.
  const Wide<W> turns = ((near - angle) * (0.5f / kWidePi) + 12582912.0f) - 12582912.0f;
  return angle + (2.0f * kWidePi) * turns;
}

// The rotation vector (axis times angle, at most pi) of a unit quaternion.
template <int W>
GYRE_INLINE Vec3W<W> to_rotation_vector(QuatW<W> q) {
  const Vec3W<W> v{q.x, q.y, q.z};
  const Wide<W> sine = length(v);
  const Mask<W> rotates = sine > 1.0e-18f;
  const Wide<W> share = select(rotates, 2.0f * atan2(sine, absolute(q.w)) / sine, Wide<W>(2.0f));
  return copy_sign(share, q.w) * v;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
