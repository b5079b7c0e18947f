#include "rigid/integrate/spring_stability.h"

#include "rigid/integrate/smooth_motion.h"

namespace gyre {

namespace {

// Largest modulus of the eigenvalues of a real 2 x 2 matrix, squared.
double spectral_square(double a, double b, double c, double d) {
  const double half_trace = 0.5 * (a + d), det = a * d - b * c;
  const double root = half_trace * half_trace - det;
  if (root <= 0.0) return det;
  return square(absolute(half_trace) + std::sqrt(root));
}

// Growth of (x, h v) in a step of x'' = -w^2 x - 2 d x'.
double growth(IntegratorKind kind, double frequency, double decay, double h) {
  const double k = square(frequency * h), c = 2.0 * decay * h;
  switch (kind) {
    case IntegratorKind::semi_implicit_euler:
      return spectral_square(1.0 - k, 1.0 - c, -k, 1.0 - c);
    case IntegratorKind::explicit_euler:
      return spectral_square(1.0, 1.0, -k, 1.0 - c);
    case IntegratorKind::rk4: {
      // exp(A) to the fourth order, A = (0 1; -k -c), by Horner.
      double m[4] = {1.0, 0.0, 0.0, 1.0};
      for (int n = 4; n >= 1; --n) {
        const double s = 1.0 / double(n);
        const double next[4] = {1.0 + s * m[2], s * m[3], -s * (k * m[0] + c * m[2]),
                                1.0 - s * (k * m[1] + c * m[3])};
        for (int i = 0; i < 4; ++i) m[i] = next[i];
      }
      return spectral_square(m[0], m[1], m[2], m[3]);
    }
    case IntegratorKind::verlet: {
      // a = -k x - c (V + a' / 2) in three rounds from a' = 0, as smooth_schemes.cpp does.
      double ax = 0.0, av = 0.0;
      for (int round = 0; round < 3; ++round) {
        const double x = ax, v = av;
        ax = -k - 0.5 * c * x;
        av = -c - 0.5 * c * v;
      }
      return spectral_square(1.0 + ax, 1.0 + av, ax, 1.0 + av);
    }
  }
  return 0.0;
}

struct SpringRow {
  std::uint32_t joint = 0;
  std::int32_t body[2] = {kNoBody, kNoBody};
  DVec3 lever[2];
  DVec3 along;
  double root = 0.0;  // of the stiffness
  double damping = 0.0;
};

SpringRow make_row(const RigidWorld& w, std::uint32_t slot) {
  const JointRecord& joint = w.joints.records[slot];
  SpringRow row;
  row.joint = slot;
  DVec3 point[2] = {joint.world_anchor_a, joint.world_anchor_b};
  const std::int32_t bodies[2] = {joint.body_a, joint.body_b};
  const Vec3 anchors[2] = {joint.local_anchor_a, joint.local_anchor_b};
  for (int k = 0; k < 2; ++k) {
    if (bodies[k] == kNoBody) continue;
    const std::size_t i = std::size_t(bodies[k]);
    row.lever[k] = DVec3(rotate(w.bodies.orientations[i], anchors[k]));
    point[k] = w.bodies.poses[i].center + row.lever[k];
    if (is_active(w, std::uint32_t(i))) row.body[k] = bodies[k];
  }
  const DVec3 offset = point[1] - point[0];
  const double size = length(offset);
  row.along = size > 0.0 ? offset / size : DVec3{0, 1, 0};
  row.root = std::sqrt(double(joint.stiffness));
  row.damping = double(joint.damping);
  return row;
}

struct Twist {
  DVec3 linear, angular;
};

// Applies impulses `z` along the springs, and computes the speeds of the springs from the velocities.
template <class Scale>
void respond(const RigidWorld& w, std::span<const SpringRow> rows, std::span<const double> z,
             std::span<Twist> twists, std::span<double> speeds, Scale&& scale) {
  for (const SpringRow& row : rows) {
    for (const std::int32_t body : row.body) {
      if (body != kNoBody) twists[std::size_t(body)] = {};
    }
  }
  for (std::size_t n = 0; n < rows.size(); ++n) {
    for (int k = 0; k < 2; ++k) {
      const std::int32_t body = rows[n].body[k];
      if (body == kNoBody) continue;
      const DVec3 impulse = (k == 0 ? -1.0 : 1.0) * scale(rows[n]) * z[n] * rows[n].along;
      const BodyMass& mass = w.bodies.masses[std::size_t(body)];
      twists[std::size_t(body)].linear += impulse / double(mass.mass);
      twists[std::size_t(body)].angular +=
          DVec3(w.bodies.inertia[std::size_t(body)].inverse * to_float(cross(rows[n].lever[k], impulse)));
    }
  }
  for (std::size_t n = 0; n < rows.size(); ++n) {
    double speed = 0.0;
    for (int k = 0; k < 2; ++k) {
      const std::int32_t body = rows[n].body[k];
      if (body == kNoBody) continue;
      const Twist& t = twists[std::size_t(body)];
      speed += (k == 0 ? -1.0 : 1.0) * dot(t.linear + cross(t.angular, rows[n].lever[k]), rows[n].along);
    }
    speeds[n] = speed;
  }
}

}  // namespace

SpringMode find_fastest_mode(const RigidWorld& w, Arena& arena) {
  constexpr int kRounds = 40;
  const ArenaScope scope(arena);
  const std::span<SpringRow> room = arena.make<SpringRow>(w.joints.ids.size());
  std::size_t count = 0;
  w.joints.ids.for_each_live([&](std::uint32_t slot) {
    if (is_explicit_spring(w, slot) && is_joint_solved(w, slot)) room[count++] = make_row(w, slot);
  });
  SpringMode mode;
  mode.springs = int(count);
  if (count == 0) return mode;
  const std::span<const SpringRow> rows = room.first(count);
  const std::span<Twist> twists = arena.make<Twist>(w.bodies.motion.size());
  const std::span<double> z = arena.make<double>(count), next = arena.make<double>(count);
  // A start that no symmetric mode is orthogonal to.
  for (std::size_t n = 0; n < count; ++n) z[n] = 1.0 + 0.37 * double(n % 7);
  const auto root = [](const SpringRow& row) { return row.root; };
  double value = 0.0;
  for (int round = 0; round < kRounds; ++round) {
    double norm = 0.0;
    for (const double v : z) norm += v * v;
    if (!(norm > 0.0)) break;
    for (double& v : z) v /= std::sqrt(norm);
    respond(w, rows, z, twists, next, root);
    value = 0.0;
    for (std::size_t n = 0; n < count; ++n) {
      next[n] *= rows[n].root;
      value += next[n] * next[n];
    }
    value = std::sqrt(value);
    if (!(value > 0.0) || round + 1 == kRounds) break;
    for (std::size_t n = 0; n < count; ++n) z[n] = next[n];
  }
  mode.frequency = std::sqrt(value);
  // In the mode's velocities the dampers take  sum c s^2  of  sum of m u^2 = z' z = 1.
  respond(w, rows, z, twists, next, root);
  double largest = 0.0, power = 0.0, inertia = 0.0;
  for (std::size_t n = 0; n < count; ++n) {
    power += rows[n].damping * next[n] * next[n];
    inertia += z[n] * rows[n].root * next[n];
    if (absolute(z[n]) > largest) largest = absolute(z[n]), mode.joint = rows[n].joint;
  }
  mode.decay = inertia > 0.0 ? 0.5 * power / inertia : 0.0;
  return mode;
}

double critical_step(IntegratorKind kind, double frequency, double decay) {
  const double rate = max(frequency, decay);
  if (!(rate > 0.0)) return kAnyStep;
  // Explicit Euler grows at any step without damping; the others only by rounding.
  constexpr double kSlack = 1.0e-9, kRounding = 1.0e-14;
  const auto follows = [&](double h) {
    return growth(kind, frequency, decay, h) <= 1.0 + kSlack * square(rate * h) + kRounding;
  };
  double low = 1.0e-4 / rate, high = 1.0e3 / rate;
  if (!follows(low)) return 0.0;
  // The first failing step, then bisection: stability beyond it is of no use.
  double h = low;
  while (h < high && follows(h)) low = h, h *= 1.1;
  high = h;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (follows(middle) ? low : high) = middle;
  }
  return low;
}

}  // namespace gyre
