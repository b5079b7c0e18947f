// Motions whose end is known, to measure the error of each integrator against the size of its step: the table of
// `gyre validate --integrators`, the charts of docs/numerics.md and tests/laws/integrators_test.cpp are all of these.
//
// One part is the time in which a body moves in one go: half a sub-step. Exact ends: closed forms (drag, orbit, oscillator), and for
// turning bodies Euler's equations by Runge-Kutta 4 in double with 20,000 steps, whose own error is below 1e-13.
// Sources: H. Goldstein, "Classical Mechanics" (orbit, Euler's equations); J. R. Taylor, "Classical Mechanics" (drag, oscillator).
#pragma once

#include <gyre/gyre.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace gyre::trials {

constexpr double kTurn = 6.283185307179586;

inline World make_world(IntegratorKind kind, Vec3 gravity, int substeps) {
  WorldDef def;
  def.gravity = gravity;
  def.sleeping = false;
  def.stepping.substeps = substeps;
  def.stepping.integrator = kind;
  def.stepping.springs = SpringKind::explicit_force;
  return std::move(*World::create(def));
}

// A step of at most 1 s is at most 64 sub-steps, of two parts each: as few steps as that allows.
struct Cut {
  int steps = 1, substeps = 1;
};
inline Cut cut(double seconds, int parts) {
  Cut out;
  for (out.substeps = 64; out.substeps > 1; --out.substeps) {
    if ((parts / 2) % out.substeps == 0 && seconds * 2.0 * out.substeps / parts <= 1.0) break;
  }
  out.steps = parts / (2 * out.substeps);
  return out;
}

// A mass point with principal moments 1, 2, 3 kg m^2.
inline BodyDef point() {
  BodyDef def;
  def.mass = 1.0f;
  def.center_of_mass = Vec3{};
  def.inertia = Sym3{1, 2, 3, 0, 0, 0};
  def.can_sleep = false;
  return def;
}

// Thrown up in a medium that takes 4 / s of its speed, v' = g - c v, so fast that it is back after 1 s: what it moved by is then near 0,
// and its rounding too.
inline double drag_error(IntegratorKind kind, int parts) {
  constexpr double kSeconds = 1.0, kDrag = 4.0, kPull = 9.8125;
  const Cut c = cut(kSeconds, parts);
  World world = make_world(kind, {0, float(-kPull), 0}, c.substeps);
  BodyDef def = point();
  const double kept = std::exp(-kDrag * kSeconds), way = (1.0 - kept) / kDrag, limit = -kPull / kDrag;
  def.linear_velocity = {0, float(limit - limit * kSeconds / way), 0};
  def.linear_damping = float(kDrag);
  const BodyId body = world.add_body(def);
  for (int i = 0; i < c.steps; ++i) world.step(float(kSeconds / c.steps));
  const DVec3 exact{0.0, limit * kSeconds + (double(def.linear_velocity.y) - limit) * way, 0.0};
  return length(world.pose(body).position - exact);
}

// 0.6 of a turn round a centre that pulls with the square of the distance: semi-major axis 1 m, period 1 s, eccentricity 0.3,
// from the farthest point. Kepler's equation by Newton.
inline double orbit_error(IntegratorKind kind, int parts) {
  constexpr double kSeconds = 0.625, kEccentric = 0.3;
  const Cut c = cut(kSeconds, parts);
  World world = make_world(kind, {}, c.substeps);
  FieldDef pull;
  pull.kind = FieldKind::radial;
  pull.strength = float(kTurn * kTurn);
  world.add_field(pull);
  const double mu = double(pull.strength), rate = std::sqrt(mu);
  BodyDef def = point();
  def.pose.position = {1.0 + kEccentric, 0.0, 0.0};
  def.linear_velocity = {0, float(rate * std::sqrt((1.0 - kEccentric) / (1.0 + kEccentric))), 0};
  const BodyId body = world.add_body(def);
  for (int i = 0; i < c.steps; ++i) world.step(float(kSeconds / c.steps));
  // The orbit of the speed as it is stored.
  const double v = double(def.linear_velocity.y), far = def.pose.position.x;
  const double axis = 1.0 / (2.0 / far - v * v / mu), e = far / axis - 1.0;
  const double mean = kTurn / 2.0 + std::sqrt(mu / (axis * axis * axis)) * kSeconds;
  double anomaly = mean;
  for (int i = 0; i < 50; ++i)
    anomaly -= (anomaly - e * std::sin(anomaly) - mean) / (1.0 - e * std::cos(anomaly));
  const DVec3 exact{-axis * (std::cos(anomaly) - e), -axis * std::sqrt(1.0 - e * e) * std::sin(anomaly), 0.0};
  return length(world.pose(body).position - exact);
}

