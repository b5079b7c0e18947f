#include "solver/joint/joint_axis.h"

#include "math/trig.h"
#include "solver/joint/joint_blocks.h"

namespace gyre {

namespace {

// Share of a constant force that arrives as speed in a sub-step h with 2 d h = decay.
double constant_force_share(double decay) {
  return decay > 1.0e-6 ? (1.0 - exp(-decay)) / decay : 1.0 - 0.5 * decay;
}

// Coefficients of a spring row for one sub-step.
//
// As long as the sub-step resolves the spring (omega h <= 1), semi-implicit Euler has exactly the eigenvalues
// of the continuous oscillator: det = exp(-2 zeta omega h), trace = 2 exp(-zeta omega h) cos(omega_d h). An
// undamped spring then keeps its amplitude for ever and its period exactly. Other changes of speed in the
// sub-step (weight, contacts, other joints) count as a constant load, scaled so that the rest position is
// where that load and the spring balance. Faster springs are implicit: stable at any stiffness.
SpringStep make_spring(const JointAxisRecord& axis, float effective_mass, float substep) {
  SpringStep spring;
  const double h = double(substep), mass = double(effective_mass);
  if (!(mass > 0.0)) return spring;
  const double omega = std::sqrt(double(axis.stiffness) / mass);
  const double decay = 0.5 * double(axis.damping) / mass;  // zeta omega
  spring.is_implicit = omega * h > 1.0 || decay * h > 1.0;
  if (spring.is_implicit) {
    // Stiffness and damping at the end of the sub-step: J = -h (k (x + h v') + c v').
    const double a2 = h * (h * omega * omega + 2.0 * decay);
    const double a3 = 1.0 / (1.0 + a2);
    spring.implicit = {float(h * omega * omega / a2), float(a2 * a3), float(a3)};
    return spring;
  }
  const double e1 = exp(-decay * h);
  const double e2 = e1 * e1;
  const double square_d = omega * omega - decay * decay;
  const double angle = std::sqrt(square_d < 0.0 ? -square_d : square_d) * h;
  const double c = square_d < 0.0 ? 0.5 * (exp(angle) + exp(-angle)) : sin_cos(angle).cos;
  const double back = 1.0 + e2 - 2.0 * e1 * c;  // of the displacement over h
  const double phase_squared = square(omega * h);
  spring.retained = float(e2);
  spring.load_share =
      float(phase_squared > 1.0e-8 ? back / phase_squared : constant_force_share(2.0 * decay * h));
  spring.return_rate = float(back / h);
  return spring;
}

// The change of the spring's impulse.
float spring_change(const AxisConstraint& x, float speed) {
  const JointAxisRecord& axis = x.axis;
  const float displacement = axis.position - axis.rest_position;
  if (x.spring.is_implicit) {
    const Softness& s = x.spring.implicit;
    return -s.mass_scale * x.mass * (speed + s.bias_rate * displacement) -
           s.impulse_scale * axis.spring_impulse;
  }
  const float without = speed - axis.spring_impulse / x.mass;
  const float target_speed = x.spring.retained * x.speed_before +
                             x.spring.load_share * (without - x.speed_before) -
                             x.spring.return_rate * displacement;
  return x.mass * (target_speed - without) - axis.spring_impulse;
}

float motor_change(const AxisConstraint& x, float speed, float substep) {
  const JointAxisRecord& axis = x.axis;
  float target = axis.motor_impulse;
  if (axis.has_motor_target) {
    const float error = axis.position - axis.motor_position;
    const float closing = speed - axis.motor_velocity + x.drive.bias_rate * error;
    target -= x.drive.mass_scale * x.mass * closing + x.drive.impulse_scale * axis.motor_impulse;
  } else {
    target -= x.mass * (speed - axis.motor_velocity);
  }
  const float max_impulse = axis.motor_force * substep;
  return clamp(target, -max_impulse, max_impulse) - axis.motor_impulse;
}

float friction_change(const AxisConstraint& x, float speed, float substep) {
  const float max_impulse = x.axis.friction * substep;
  return clamp(x.axis.friction_impulse - x.mass * speed, -max_impulse, max_impulse) - x.axis.friction_impulse;
}

// The change of a limit's impulse. A soft limit acts once it is reached, and only in soft solves.
float limit_change(const AxisConstraint& x, float speed, float gap, float impulse,
                   const JointSettings& settings, bool soft) {
  if (x.axis.limit_frequency <= 0.0f)
    return limit_impulse_change(x.mass, speed, gap, impulse, settings, soft);
  if (!soft) return 0.0f;
  if (gap > 0.0f) return -impulse;
  const float change = -x.mass * x.limit_softness.mass_scale * (speed + x.limit_softness.bias_rate * gap) -
                       x.limit_softness.impulse_scale * impulse;
  return max(impulse + change, 0.0f) - impulse;
}

float rod_change(const AxisConstraint& x, float speed, const JointSettings& settings, bool soft) {
  if (!soft) return -x.mass * speed;
  const Softness& s = settings.softness;
  const float error = x.axis.position - x.axis.limits.low;
  return -s.mass_scale * x.mass * (speed + s.bias_rate * error) - s.impulse_scale * x.axis.low_impulse;
}

}  // namespace

float axis_speed(const AxisRow& row, const JointPair& pair) {
  return dot(row.linear_b, pair.linear_b) + dot(row.angular_b, pair.angular_b) -
         dot(row.linear_a, pair.linear_a) - dot(row.angular_a, pair.angular_a);
}

void apply_axis_impulse(const AxisRow& row, float impulse, JointPair& pair) {
  pair.linear_a -= (impulse * pair.inverse_mass_a()) * row.linear_a;
  pair.linear_b += (impulse * pair.inverse_mass_b()) * row.linear_b;
  pair.angular_a -= pair.inverse_inertia_a() * (impulse * row.angular_a);
  pair.angular_b += pair.inverse_inertia_b() * (impulse * row.angular_b);
}

float axis_impulse(const JointAxisRecord& axis) {
  return axis.low_impulse - axis.high_impulse + axis.motor_impulse + axis.spring_impulse +
         axis.friction_impulse;
}

void prepare_axis(AxisConstraint& x, const JointPair& pair, const JointSettings& settings) {
  const AxisRow& row = x.row;
  const float k = pair.inverse_mass_a() * length_squared(row.linear_a) +
                  pair.inverse_mass_b() * length_squared(row.linear_b) +
                  dot(row.angular_a, pair.inverse_inertia_a() * row.angular_a) +
                  dot(row.angular_b, pair.inverse_inertia_b() * row.angular_b);
  x.second_order_bias = 0.0f;
  x.speed_before = axis_speed(row, pair);
  const JointAxisRecord& axis = x.axis;
  prepare_axis_mass(x, inverse_or_zero(k), settings);
  x.drive = axis.motor_frequency > 0.0f
                ? make_softness(axis.motor_frequency, axis.motor_damping, settings.substep)
                : settings.softness;
  if (axis.limit_frequency > 0.0f)
    x.limit_softness = make_softness(axis.limit_frequency, axis.limit_damping, settings.substep);
}

void prepare_axis_mass(AxisConstraint& x, float mass, const JointSettings& settings) {
  x.mass = mass;
  if (has_spring(x.axis)) x.spring = make_spring(x.axis, mass, settings.substep);
}

namespace {

// Calls apply(impulse) for each change, and measure() for the speed along the row.
template <class Measure, class Apply>
void solve_axis_by(AxisConstraint& x, const JointSettings& settings, bool soft, Measure&& measure,
                   Apply&& apply) {
  if (!(x.mass > 0.0f)) return;
  JointAxisRecord& axis = x.axis;
  const float second_order_bias = soft ? x.second_order_bias : 0.0f;
  // Most limits are far away and most friction holds, so a zero change is not applied and the speed not
  // measured again.
  float speed_now = 0.0f;
  bool is_known = false;
  const auto change = [&](float& impulse, float by, float sign) {
    if (by == 0.0f) return;
    apply(sign * by);
    impulse += by;
    is_known = false;
  };
  const auto speed = [&] {
    if (!is_known) speed_now = measure() + second_order_bias;
    is_known = true;
    return speed_now;
  };
  if (soft && has_spring(axis)) change(axis.spring_impulse, spring_change(x, speed()), 1.0f);
  if (axis.motor_force > 0.0f && !settings.keeps_motors)
    change(axis.motor_impulse, motor_change(x, speed(), settings.substep), 1.0f);
  if (axis.friction > 0.0f)
    change(axis.friction_impulse, friction_change(x, speed(), settings.substep), 1.0f);
  if (x.is_rod) {
    if (settings.iterative) change(axis.low_impulse, rod_change(x, speed(), settings, soft), 1.0f);
    return;
  }
  if (!settings.iterative && !(axis.limit_frequency > 0.0f)) return;
  const float lowest = x.row.linear_b == Vec3{} && x.row.linear_a == Vec3{} ? -kMaxLimitError : -1.0e30f;
  if (x.has_low) {
    const float gap = max(low_gap(x), lowest);
    change(axis.low_impulse, limit_change(x, speed(), gap, axis.low_impulse, settings, soft), 1.0f);
  }
  if (x.has_high) {
    const float gap = max(high_gap(x), lowest);
    change(axis.high_impulse, limit_change(x, -speed(), gap, axis.high_impulse, settings, soft), -1.0f);
  }
}

}  // namespace

void solve_axis(AxisConstraint& x, JointPair& pair, const JointSettings& settings, bool soft) {
  if (x.in_articulation) return;
  solve_axis_by(
      x, settings, soft, [&] { return axis_speed(x.row, pair); },
      [&](float impulse) { apply_axis_impulse(x.row, impulse, pair); });
}

float solve_axis(AxisConstraint& x, float speed, float k, const JointSettings& settings, bool soft) {
  float sum = 0.0f;
  solve_axis_by(
      x, settings, soft, [&] { return speed + k * sum; }, [&](float impulse) { sum += impulse; });
  return sum;
}

}  // namespace gyre
