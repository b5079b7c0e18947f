// Torque-free rotation of rigid bodies, H side by side in double: the exact drift between two force steps.
//
// The angular momentum L in the world frame is constant, so the only unknown is the orientation: q' = 1/2 w q
// with w = R I^-1 R^T L. L is exact (to rounding) by construction and the energy to the order of the scheme,
// for any inertia tensor and any speed. Bodies that spin about a principal axis rotate by the exponential
// map, and bodies of revolution by two of them (the axis precesses about L, the body spins about its axis),
// which is exact.
//
// Method: Runge-Kutta 4 on the orientation with L fixed, in inner steps of at most kInnerAngle; one midpoint
// step (error of order angle^3) where the angle is so small that it is exact in float. Source of the idea: E.
// Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", VII.5; L as the variable: J. C. Simo, K.
// K. Wong, 1991.
#pragma once

#include "math/wide_double_vec.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Angle of one inner Runge-Kutta step, rad: its energy error is of order angle^5 / 120, 3e-11 here.
constexpr double kInnerAngle = 0.02;
// An absurd spin costs accuracy instead of unbounded time: momentum is conserved whatever the number of
// steps.
constexpr double kMaxInnerSteps = 4096.0;

// Symmetric tensors side by side.
template <int H>
struct TensorW {
  WideDouble<H> xx, yy, zz, xy, xz, yz;
};
template <int H>
GYRE_INLINE DVec3W<H> times(const TensorW<H>& m, DVec3W<H> v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}
template <int H>
GYRE_INLINE TensorW<H> inverse(const TensorW<H>& m) {
  const WideDouble<H> cxx = m.yy * m.zz - m.yz * m.yz;
  const WideDouble<H> cxy = m.xz * m.yz - m.xy * m.zz;
  const WideDouble<H> cxz = m.xy * m.yz - m.xz * m.yy;
  const WideDouble<H> s = 1.0 / (m.xx * cxx + m.xy * cxy + m.xz * cxz);
  return {s * cxx, s * (m.xx * m.zz - m.xz * m.xz), s * (m.xx * m.yy - m.xy * m.xy), s * cxy,
          s * cxz, s * (m.xy * m.xz - m.xx * m.yz)};
}

// Angular velocity in the body frame for the world momentum `momentum`.
template <int H>
GYRE_INLINE DVec3W<H> body_velocity(DQuatW<H> q, DVec3W<H> momentum, const TensorW<H>& inverse_inertia) {
  return times(inverse_inertia, rotate_inverse(q, momentum));
}

template <int H>
GYRE_INLINE DQuatW<H> derivative(DQuatW<H> q, DVec3W<H> momentum, const TensorW<H>& inverse_inertia) {
  const DVec3W<H> w = body_velocity(q, momentum, inverse_inertia);
  return WideDouble<H>(0.5) * (q * DQuatW<H>{w.x, w.y, w.z, WideDouble<H>(0.0)});
}

// One Runge-Kutta step of the orientation at fixed momentum. Intermediate quaternions leave length 1 only by
// the order of the step; the result is normalised.
template <int H>
GYRE_INLINE DQuatW<H> runge_kutta_4(DQuatW<H> q, DVec3W<H> momentum, const TensorW<H>& inverse_inertia,
                                    WideDouble<H> h) {
  const WideDouble<H> half(0.5), two(2.0);
  const DQuatW<H> k1 = derivative(q, momentum, inverse_inertia);
  const DQuatW<H> k2 = derivative(normalized(q + half * h * k1), momentum, inverse_inertia);
  const DQuatW<H> k3 = derivative(normalized(q + half * h * k2), momentum, inverse_inertia);
  const DQuatW<H> k4 = derivative(normalized(q + h * k3), momentum, inverse_inertia);
  return normalized(q + h / WideDouble<H>(6.0) * (k1 + two * (k2 + k3) + k4));
}

// The orientations after `seconds` at constant angular momentum (world frame, kg m^2/s); `angle`: rough angle
// of each rotation, rad.
template <int H>
GYRE_INLINE DQuatW<H> rotate_in_steps(DQuatW<H> q, DVec3W<H> momentum, const TensorW<H>& inverse_inertia,
                                      WideDouble<H> seconds, WideDouble<H> angle) {
  const WideDouble<H> steps = 1.0 + whole_part(min(angle / kInnerAngle, kMaxInnerSteps));
  const WideDouble<H> h = seconds / steps;
  WideDouble<H> done(0.0);
  do {
    const DQuatW<H> next = runge_kutta_4(q, momentum, inverse_inertia, h);
    q = select_above(steps, done, next, q);
    done += 1.0;
  } while (!all_at_most(steps, done));
  return q;
}

// Bodies of revolution: axis (body frame), and moments about it and across it.
template <int H>
struct SymmetricTopW {
  DVec3W<H> axis;
  WideDouble<H> along, across;
};
// With w = L / across + spin axis, the axis precesses steadily about L while the body rotates steadily about
// it: exact for any time.
template <int H>
GYRE_INLINE DQuatW<H> rotate_symmetric_top(DQuatW<H> start, DVec3W<H> momentum, const SymmetricTopW<H>& top,
                                           WideDouble<H> seconds) {
  const WideDouble<H> spin =
      dot(rotate_inverse(start, momentum), top.axis) * (1.0 / top.along - 1.0 / top.across);
  return normalized(exponential_map((seconds / top.across) * momentum) * start *
                    exponential_map((seconds * spin) * top.axis));
}

// A rotation so small that the velocity of its middle suffices. Velocity and momentum are in the body frame.
template <int H>
GYRE_INLINE DQuatW<H> rotate_by_midpoint(DQuatW<H> start, DVec3W<H> velocity, DVec3W<H> momentum,
                                         const TensorW<H>& inverse_inertia, WideDouble<H> seconds) {
  const DVec3W<H> middle = velocity + 0.5 * seconds * times(inverse_inertia, cross(momentum, velocity));
  return normalized(start * exponential_map(seconds * middle));
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
