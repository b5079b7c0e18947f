#include "rigid/free_rotation.h"

#include "math/rotation.h"

namespace gyre {

namespace {

// Angle of one inner Runge-Kutta step, rad: its energy error is of order angle^5 / 120, 3e-11 here.
constexpr double kInnerAngle = 0.02;
// A spin beyond all sense costs accuracy, not time without end: momentum is kept whatever the steps.
constexpr double kMostInnerSteps = 4096.0;
// Below this angle a sub-step of the midpoint rule is as exact as float can hold.
constexpr float kTinyAngle = 2.0e-3f;
// An angular velocity this near to parallel with the momentum (relative) spins about a principal axis.
constexpr float kSteady = 1.0e-7f;

DVec3 times(const Sym3& m, DVec3 v) {
  return {double(m.xx) * v.x + double(m.xy) * v.y + double(m.xz) * v.z,
          double(m.xy) * v.x + double(m.yy) * v.y + double(m.yz) * v.z,
          double(m.xz) * v.x + double(m.yz) * v.y + double(m.zz) * v.z};
}

// Angular velocity in the body's frame of a body with world momentum `momentum`.
DVec3 body_velocity(const DQuat& q, DVec3 momentum, const Sym3& inverse_inertia) {
  return times(inverse_inertia, rotate_inverse(q, momentum));
}

DQuat derivative(const DQuat& q, DVec3 momentum, const Sym3& inverse_inertia) {
  const DVec3 w = body_velocity(q, momentum, inverse_inertia);
  const DQuat p = q * DQuat{w.x, w.y, w.z, 0.0};
  return {0.5 * p.x, 0.5 * p.y, 0.5 * p.z, 0.5 * p.w};
}

DQuat along(const DQuat& q, const DQuat& d, double h) {
  return {q.x + h * d.x, q.y + h * d.y, q.z + h * d.z, q.w + h * d.w};
}

// One Runge-Kutta step of the orientation with the momentum held fixed. Intermediate quaternions drift from length 1 by
// the order of the step only; the result is scaled back.
DQuat runge_kutta_4(const DQuat& q, DVec3 momentum, const Sym3& inverse_inertia, double h) {
  const DQuat k1 = derivative(q, momentum, inverse_inertia);
  const DQuat k2 = derivative(normalized(along(q, k1, 0.5 * h)), momentum, inverse_inertia);
  const DQuat k3 = derivative(normalized(along(q, k2, 0.5 * h)), momentum, inverse_inertia);
  const DQuat k4 = derivative(normalized(along(q, k3, h)), momentum, inverse_inertia);
  const double s = h / 6.0;
  return normalized(DQuat{q.x + s * (k1.x + 2.0 * (k2.x + k3.x) + k4.x), q.y + s * (k1.y + 2.0 * (k2.y + k3.y) + k4.y),
                          q.z + s * (k1.z + 2.0 * (k2.z + k3.z) + k4.z), q.w + s * (k1.w + 2.0 * (k2.w + k3.w) + k4.w)});
}

}  // namespace

Vec3 rotate_steadily(Quat& orientation, Vec3 angular_velocity, float seconds) {
  const Vec3 turn = seconds * angular_velocity;
  if (turn == Vec3{}) return {};
  orientation = integrate_rotation(orientation, turn);
  return turn;
}

Vec3 rotate_freely(Quat& orientation, Vec3& angular_velocity, const Sym3& inertia, const Sym3& inverse_inertia, float seconds) {
  const Vec3 w = rotate_inverse(orientation, angular_velocity);  // body frame
  const Vec3 momentum = inertia * w;                             // body frame
  const Vec3 torque = cross(momentum, w);
  if (length_squared(torque) <= square(kSteady) * length_squared(momentum) * length_squared(w)) {
    return rotate_steadily(orientation, angular_velocity, seconds);
  }
  const float angle = seconds * length(angular_velocity);
  if (angle < kTinyAngle) {
    const Vec3 world_momentum = rotate(orientation, momentum);
    const Vec3 middle = w + 0.5f * seconds * (inverse_inertia * torque);
    const Vec3 turn = seconds * rotate(orientation, middle);
    orientation = integrate_rotation(orientation, turn);
    angular_velocity = rotate(orientation, inverse_inertia * rotate_inverse(orientation, world_momentum));
    return turn;
  }
  const DQuat start = normalized(to_double(orientation));
  const DVec3 world_momentum = rotate(start, times(inertia, rotate_inverse(start, DVec3(angular_velocity))));
  const int steps = 1 + int(min(double(angle) / kInnerAngle, kMostInnerSteps));
  const double h = double(seconds) / double(steps);
  DQuat q = start;
  for (int i = 0; i < steps; ++i) q = runge_kutta_4(q, world_momentum, inverse_inertia, h);
  angular_velocity = to_float(rotate(q, body_velocity(q, world_momentum, inverse_inertia)));
  orientation = to_float(q);
  return to_float(logarithm_map(q * conjugate(start)));
}

}  // namespace gyre
