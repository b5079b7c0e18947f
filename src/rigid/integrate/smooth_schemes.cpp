#include "rigid/integrate/smooth_schemes.h"

#include "math/trig.h"

namespace gyre {

namespace {

// rad: bound on the rotation of a body in a sub-step; rotation vectors are undefined beyond it.
constexpr double kMaxHalfStepRotation = 3.0;
// Verlet's implicit rotation: each round gains the factor h w / 2. Rotations too large to converge are beyond
// any scheme of order 2.
constexpr int kRotationRounds = 24;
constexpr double kRotationTolerance = 1.0e-15;
// Rounds for velocities within forces that depend on them: each gains an order.
constexpr int kVelocityRounds = 3;

DQuat rotated_by(DQuat q, DVec3 rotation) { return normalized(exponential_map(rotation) * q); }

void rotate(SchemeRoom& room, std::size_t i, DVec3 by) {
  room.states[i].q = rotated_by(room.states[i].q, by);
  room.delta_rotation[i] += by;
}

// The exact step of v' = a - c v.
void integrate_velocity(DVec3& v, DVec3 a, double damping, double h) {
  if (!(damping > 0.0)) {
    v += h * a;
    return;
  }
  const double share = 1.0 - exp(-damping * h);
  v = v + (share / damping) * a + (-share) * v;
}

void integrate_velocities(const SmoothSystem& system, SchemeRoom& room, double h) {
  for (std::size_t i = 0; i < room.states.size(); ++i) {
    const SmoothBody& body = system.bodies[i];
    integrate_velocity(room.states[i].v, room.rates[i].acceleration, body.linear_damping, h);
    integrate_velocity(room.states[i].l, room.rates[i].torque, body.angular_damping, h);
  }
}

void rotate_at_constant_momentum(const SmoothBody& body, SchemeRoom& room, std::size_t i, double h) {
  SmoothState& s = room.states[i];
  const DVec3 spin = spin_of(body, s);
  const double angle = h * length(spin);
  if (body.locked_angular != 0 || !(angle > 0.0)) return rotate(room, i, h * spin);
  const DQuat next = normalized(rotate_at_momentum(s.q, s.l, body.inverse_inertia, h, angle));
  room.delta_rotation[i] += logarithm_map(next * conjugate(s.q));
  s.q = next;
}

void step_explicit_euler(const SmoothSystem& system, SchemeRoom& room, double time, double h) {
  find_rates(system, room.states, time, h, false, room.rates);
  for (std::size_t i = 0; i < room.states.size(); ++i) {
    room.states[i].x += h * room.states[i].v;
    rotate(room, i, h * spin_of(system.bodies[i], room.states[i]));
  }
  integrate_velocities(system, room, h);
}

void step_semi_implicit_euler(const SmoothSystem& system, SchemeRoom& room, double time, double h) {
  find_rates(system, room.states, time, h, false, room.rates);
  integrate_velocities(system, room, h);
  for (std::size_t i = 0; i < room.states.size(); ++i) {
    room.states[i].x += h * room.states[i].v;
    rotate_at_constant_momentum(system.bodies[i], room, i, h);
  }
}

DQuat along(DQuat q, DQuat rate, double h) {
  return {q.x + h * rate.x, q.y + h * rate.y, q.z + h * rate.z, q.w + h * rate.w};
}

// 1/2 w q
DQuat rate_of(DQuat q, DVec3 spin) {
  const DQuat d = DQuat{0.5 * spin.x, 0.5 * spin.y, 0.5 * spin.z, 0.0} * q;
  return d;
}

void step_rk4(const SmoothSystem& system, SchemeRoom& room, double time, double h) {
  constexpr double kAhead[4] = {0.0, 0.5, 0.5, 1.0}, kWeight[4] = {1.0, 2.0, 2.0, 1.0};
  const std::size_t count = room.states.size();
  const double share = h / 6.0;
  for (int k = 0; k < 4; ++k) {
    const double ahead = kAhead[k] * h;
    for (std::size_t i = 0; i < count; ++i) {
      const SmoothState& s = room.states[i];
      SmoothState& stage = room.stage[i];
      if (k == 0) {
        stage = s;
        room.sum[i] = {};
        room.drift[i] = {};
        room.sum_q[i] = {0.0, 0.0, 0.0, 0.0};
        continue;
      }
      const DVec3 speed = stage.v;
      stage.x = s.x + ahead * speed;
      stage.v = s.v + ahead * room.rates[i].acceleration;
      stage.q = normalized(along(s.q, room.rates_q[i], ahead));
      stage.l = s.l + ahead * room.rates[i].torque;
    }
    find_rates(system, room.stage, time + ahead, kWeight[k] * share, true, room.rates);
    for (std::size_t i = 0; i < count; ++i) {
      const SmoothState& stage = room.stage[i];
      room.rates_q[i] = rate_of(stage.q, spin_of(system.bodies[i], stage));
      room.drift[i] += kWeight[k] * stage.v;
      room.sum[i].acceleration += kWeight[k] * room.rates[i].acceleration;
      room.sum[i].torque += kWeight[k] * room.rates[i].torque;
      room.sum_q[i] = along(room.sum_q[i], room.rates_q[i], kWeight[k]);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    SmoothState& s = room.states[i];
    const DQuat next = normalized(along(s.q, room.sum_q[i], share));
    room.delta_rotation[i] += logarithm_map(next * conjugate(s.q));
    s.q = next;
    s.x += share * room.drift[i];
    s.v += share * room.sum[i].acceleration;
    s.l += share * room.sum[i].torque;
  }
}

// ------------------------------------------------------------------------------------------------------------ Verlet

// Verlet's v and l are those at the middle of the last move. Extrapolates them to the time of the pose by the
// known forces there, into `stage`.
void find_pose_velocities(SchemeRoom& room, bool known) {
  for (std::size_t i = 0; i < room.states.size(); ++i) {
    room.stage[i] = room.states[i];
    const LastMove& move = room.moves[i];
    if (!known || !(move.seconds > 0.0)) continue;
    room.stage[i].v += (0.5 * move.seconds) * room.rates[i].acceleration;
    room.stage[i].l += (0.5 * move.seconds) * room.rates[i].torque;
  }
}

// Forces at the present poses, iterated where they depend on velocities.
void find_rates_at_pose(const SmoothSystem& system, SchemeRoom& room, double time, double weight) {
  const int rounds = system.damped ? kVelocityRounds : 1;
  for (int round = 0; round < rounds; ++round) {
    find_pose_velocities(room, round > 0);
    find_rates(system, room.stage, time, round + 1 == rounds ? weight : 0.0, true, room.rates);
  }
}

// The rotation with I(q_mid) rotation / h = l.
DVec3 find_rotation(const SmoothBody& body, const SmoothState& s, double h) {
  if (body.locked_angular != 0) return h * s.l;
  SmoothState middle = s;
  DVec3 rotation = h * spin_of(body, s);
  for (int round = 0; round < kRotationRounds; ++round) {
    middle.q = rotated_by(s.q, 0.5 * rotation);
    const DVec3 next = h * spin_of(body, middle);
    const double change = length(next - rotation);
    rotation = next;
    if (change <= kRotationTolerance * (1.0 + length(rotation))) break;
  }
  const double size = length(rotation);
  return size > kMaxHalfStepRotation ? (kMaxHalfStepRotation / size) * rotation : rotation;
}

// v and l at the middle of the last move, from the last two poses.
void read_last_move(const SmoothBody& body, const LastMove& move, SmoothState& s) {
  if (!(move.seconds > 0.0)) return;
  s.v = move.moved / move.seconds;
  SmoothState middle = s;
  middle.q = rotated_by(s.q, -0.5 * move.turned);
  s.l = momentum_of(body, middle, move.turned / move.seconds);
}

void step_verlet(const SmoothSystem& system, SchemeRoom& room, double time, double h) {
  const std::size_t count = room.states.size();
  for (std::size_t i = 0; i < count; ++i) read_last_move(system.bodies[i], room.moves[i], room.states[i]);
  find_rates_at_pose(system, room, time, h);
  for (std::size_t i = 0; i < count; ++i) {
    SmoothState& s = room.states[i];
    LastMove& move = room.moves[i];
    // A body with a velocity but no last pose: half a sub-step of acceleration turns it into that of the
    // middle.
    const double seconds = 0.5 * (h + move.seconds);
    s.v += seconds * room.rates[i].acceleration;
    s.l += seconds * room.rates[i].torque;
    move.moved = h * s.v;
    move.turned = find_rotation(system.bodies[i], s, h);
    move.seconds = h;
    s.x += move.moved;
    rotate(room, i, move.turned);
  }
}

}  // namespace

SchemeRoom make_room(std::size_t bodies, Arena& arena) {
  return {arena.make<SmoothState>(bodies), arena.make<LastMove>(bodies), arena.make<DVec3>(bodies),
          arena.make<SmoothState>(bodies), arena.make<Rates>(bodies),    arena.make<Rates>(bodies),
          arena.make<DVec3>(bodies),       arena.make<DQuat>(bodies),    arena.make<DQuat>(bodies)};
}

void integrate(IntegratorKind kind, const SmoothSystem& system, SchemeRoom& room, double time, double h) {
  switch (kind) {
    case IntegratorKind::semi_implicit_euler:
      return step_semi_implicit_euler(system, room, time, h);
    case IntegratorKind::explicit_euler:
      return step_explicit_euler(system, room, time, h);
    case IntegratorKind::rk4:
      return step_rk4(system, room, time, h);
    case IntegratorKind::verlet:
      return step_verlet(system, room, time, h);
  }
}

void set_pose_velocities(IntegratorKind kind, const SmoothSystem& system, SchemeRoom& room, double time) {
  if (kind == IntegratorKind::verlet) {
    find_rates_at_pose(system, room, time, 0.0);
    find_pose_velocities(room, true);
    return;
  }
  for (std::size_t i = 0; i < room.states.size(); ++i) room.stage[i] = room.states[i];
}

}  // namespace gyre
