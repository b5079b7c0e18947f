// Conversions between quaternions, matrices, axes, rotation vectors and Euler angles. All are computed in double and
// rounded once: they are outside of inner loops, and in double neither lengths near the ends of a float's range nor
// angles near 0 or pi need care. NaN in, NaN out.
#include "math/rotation.h"

#include "math/trig.h"
#include "math/wide_double_angle.h"

namespace gyre {
namespace {

double element(DVec3 v, int axis) { return v[axis]; }

DQuat from_vector_and_scalar(const double (&v)[3], double w) { return {v[0], v[1], v[2], w}; }

// The first, second and third axis of an order; +1 if they are right-handed, -1 if left-handed.
struct EulerAxes {
  int axis[3];
  double handedness;
};

EulerAxes axes_of(EulerOrder order) {
  switch (order) {
    case EulerOrder::xyz:
      return {{0, 1, 2}, 1.0};
    case EulerOrder::xzy:
      return {{0, 2, 1}, -1.0};
    case EulerOrder::yxz:
      return {{1, 0, 2}, -1.0};
    case EulerOrder::yzx:
      return {{1, 2, 0}, 1.0};
    case EulerOrder::zxy:
      return {{2, 0, 1}, 1.0};
    case EulerOrder::zyx:
      return {{2, 1, 0}, -1.0};
  }
  return {{0, 1, 2}, 1.0};
}

DQuat about_axis(int axis, float angle) {
  const SinCosD half = sin_cos(0.5 * double(angle));
  double v[3] = {0.0, 0.0, 0.0};
  v[axis] = half.sin;
  return from_vector_and_scalar(v, half.cos);
}

// A vector at a right angle to `a`, which must not be zero.
DVec3 perpendicular(DVec3 a) {
  const double x = absolute(a.x), y = absolute(a.y), z = absolute(a.z);
  if (x <= y && x <= z) return cross(a, {1.0, 0.0, 0.0});
  return y <= z ? cross(a, {0.0, 1.0, 0.0}) : cross(a, {0.0, 0.0, 1.0});
}

double wrap_to_pi(double angle) {
  if (angle > kPiDouble) return angle - 2.0 * kPiDouble;
  if (angle <= -kPiDouble) return angle + 2.0 * kPiDouble;
  return angle;
}

}  // namespace

// -------------------------------------------------------------------------------------------- exponential, logarithm

DQuat exponential_map(DVec3 v) {
  const double square = 0.25 * length_squared(v);  // of the half angle
  if (square <= kMaxHalfAngleSquare) {
    const HalfAngle<1> half = half_angle_of(WideDouble<1>(square));
    const double s = 0.5 * half.sine_over_angle.v;
    return {s * v.x, s * v.y, s * v.z, half.cosine.v};
  }
  const double half_angle = std::sqrt(square);
  const SinCosD half = sin_cos(half_angle);
  const double s = 0.5 * half.sin / half_angle;
  return {s * v.x, s * v.y, s * v.z, half.cos};
}

DVec3 logarithm_map(DQuat q) {
  const DVec3 u{q.x, q.y, q.z};
  const double sine = length(u);
  // Both q and -q are this rotation; takes the one that rotates by at most pi.
  const double sign = q.w < 0.0 ? -1.0 : 1.0;
  const double w = sign * q.w;
  // Below this, angle/sin is 2/w to the last bit.
  if (sine < 1.0e-9 * w) return (2.0 * sign / w) * u;
  if (sine == 0.0) return u;  // the zero quaternion
  return (sign * 2.0 * atan2(sine, w) / sine) * u;
}

Quat from_rotation_vector(Vec3 v) { return to_float(exponential_map(DVec3(v))); }

Vec3 to_rotation_vector(Quat q) { return to_float(logarithm_map(to_double(q))); }

Quat from_axis_angle(Vec3 axis, float angle) {
  const DVec3 a{axis};
  const double square = length_squared(a);  // of floats: in double it neither overflows nor vanishes
  if (square == 0.0) return {};
  const SinCosD half = sin_cos(0.5 * double(angle));
  const double s = half.sin / std::sqrt(square);
  return to_float(DQuat{s * a.x, s * a.y, s * a.z, half.cos});
}

Quat integrate_rotation(Quat orientation, Vec3 rotation) {
  return to_float(normalized(exponential_map(DVec3(rotation)) * to_double(orientation)));
}

Vec3 rotation_between(Quat from, Quat to) {
  return to_float(logarithm_map(to_double(to) * conjugate(to_double(from))));
}

// --------------------------------------------------------------------------------------------- matrices, directions

// Shepperd: the largest of |x|, |y|, |z|, |w| comes from the diagonal, the others from sums and differences divided by
// it, so that no divisor is small.
Quat from_matrix(const Mat3& m) {
  const double xx = double(m.x.x), yy = double(m.y.y), zz = double(m.z.z);
  const double xy = double(m.x.y) + double(m.y.x), xz = double(m.x.z) + double(m.z.x),
               yz = double(m.y.z) + double(m.z.y);
  const double wx = double(m.y.z) - double(m.z.y), wy = double(m.z.x) - double(m.x.z),
               wz = double(m.x.y) - double(m.y.x);
  const double trace = xx + yy + zz;
  DQuat q;
  if (trace >= xx && trace >= yy && trace >= zz) {
    q = {wx, wy, wz, 1.0 + trace};
  } else if (xx >= yy && xx >= zz) {
    q = {1.0 + xx - yy - zz, xy, xz, wx};
  } else if (yy >= zz) {
    q = {xy, 1.0 + yy - xx - zz, yz, wy};
  } else {
    q = {xz, yz, 1.0 + zz - xx - yy, wz};
  }
  return to_float(normalized(q));
}

// (a x b, |a||b| + a.b) points along the rotation by half the angle. For opposite directions it is undefined, and any
// axis at a right angle rotates by pi.
Quat from_directions(Vec3 from, Vec3 to) {
  const DVec3 a{from}, b{to};
  const double scale = std::sqrt(length_squared(a) * length_squared(b));
  if (scale == 0.0) return {};
  const DVec3 axis = cross(a, b);
  const DQuat q{axis.x, axis.y, axis.z, scale + dot(a, b)};
  if (dot(q, q) <= square(1.0e-14 * scale)) {
    const DVec3 other = perpendicular(a);
    return to_float(normalized(DQuat{other.x, other.y, other.z, 0.0}));
  }
  return to_float(normalized(q));
}

// Shoemake. The angle between the two comes from their sum and difference, which keeps its digits at both ends.
Quat slerp(Quat a, Quat b, float t) {
  const DQuat p = to_double(a);
  DQuat q = to_double(b);
  if (dot(p, q) < 0.0) q = {-q.x, -q.y, -q.z, -q.w};
  const DQuat sum{p.x + q.x, p.y + q.y, p.z + q.z, p.w + q.w};
  const DQuat gap{q.x - p.x, q.y - p.y, q.z - p.z, q.w - p.w};
  const double angle = 2.0 * atan2(std::sqrt(dot(gap, gap)), std::sqrt(dot(sum, sum)));
  const double s = double(t);
  double weight_p = 1.0 - s, weight_q = s;
  if (angle > 1.0e-8) {
    const double sine = sin_cos(angle).sin;
    weight_p = sin_cos(weight_p * angle).sin / sine;
    weight_q = sin_cos(weight_q * angle).sin / sine;
  }
  return to_float(DQuat{weight_p * p.x + weight_q * q.x, weight_p * p.y + weight_q * q.y,
                        weight_p * p.z + weight_q * q.z, weight_p * p.w + weight_q * q.w});
}

// ------------------------------------------------------------------------------------------------------ Euler angles

Quat from_euler(EulerAngles angles) {
  const EulerAxes axes = axes_of(angles.order);
  return to_float(about_axis(axes.axis[0], angles.first) * about_axis(axes.axis[1], angles.second) *
                  about_axis(axes.axis[2], angles.third));
}

// With half angles a, b, c the product of the three rotations (right-handed axes i, j, k) satisfies
//   w + j = (cos b + sin b) cos(a + c),   i + k = (cos b + sin b) sin(a + c),
//   w - j = (cos b - sin b) cos(a - c),   i - k = (cos b - sin b) sin(a - c),
// so the sum, the difference and b come from three arc tangents, exact up to gimbal lock, where one pair vanishes. A
// left-handed triple is a right-handed one with the middle axis reversed.
EulerAngles to_euler(Quat q, EulerOrder order) {
  const EulerAxes axes = axes_of(order);
  const DVec3 v{double(q.x), double(q.y), double(q.z)};
  const double w = double(q.w);
  const double i = element(v, axes.axis[0]);
  const double j = axes.handedness * element(v, axes.axis[1]);
  const double k = element(v, axes.axis[2]);

  const double plus_cos = w + j, plus_sin = i + k, minus_cos = w - j, minus_sin = i - k;
  const double plus = std::sqrt(plus_cos * plus_cos + plus_sin * plus_sin);
  const double minus = std::sqrt(minus_cos * minus_cos + minus_sin * minus_sin);
  const double second = axes.handedness * (2.0 * atan2(plus, minus) - 0.5 * kPiDouble);

  // If a pair is only rounding, a float quaternion does not determine the two outer angles.
  constexpr double kLocked = 1.0e-6;
  double first = 0.0, third = 0.0;
  if (minus <= kLocked * plus) {
    first = wrap_to_pi(2.0 * atan2(plus_sin, plus_cos));
  } else if (plus <= kLocked * minus) {
    first = wrap_to_pi(2.0 * atan2(minus_sin, minus_cos));
  } else {
    const double sum = atan2(plus_sin, plus_cos), difference = atan2(minus_sin, minus_cos);
    first = wrap_to_pi(sum + difference);
    third = wrap_to_pi(sum - difference);
  }
  return {.first = float(first), .second = float(second), .third = float(third), .order = order};
}

// ---------------------------------------------------------------------------------------------------- model matrices

Mat4 model_matrix(const Pose& pose, DVec3 origin, Vec3 scale) {
  const Mat3 r = to_matrix(pose.orientation);
  const Vec3 x = scale.x * r.x, y = scale.y * r.y, z = scale.z * r.z;
  const Vec3 p = difference(pose.position, origin);
  return {{x.x, x.y, x.z, 0.0f, y.x, y.y, y.z, 0.0f, z.x, z.y, z.z, 0.0f, p.x, p.y, p.z, 1.0f}};
}

}  // namespace gyre