// A mass on a Hooke spring of 1 Hz, pulled 1 m: place, and velocity over w, after 1.1 s. `alternating`: steps of 4/5 and 6/5 in turn.
inline double spring_error(IntegratorKind kind, int parts, bool alternating = false) {
  constexpr double kSeconds = 1.1;
  Cut c = cut(kSeconds, parts);
  if (alternating) c = {parts / 2, 1};
  World world = make_world(kind, {}, c.substeps);
  BodyDef def = point();
  def.pose.position = {3.0, 0.0, 0.0};
  const BodyId body = world.add_body(def);
  DistanceDef spring;
  spring.b = body;
  spring.length = 2.0f;
  spring.stiffness = float(kTurn * kTurn);
  world.add_joint(spring);
  const double rate = std::sqrt(double(*spring.stiffness));
  double time = 0.0;
  for (int i = 0; i < c.steps; ++i) {
    const float step = float(kSeconds / c.steps * (alternating ? (i % 2 == 0 ? 0.8 : 1.2) : 1.0));
    world.step(step);
    time += double(step);
  }
  const double x = world.pose(body).position.x - 2.0, v = double(world.linear_velocity(body).x) / rate;
  return std::hypot(x - std::cos(rate * time), v + std::sin(rate * time));
}

struct Turning {
  double q[4] = {0, 0, 0, 1};  // x y z w
  double l[3] = {};            // world
};
// q' = 1/2 w q, L' = torque, for moments 1, 2, 3.
inline Turning turning_rate(const Turning& s, const double* torque) {
  const double x = s.q[0], y = s.q[1], z = s.q[2], w = s.q[3];
  const double n = x * x + y * y + z * z + w * w;
  const double m[3][3] = {{1 - 2 * (y * y + z * z) / n, 2 * (x * y - w * z) / n, 2 * (x * z + w * y) / n},
                          {2 * (x * y + w * z) / n, 1 - 2 * (x * x + z * z) / n, 2 * (y * z - w * x) / n},
                          {2 * (x * z - w * y) / n, 2 * (y * z + w * x) / n, 1 - 2 * (x * x + y * y) / n}};
  double local[3], spin[3];
  for (int i = 0; i < 3; ++i) local[i] = (m[0][i] * s.l[0] + m[1][i] * s.l[1] + m[2][i] * s.l[2]) / (i + 1.0);
  for (int i = 0; i < 3; ++i) spin[i] = m[i][0] * local[0] + m[i][1] * local[1] + m[i][2] * local[2];
  Turning rate;
  rate.q[0] = 0.5 * (spin[0] * w + spin[1] * z - spin[2] * y);
  rate.q[1] = 0.5 * (spin[1] * w + spin[2] * x - spin[0] * z);
  rate.q[2] = 0.5 * (spin[2] * w + spin[0] * y - spin[1] * x);
  rate.q[3] = -0.5 * (spin[0] * x + spin[1] * y + spin[2] * z);
  for (int i = 0; i < 3; ++i) rate.l[i] = torque[i];
  return rate;
}
inline Turning moved_on(const Turning& s, const Turning& rate, double h) {
  Turning out = s;
  for (int i = 0; i < 4; ++i) out.q[i] += h * rate.q[i];
  for (int i = 0; i < 3; ++i) out.l[i] += h * rate.l[i];
  return out;
}

