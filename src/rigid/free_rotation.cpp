#include "rigid/free_rotation.h"

#include "math/rotation.h"
#include "math/wide_double_vec.h"

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

// Tensors side by side.
template <int H>
struct TensorW {
  WideDouble<H> xx, yy, zz, xy, xz, yz;
};
template <int H>
GYRE_INLINE DVec3W<H> times(const TensorW<H>& m, DVec3W<H> v) {
  return {m.xx * v.x + m.xy * v.y + m.xz * v.z, m.xy * v.x + m.yy * v.y + m.yz * v.z,
          m.xz * v.x + m.yz * v.y + m.zz * v.z};
}

// Angular velocity in the body's frame of a body with world momentum `momentum`.
template <int H>
GYRE_INLINE DVec3W<H> body_velocity(DQuatW<H> q, DVec3W<H> momentum, const TensorW<H>& inverse_inertia) {
  return times(inverse_inertia, rotate_inverse(q, momentum));
}

template <int H>
GYRE_INLINE DQuatW<H> derivative(DQuatW<H> q, DVec3W<H> momentum, const TensorW<H>& inverse_inertia) {
  const DVec3W<H> w = body_velocity(q, momentum, inverse_inertia);
  return WideDouble<H>(0.5) * (q * DQuatW<H>{w.x, w.y, w.z, WideDouble<H>(0.0)});
}

// One Runge-Kutta step of the orientation with the momentum held fixed. Intermediate quaternions drift from length 1 by
// the order of the step only; the result is scaled back.
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

// Inner steps of a turn by `angle`.
double count_steps(double angle) { return double(1 + int(min(angle / kInnerAngle, kMostInnerSteps))); }

// The orientations after `seconds` at constant angular momentum, in each lane's number of steps.
template <int H>
GYRE_INLINE DQuatW<H> turn_in_steps(DQuatW<H> q, DVec3W<H> momentum, const TensorW<H>& inverse_inertia,
                                    WideDouble<H> seconds, WideDouble<H> steps, double most_steps) {
  const WideDouble<H> h = seconds / steps;
  for (double i = 0.0; i < most_steps; i += 1.0) {
    const DQuatW<H> next = runge_kutta_4(q, momentum, inverse_inertia, h);
    q = select_above(steps, WideDouble<H>(i), next, q);
  }
  return q;
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

// Of those that turn in no steps: bodies of revolution, and turns so small that the velocity of their middle tells.
struct BodyState {
  DVec3 velocity, momentum;  // in the body's frame
};
DQuat turn_at_once(const DQuat& start, const BodyState& own, DVec3 momentum, const Sym3& inertia,
                   const Tensor& inverse_tensor, double seconds) {
  Top top;
  if (find_top(inertia, top)) return turn_top(start, momentum, top, seconds);
  const DVec3 middle =
      own.velocity + 0.5 * seconds * times(inverse_tensor, cross(own.momentum, own.velocity));
  return normalized(start * exponential_map(seconds * middle));
}

DQuat lane_of(const DQuatW<kFreeTurns>& q, int lane) {
  return {q.x.v[lane], q.y.v[lane], q.z.v[lane], q.w.v[lane]};
}
DVec3 lane_of(const DVec3W<kFreeTurns>& v, int lane) { return {v.x.v[lane], v.y.v[lane], v.z.v[lane]}; }

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
  const Tensor& m = inverse_inertia;
  const double steps = count_steps(angle);
  const DQuatW<1> q = turn_in_steps(
      DQuatW<1>{start.x, start.y, start.z, start.w}, DVec3W<1>{momentum.x, momentum.y, momentum.z},
      TensorW<1>{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}, WideDouble<1>(seconds), WideDouble<1>(steps), steps);
  return {q.x.v, q.y.v, q.z.v, q.w.v};
}

Vec3 rotate_steadily(Quat& orientation, Vec3 angular_velocity, float seconds) {
  const Vec3 turn = seconds * angular_velocity;
  if (turn == Vec3{}) return {};
  orientation = integrate_rotation(orientation, turn);
  return turn;
}

