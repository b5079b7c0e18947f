#include "rigid/free_rotation.h"

#include "math/rotation.h"

namespace gyre {

namespace {

// Angle of one inner Runge-Kutta step, rad: its energy error is of order angle^5 / 120, 3e-11 here.
constexpr double kInnerAngle = 0.02;
// A spin beyond all sense costs accuracy, not time without end: momentum is kept whatever the steps.
constexpr double kMostInnerSteps = 4096.0;
// Below this angle nothing but the steady part of the turn reaches a float.
constexpr float kNoAngle = 1.0e-6f;
// Below this angle a sub-step of the midpoint rule is as exact as float can hold.
constexpr float kTinyAngle = 2.0e-3f;
// Two principal moments this near to each other (relative) are one: shapes of revolution have theirs rounded.
constexpr float kEqual = 1.0e-6f;
// An angular velocity this near to parallel with the momentum (relative) spins about a principal axis.
constexpr float kSteady = 1.0e-7f;

// Angular velocity in the body's frame of a body with world momentum `momentum`.
DVec3 body_velocity(const DQuat& q, DVec3 momentum, const Tensor& inverse_inertia) {
  return times(inverse_inertia, rotate_inverse(q, momentum));
}

DQuat derivative(const DQuat& q, DVec3 momentum, const Tensor& inverse_inertia) {
  const DVec3 w = body_velocity(q, momentum, inverse_inertia);
  const DQuat p = q * DQuat{w.x, w.y, w.z, 0.0};
  return {0.5 * p.x, 0.5 * p.y, 0.5 * p.z, 0.5 * p.w};
}

DQuat along(const DQuat& q, const DQuat& d, double h) {
  return {q.x + h * d.x, q.y + h * d.y, q.z + h * d.z, q.w + h * d.w};
}

// One Runge-Kutta step of the orientation with the momentum held fixed. Intermediate quaternions drift from length 1 by
// the order of the step only; the result is scaled back.
DQuat runge_kutta_4(const DQuat& q, DVec3 momentum, const Tensor& inverse_inertia, double h) {
  const DQuat k1 = derivative(q, momentum, inverse_inertia);
  const DQuat k2 = derivative(normalized(along(q, k1, 0.5 * h)), momentum, inverse_inertia);
  const DQuat k3 = derivative(normalized(along(q, k2, 0.5 * h)), momentum, inverse_inertia);
  const DQuat k4 = derivative(normalized(along(q, k3, h)), momentum, inverse_inertia);
  const double s = h / 6.0;
  return normalized(
      DQuat{q.x + s * (k1.x + 2.0 * (k2.x + k3.x) + k4.x), q.y + s * (k1.y + 2.0 * (k2.y + k3.y) + k4.y),
            q.z + s * (k1.z + 2.0 * (k2.z + k3.z) + k4.z), q.w + s * (k1.w + 2.0 * (k2.w + k3.w) + k4.w)});
}

// A body of revolution: its axis (body frame), and its moments about that axis and across it.
struct Top {
  DVec3 axis;
  double along = 0.0, across = 0.0;
};

bool find_top(const Sym3& inertia, Top& top) {
  if (inertia.xy != 0.0f || inertia.xz != 0.0f || inertia.yz != 0.0f) return false;
  const float moments[3] = {inertia.xx, inertia.yy, inertia.zz};
  for (int k = 0; k < 3; ++k) {
    const float a = moments[(k + 1) % 3], b = moments[(k + 2) % 3];
    if (!(std::abs(a - b) <= kEqual * a)) continue;
    top = {{k == 0 ? 1.0 : 0.0, k == 1 ? 1.0 : 0.0, k == 2 ? 1.0 : 0.0},
           double(moments[k]),
           0.5 * (double(a) + double(b))};
    return true;
  }
  return false;
}

// With w = L / across + spin axis, the axis goes round L steadily while the body turns about it steadily: exact for any time.
DQuat turn_top(const DQuat& start, DVec3 momentum, const Top& top, double seconds) {
  const double spin = dot(rotate_inverse(start, momentum), top.axis) * (1.0 / top.along - 1.0 / top.across);
  return normalized(exponential_map((seconds / top.across) * momentum) * start *
                    exponential_map((seconds * spin) * top.axis));
}

}  // namespace

Tensor to_double(const Sym3& m) {
  return {double(m.xx), double(m.yy), double(m.zz), double(m.xy), double(m.xz), double(m.yz)};
}

Tensor inverse(const Tensor& m) {
  const double cxx = m.yy * m.zz - m.yz * m.yz;
  const double cxy = m.xz * m.yz - m.xy * m.zz;
  const double cxz = m.xy * m.yz - m.xz * m.yy;
  const double s = 1.0 / (m.xx * cxx + m.xy * cxy + m.xz * cxz);
  return {s * cxx, s * (m.xx * m.zz - m.xz * m.xz), s * (m.xx * m.yy - m.xy * m.xy), s * cxy,
          s * cxz, s * (m.xy * m.xz - m.xx * m.yz)};
}

DQuat turn_at_momentum(DQuat start, DVec3 momentum, const Tensor& inverse_inertia, double seconds,
                       double angle) {
  const int steps = 1 + int(min(angle / kInnerAngle, kMostInnerSteps));
  const double h = seconds / double(steps);
  DQuat q = start;
  for (int i = 0; i < steps; ++i) q = runge_kutta_4(q, momentum, inverse_inertia, h);
  return q;
}

Vec3 rotate_steadily(Quat& orientation, Vec3 angular_velocity, float seconds) {
  const Vec3 turn = seconds * angular_velocity;
  if (turn == Vec3{}) return {};
  orientation = integrate_rotation(orientation, turn);
  return turn;
}

Vec3 rotate_freely(Quat& orientation, Vec3& angular_velocity, const Sym3& inertia, float seconds) {
  const Vec3 w = rotate_inverse(orientation, angular_velocity);  // body frame
  const Vec3 momentum = inertia * w;                             // body frame
  const Vec3 torque = cross(momentum, w);
  const float angle = seconds * length(angular_velocity);
  if (angle < kNoAngle ||
      length_squared(torque) <= square(kSteady) * length_squared(momentum) * length_squared(w)) {
    return rotate_steadily(orientation, angular_velocity, seconds);
  }
  const Tensor tensor = to_double(inertia);
  const Tensor inverse_tensor = inverse(tensor);
  const DQuat start = normalized(to_double(orientation));
  const DVec3 start_velocity = rotate_inverse(start, DVec3(angular_velocity));
  const DVec3 start_momentum = times(tensor, start_velocity);
  const DVec3 world_momentum = rotate(start, start_momentum);
  DQuat q = start;
  Top top;
  if (find_top(inertia, top)) {
    q = turn_top(start, world_momentum, top, double(seconds));
  } else if (angle < kTinyAngle) {
    const DVec3 middle =
        start_velocity + 0.5 * double(seconds) * times(inverse_tensor, cross(start_momentum, start_velocity));
    q = normalized(start * exponential_map(double(seconds) * middle));
  } else {
    q = turn_at_momentum(start, world_momentum, inverse_tensor, double(seconds), double(angle));
  }
  angular_velocity = to_float(rotate(q, body_velocity(q, world_momentum, inverse_tensor)));
  orientation = to_float(q);
  return to_float(logarithm_map(q * conjugate(start)));
}

}  // namespace gyre