// A body with moments 1, 2, 3 that turns about no axis of its own, for 2 s: the angle between its orientation and the exact one.
inline double turn_error(IntegratorKind kind, int parts, Vec3 torque) {
  constexpr double kSeconds = 2.0;
  const Cut c = cut(kSeconds, parts);
  World world = make_world(kind, {}, c.substeps);
  BodyDef def = point();
  def.angular_velocity = {1.0f, 2.0f, 0.5f};
  const BodyId body = world.add_body(def);
  for (int i = 0; i < c.steps; ++i) {
    world.add_torque(body, torque);
    world.step(float(kSeconds / c.steps));
  }
  const double t[3] = {double(torque.x), double(torque.y), double(torque.z)};
  Turning s;
  for (int i = 0; i < 3; ++i) s.l[i] = (i + 1.0) * double(def.angular_velocity[i]);
  constexpr int kFine = 20000;
  const double h = kSeconds / kFine;
  for (int i = 0; i < kFine; ++i) {
    const Turning k1 = turning_rate(s, t), k2 = turning_rate(moved_on(s, k1, 0.5 * h), t);
    const Turning k3 = turning_rate(moved_on(s, k2, 0.5 * h), t), k4 = turning_rate(moved_on(s, k3, h), t);
    for (const auto& [k, weight] : {std::pair{k1, 1.0}, {k2, 2.0}, {k3, 2.0}, {k4, 1.0}})
      s = moved_on(s, k, weight * h / 6.0);
  }
  const Quat q = world.pose(body).orientation;
  // The vector part of q s^-1 is half the angle.
  const double a[4] = {double(q.x), double(q.y), double(q.z), double(q.w)};
  const double x = -a[3] * s.q[0] + a[0] * s.q[3] - a[1] * s.q[2] + a[2] * s.q[1];
  const double y = -a[3] * s.q[1] + a[1] * s.q[3] - a[2] * s.q[0] + a[0] * s.q[2];
  const double z = -a[3] * s.q[2] + a[2] * s.q[3] - a[0] * s.q[1] + a[1] * s.q[0];
  return 2.0 * std::sqrt(x * x + y * y + z * z);
}

inline double spin_error(IntegratorKind kind, int parts) { return turn_error(kind, parts, {}); }
inline double torque_error(IntegratorKind kind, int parts) {
  return turn_error(kind, parts, {1.0f, -2.0f, 3.0f});
}
inline double even_spring_error(IntegratorKind kind, int parts) { return spring_error(kind, parts); }
inline double uneven_spring_error(IntegratorKind kind, int parts) { return spring_error(kind, parts, true); }

struct Trial {
  const char* name;  // as a word
  const char* title;
  const char* unit;
  double seconds;
  double (*error)(IntegratorKind kind, int parts);
  int first_parts
      [kIntegratorKindCount];  // by kind: the coarsest cut; each of the next has twice as many parts
};
// Cuts in which the error is of the scheme: small against the motion, large against the rounding of places and velocities, which
// become floats at the end of each step (1e-7 of their size).
constexpr int kCuts = 4;
inline const Trial kTrials[] = {
    {"drag", "free flight in a medium", "m", 1.0, drag_error, {128, 128, 16, 32}},
    {"orbit", "free flight round a centre", "m", 0.625, orbit_error, {2048, 8192, 8, 128}},
    {"spring", "spring", "m", 1.1, even_spring_error, {512, 4096, 8, 64}},
    {"spin", "turning without a torque", "rad", 2.0, spin_error, {512, 512, 8, 64}},
    {"torque", "turning with a torque", "rad", 2.0, torque_error, {512, 512, 8, 64}},
};

// log2 of the ratio of two errors, of which the second is of steps half as long.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }
inline double expected_order(IntegratorKind kind) {
  return kind == IntegratorKind::rk4 ? 4.0 : kind == IntegratorKind::verlet ? 2.0 : 1.0;
}
// Semi-implicit Euler turns free bodies exactly: what is left is rounding.
inline bool is_exact(IntegratorKind kind, const Trial& trial) {
  return kind == IntegratorKind::semi_implicit_euler && trial.error == spin_error;
}
constexpr double kExact = 2.0e-6;  // rad: 128 roundings of an orientation and a velocity to float

inline std::vector<double> errors_of(const Trial& trial, IntegratorKind kind) {
  std::vector<double> errors;
  for (int k = 0; k < kCuts; ++k) errors.push_back(trial.error(kind, trial.first_parts[int(kind)] << k));
  return errors;
}

}  // namespace gyre::trials