FreeTurnKind kind_of_turn(Quat orientation, Vec3 angular_velocity, const Sym3& inertia, float seconds) {
  const Vec3 w = rotate_inverse(orientation, angular_velocity);  // body frame
  const Vec3 momentum = inertia * w;                             // body frame
  const Vec3 torque = cross(momentum, w);
  const float angle = seconds * length(angular_velocity);
  if (angle < kNoAngle ||
      length_squared(torque) <= square(kSteady) * length_squared(momentum) * length_squared(w)) {
    return FreeTurnKind::steady;
  }
  Top top;
  return angle < kTinyAngle || find_top(inertia, top) ? FreeTurnKind::closed : FreeTurnKind::stepped;
}

void rotate_freely(const FreeTurn (&turns)[kFreeTurns], FreeTurnKind kind, float seconds) {
  using Doubles = WideDouble<kFreeTurns>;
  const FreeTurn &a = turns[0], &b = turns[1];
  const auto both = [](double first, double second) { return Doubles::of(Doubles::Double{first, second}); };
  const auto lanes = [&](const Tensor& m, const Tensor& n) {
    return TensorW<kFreeTurns>{both(m.xx, n.xx), both(m.yy, n.yy), both(m.zz, n.zz),
                               both(m.xy, n.xy), both(m.xz, n.xz), both(m.yz, n.yz)};
  };
  const Tensor tensors[] = {to_double(*a.inertia), to_double(*b.inertia)};
  const Tensor inverses[] = {inverse(tensors[0]), inverse(tensors[1])};
  const TensorW<kFreeTurns> inverse_tensor = lanes(inverses[0], inverses[1]);
  const DQuat from_a = to_double(*a.orientation), from_b = to_double(*b.orientation);
  const DVec3 spin_a(*a.angular_velocity), spin_b(*b.angular_velocity);
  const DQuatW<kFreeTurns> start =
      normalized(DQuatW<kFreeTurns>{both(from_a.x, from_b.x), both(from_a.y, from_b.y),
                                    both(from_a.z, from_b.z), both(from_a.w, from_b.w)});
  const DVec3W<kFreeTurns> velocity = rotate_inverse(
      start,
      DVec3W<kFreeTurns>{both(spin_a.x, spin_b.x), both(spin_a.y, spin_b.y), both(spin_a.z, spin_b.z)});
  const DVec3W<kFreeTurns> own_momentum = times(lanes(tensors[0], tensors[1]), velocity);
  const DVec3W<kFreeTurns> momentum = rotate(start, own_momentum);
  DQuatW<kFreeTurns> q;
  if (kind == FreeTurnKind::stepped) {
    const auto steps = [&](const FreeTurn& turn) {
      return count_steps(double(seconds * length(*turn.angular_velocity)));
    };
    const double steps_a = steps(a), steps_b = steps(b);
    q = turn_in_steps(start, momentum, inverse_tensor, Doubles(double(seconds)), both(steps_a, steps_b),
                      max(steps_a, steps_b));
  } else {
    DQuat turned[kFreeTurns];
    for (int i = 0; i < kFreeTurns; ++i) {
      turned[i] = turn_at_once(lane_of(start, i), {lane_of(velocity, i), lane_of(own_momentum, i)},
                               lane_of(momentum, i), *turns[i].inertia, inverses[i], double(seconds));
    }
    q = {both(turned[0].x, turned[1].x), both(turned[0].y, turned[1].y), both(turned[0].z, turned[1].z),
         both(turned[0].w, turned[1].w)};
  }
  const DVec3W<kFreeTurns> spin = rotate(q, body_velocity(q, momentum, inverse_tensor));
  const DQuatW<kFreeTurns> turn = q * conjugate(start);
  for (int i = 0; i < kFreeTurns; ++i) {
    *turns[i].angular_velocity = to_float(lane_of(spin, i));
    *turns[i].orientation = to_float(lane_of(q, i));
    *turns[i].turned = to_float(logarithm_map(lane_of(turn, i)));
  }
}

}  // namespace gyre
