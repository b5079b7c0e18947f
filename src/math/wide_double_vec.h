// Vectors and quaternions of doubles side by side, for integrators of spinning bodies. Lane i has the bits of DVec3 and
// DQuat.
#pragma once

#include "math/rotation.h"
#include "math/wide_double_angle.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int H>
struct DVec3W {
  WideDouble<H> x, y, z;
};

template <int H>
GYRE_INLINE DVec3W<H> operator+(DVec3W<H> a, DVec3W<H> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <int H>
GYRE_INLINE DVec3W<H> operator*(WideDouble<H> s, DVec3W<H> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <int H>
GYRE_INLINE DVec3W<H> cross(DVec3W<H> a, DVec3W<H> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <int H>
GYRE_INLINE WideDouble<H> dot(DVec3W<H> a, DVec3W<H> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <int H>
struct DQuatW {
  WideDouble<H> x, y, z, w;
};

template <int H>
GYRE_INLINE DQuatW<H> operator+(DQuatW<H> a, DQuatW<H> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w};
}
template <int H>
GYRE_INLINE DQuatW<H> operator*(WideDouble<H> s, DQuatW<H> q) {
  return {s * q.x, s * q.y, s * q.z, s * q.w};
}
template <int H>
GYRE_INLINE DQuatW<H> operator*(DQuatW<H> a, DQuatW<H> b) {
  return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
          a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}
template <int H>
GYRE_INLINE DQuatW<H> conjugate(DQuatW<H> q) {
  return {-q.x, -q.y, -q.z, q.w};
}
template <int H>
GYRE_INLINE WideDouble<H> dot(DQuatW<H> a, DQuatW<H> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
}
// `a` where `number` is above `other`, `b` elsewhere.
template <int H>
GYRE_INLINE DQuatW<H> select_above(WideDouble<H> number, WideDouble<H> other, DQuatW<H> a, DQuatW<H> b) {
  return {select_above(number, other, a.x, b.x), select_above(number, other, a.y, b.y),
          select_above(number, other, a.z, b.z), select_above(number, other, a.w, b.w)};
}
// `q` scaled to length 1; no rotation where `q` is zero.
template <int H>
GYRE_INLINE DQuatW<H> normalized(DQuatW<H> q) {
  const WideDouble<H> zero(0.0), one(1.0);
  const WideDouble<H> square = dot(q, q), scale = one / sqrt(square);
  const auto scaled = [&](WideDouble<H> component, WideDouble<H> none) {
    return select_equal(square, zero, none, component * scale);
  };
  return {scaled(q.x, zero), scaled(q.y, zero), scaled(q.z, zero), scaled(q.w, one)};
}
template <int H>
GYRE_INLINE DVec3W<H> rotate(DQuatW<H> q, DVec3W<H> v) {
  const DVec3W<H> u{q.x, q.y, q.z};
  const DVec3W<H> t = WideDouble<H>(2.0) * cross(u, v);
  return v + q.w * t + cross(u, t);
}
template <int H>
GYRE_INLINE DVec3W<H> rotate_inverse(DQuatW<H> q, DVec3W<H> v) {
  return rotate(conjugate(q), v);
}

// exponential_map and logarithm_map one lane at a time, for rare cases.
template <int H>
__attribute__((noinline)) void exponential_map_by_lanes(const DVec3W<H>& v, DQuatW<H>& q) {
  GYRE_ROLLED
  for (int i = 0; i < H; ++i) {
    const DQuat one = exponential_map(DVec3{v.x[i], v.y[i], v.z[i]});
    q.x.set(i, one.x), q.y.set(i, one.y), q.z.set(i, one.z), q.w.set(i, one.w);
  }
}
template <int H>
__attribute__((noinline)) void logarithm_map_by_lanes(const DQuatW<H>& q, DVec3W<H>& v) {
  GYRE_ROLLED
  for (int i = 0; i < H; ++i) {
    const DVec3 one = logarithm_map(DQuat{q.x[i], q.y[i], q.z[i], q.w[i]});
    v.x.set(i, one.x), v.y.set(i, one.y), v.z.set(i, one.z);
  }
}

// As exponential_map of math/rotation.h: side by side if no lane rotates by more than a radian.
template <int H>
GYRE_INLINE DQuatW<H> exponential_map(DVec3W<H> v) {
  DQuatW<H> q;
  const WideDouble<H> square = 0.25 * dot(v, v);
  if (H > 1 && all_at_most(square, kMaxHalfAngleSquare)) {
    const HalfAngle<H> half = half_angle_of(square);
    const WideDouble<H> s = 0.5 * half.sine_over_angle;
    q = {s * v.x, s * v.y, s * v.z, half.cosine};
  } else {
    exponential_map_by_lanes(v, q);
  }
  return q;
}
// As logarithm_map of math/rotation.h: side by side if every lane rotates and none is a special case.
template <int H>
GYRE_INLINE DVec3W<H> logarithm_map(DQuatW<H> q) {
  DVec3W<H> v{q.x, q.y, q.z};
  const WideDouble<H> sine = sqrt(dot(v, v));
  const WideDouble<H> sign = select_above(WideDouble<H>(0.0), q.w, WideDouble<H>(-1.0), WideDouble<H>(1.0));
  const WideDouble<H> w = sign * q.w;
  if (H > 1 && all_at_most(WideDouble<H>(1.0e-9), sine) && all_at_most(1.0e-9 * w, sine) &&
      all_at_most(sine, 2.0) && all_at_most(w, 2.0)) {
    const AngleSum<H> angle = angle_in_quadrant(sine, w);
    v = (sign * 2.0 * (angle.head + angle.rest) / sine) * v;
  } else {
    logarithm_map_by_lanes(q, v);
  }
  return v;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
