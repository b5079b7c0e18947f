// The velocity stages of a bundle of articulations (solver/articulation/articulation_lanes.h), as
// warm_start_articulation(), solve_articulation() and relax_articulation() for a single one. The three rows
// of a ball joint are one vector here, and an impulse acts on a body as a force at its arm.
#pragma once

#include "solver/articulation/articulation_drives_kernel.h"
#include "solver/articulation/articulation_energy_kernel.h"
#include "solver/articulation/articulation_limits_kernel.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// -------------------------------------------------------------------------------------------------- bias

template <int W>
GYRE_INLINE QuatW<W> small_rotation(Vec3W<W> v) {
  const Wide<W> a = min(length_squared(v), Wide<W>(1.0f));
  const Vec3W<W> u = (0.5f - a * (1.0f / 48.0f - a * (1.0f / 3840.0f))) * v;
  return {u.x, u.y, u.z, 1.0f - a * (1.0f / 8.0f - a * (1.0f / 384.0f))};
}

// Displacement of the end of an arm by a rotation.
template <int W>
GYRE_INLINE Vec3W<W> rotated_displacement(const QuatW<W>& rotation, Vec3W<W> arm) {
  const Vec3W<W> u{rotation.x, rotation.y, rotation.z};
  const Vec3W<W> t = 2.0f * cross(u, arm);
  return rotation.w * t + cross(u, t);
}

// Change of a hinge's error in the sub-step, over its length, beyond the linear rows.
template <int W>
GYRE_INLINE Vec3W<W> hinge_second_order_bias(const WideJoint<W>& joint, const WideBody<W>& a,
                                             const WideBody<W>& b, float per_substep) {
  const Vec3W<W> error = joint.angular_error;  // axis a x axis b
  const Vec3W<W> axis_b =
      cross(error, joint.axis) + sqrt(max(1.0f - length_squared(error), Wide<W>(0.0f))) * joint.axis;
  const Vec3W<W> change_a = rotated_displacement(a.rotation, joint.axis),
                 change_b = rotated_displacement(b.rotation, axis_b);
  return per_substep * (cross(change_a, axis_b) + cross(joint.axis, change_b) + cross(change_a, change_b)) -
         (b.angular - a.angular);
}

// Share of the second-order bias that is used. `angle_squared`: of the faster of the joint's bodies in the
// sub-step.
template <int W>
GYRE_INLINE Wide<W> bias_fade(Wide<W> angle_squared, float max_angle) {
  // None below kMinBiasAngle, a fading share beyond `max_angle`.
  constexpr float kMinSquare = kMinBiasAngle * kMinBiasAngle;
  const float max_square = max_angle * max_angle;
  const Wide<W> share = keep(angle_squared > kMinSquare, Wide<W>(1.0f));
  return select(angle_squared > max_square, max_square / angle_squared, share);
}

// 1/s, with a minus sign: the rate of error removal; up to the whole error at once where the bias fades.
template <int W>
GYRE_INLINE Wide<W> remove_error(Wide<W> angle_squared, float rate, float per_substep) {
  constexpr float kFastSquare = kFastErrorAngle * kFastErrorAngle;  // rad^2
  const Mask<W> fast = angle_squared > kFastSquare;
  const Wide<W> error_rate(-rate);
  if (none(fast)) return error_rate;
  return error_rate - (per_substep - rate) * keep(fast, 1.0f - kFastSquare / angle_squared);
}

template <int W>
GYRE_INLINE void add_second_order_bias(const LaneNode& node, WideJoint<W>& joint, const WideBody<W>& a,
                                       const WideBody<W>& b, Wide<W> share, float per_substep) {
  const Vec3W<W> second_order_bias = per_substep * (rotated_displacement(b.rotation, joint.from_b) -
                                                    rotated_displacement(a.rotation, joint.from_a)) -
                                     (cross(b.angular, joint.from_b) - cross(a.angular, joint.from_a));
  const Mask<W> has_bias = share > 0.0f;
  joint.target_speed = select(has_bias, joint.target_speed - share * second_order_bias, joint.target_speed);
  if (node.kind != JointKind::hinge) return;
  const Vec3W<W> angular = share * hinge_second_order_bias(joint, a, b, per_substep);
  joint.angular_target_1 =
      select(has_bias, joint.angular_target_1 - dot(angular, joint.perpendicular_1), joint.angular_target_1);
  joint.angular_target_2 =
      select(has_bias, joint.angular_target_2 - dot(angular, joint.perpendicular_2), joint.angular_target_2);
}

// Computes the bias of the rows, so that the end of the sub-step, not its beginning, meets the joints. (Not
// inlined, like the limits: all solves call it.)
template <int W>
__attribute__((noinline)) void compute_lane_bias(const WideBundle<W>& bundle, const LaneSettings& s,
                                                 ErrorBounds bounds) {
  const float h = s.substep, per_substep = 1.0f / s.substep;
  for (std::uint32_t i = 0; i < bundle.plain.body_count; ++i) {
    WideBody<W>& body = bundle.bodies[i];
    const Vec3W<W> w = body.angular;
    const Vec3W<W> gyroscopic = body.own_inverse * cross(body.inertia * w, w);  // free rotation
    body.rotation = small_rotation(h * (w + (0.5f * h * s.gyroscopic_share) * gyroscopic));
  }
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    WideJoint<W>& joint = bundle.joints[n];
    const WideBody<W>&a = bundle.bodies[node.a], &b = bundle.bodies[node.b];
    const Wide<W> angle_squared = (h * h) * max(length_squared(a.angular), length_squared(b.angular));
    const Wide<W> error_rate = remove_error(angle_squared, s.rate, per_substep);
    joint.target_speed = error_rate * clamp_length(joint.error, bounds.point);
    if (node.kind == JointKind::hinge) {
      const Vec3W<W> angular = error_rate * clamp_length(joint.angular_error, bounds.rotation);
      joint.angular_target_1 = dot(angular, joint.perpendicular_1);
      joint.angular_target_2 = dot(angular, joint.perpendicular_2);
    }
    const Wide<W> share = bias_fade(angle_squared, s.max_bias_angle);
    if (any(share > 0.0f)) add_second_order_bias(node, joint, a, b, share, per_substep);
  }
}

// --------------------------------------------------------------------------------------------------------- equations

// The right side of a solve.
enum class BiasUse : std::uint8_t {
  first,  // bias only; there are no impulses yet
  again,  // bias, and compliance times the accumulated impulses
  relax,  // zero speed along the rows
};

// If no row misses more, the equations hold to the rounding of velocities, and nothing is solved.
constexpr float kMaxResidual = 1.0e-5f;  // m/s or rad/s

// Sets the right side: the missing speed of each row. Returns the lanes where it is more than rounding.
template <int W, BiasUse use>
GYRE_INLINE Mask<W> set_missing(const WideBundle<W>& bundle) {
  Wide<W> largest(0.0f);
  const auto set = [&](std::uint32_t row, Wide<W> v) {
    bundle.set_row(row, v);
    largest = max(largest, max(v, Wide<W>(0.0f) - v));
  };
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    const WideJoint<W>& joint = bundle.joints[n];
    const WideBody<W>&a = bundle.bodies[node.a], &b = bundle.bodies[node.b];
    Vec3W<W> missing = a.linear + cross(a.angular, joint.from_a) - b.linear - cross(b.angular, joint.from_b);
    if constexpr (use == BiasUse::first) missing += joint.target_speed;
    if constexpr (use == BiasUse::again)
      missing += joint.target_speed - multiply_each(joint.compliance, joint.linear_impulse);
    set(node.row, missing.x);
    set(node.row + 1, missing.y);
    set(node.row + 2, missing.z);
    if (node.kind != JointKind::hinge) continue;
    const Vec3W<W> spin = a.angular - b.angular;
    Wide<W> first = dot(spin, joint.perpendicular_1), second = dot(spin, joint.perpendicular_2);
    if constexpr (use == BiasUse::first) {
      first += joint.angular_target_1;
      second += joint.angular_target_2;
    }
    if constexpr (use == BiasUse::again) {
      first += joint.angular_target_1 -
               joint.angular_compliance_1 * dot(joint.angular_impulse, joint.perpendicular_1);
      second += joint.angular_target_2 -
                joint.angular_compliance_2 * dot(joint.angular_impulse, joint.perpendicular_2);
    }
    set(node.row + 3, first);
    set(node.row + 4, second);
  }
  return largest > kMaxResidual;
}

// Solves for the change of all impulses and applies it, in these lanes.
template <int W, BiasUse use>
GYRE_INLINE void solve_rows(const WideBundle<W>& bundle, Mask<W> lanes = Mask<W>::splat(true)) {
  const Mask<W> live = set_missing<W, use>(bundle) & lanes;
  if (any(live)) {
    factor_bundle(bundle);
    solve_lanes<W>(bundle.plain);
  } else if (use != BiasUse::first) {
    return;  // the accumulated impulses stay
  }
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    WideJoint<W>& joint = bundle.joints[n];
    const Vec3W<W> p = keep(live, bundle.rows3(node.row));
    Vec3W<W> t{Wide<W>(0.0f), Wide<W>(0.0f), Wide<W>(0.0f)};
    if (node.kind == JointKind::hinge) {
      t = keep(live, bundle.row(node.row + 3) * joint.perpendicular_1 +
                         bundle.row(node.row + 4) * joint.perpendicular_2);
      if constexpr (use == BiasUse::first)
        joint.angular_impulse = t;
      else
        add_in_lanes<W>(joint.angular_impulse, t, live);
    }
    apply_joint_impulse(bundle, node, joint, p, t);
    if constexpr (use == BiasUse::first)
      joint.linear_impulse = p;
    else
      add_in_lanes<W>(joint.linear_impulse, p, live);
  }
}

// Drives and friction are iterated, then the equations have the last word. (Not inlined, like the limits: all
// of it is long.)
template <int W>
__attribute__((noinline)) void solve_with_accumulated(const WideBundle<W>& bundle,
                                                      Mask<W> kept = Mask<W>::splat(false)) {
  if (bundle.plain.drive_count > 0) iterate_drives(bundle, kept);
  solve_rows<W, BiasUse::again>(bundle);
}
template <int W>
__attribute__((noinline)) void relax(const WideBundle<W>& bundle, Mask<W> lanes) {
  if (bundle.plain.drive_count > 0) iterate_drives(bundle);
  if (any(lanes)) solve_rows<W, BiasUse::relax>(bundle, lanes);
}

// -------------------------------------------------------------------------------------------------------------- limits

// The impulse of a limit in the last half step, along its present axis; zero for axes that cannot rotate.
template <int W>
GYRE_INLINE Vec3W<W> accumulated_impulse(WideLimitAxis<W>& axis) {
  const Mask<W> is_rotatable = axis.mass > 0.0f;
  axis.low_impulse = keep(is_rotatable, axis.low_impulse);
  axis.high_impulse = keep(is_rotatable, axis.high_impulse);
  return (axis.low_impulse - axis.high_impulse) * axis.about;
}

template <int W>
GYRE_INLINE void warm_start_limits(const WideBundle<W>& bundle) {
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    WideJoint<W>& joint = bundle.joints[n];
    if (!node.has_twist && !node.has_swing && !node.has_servo) continue;
    const Wide<W> zero(0.0f);
    Vec3W<W> angular{zero, zero, zero};
    if (node.has_twist) angular += accumulated_impulse(joint.twist);
    if (node.has_swing) angular += accumulated_impulse(joint.swing);
    if (node.has_servo) angular += accumulated_impulse(bundle.servos[node.servo].axis);
    if (bundle.moves(node.a)) bundle.bodies[node.a].angular -= bundle.bodies[node.a].inverse * angular;
    if (bundle.moves(node.b)) bundle.bodies[node.b].angular += bundle.bodies[node.b].inverse * angular;
  }
}

template <int W>
__attribute__((noinline)) void solve_limits(const WideBundle<W>& bundle, const LaneSettings& s,
                                            ErrorBounds bounds, Mask<W> lanes = Mask<W>::splat(true),
                                            Mask<W> kept = Mask<W>::splat(false)) {
  if (bundle.plain.limit_count > 0) LimitSolver<W>(bundle, s, bounds, kept).solve(lanes);
}

template <int W>
GYRE_INLINE void accumulate_limit(WideJoint<W>& joint, WideLimitAxis<W>& axis) {
  const Wide<W> along = axis.low_impulse - axis.high_impulse;
  axis.total += along;
  joint.total_angular += along * axis.about;
}

// ------------------------------------------------------------------------------------------------------------- stages

// Before the first half step of a step.
template <int W>
void begin_articulation_bundles(const ArticulationBundle& plain) {
  if (plain.limit_count == 0) return;
  const WideBundle<W> bundle(plain);
  LimitSolver<W>(bundle, {}, kNoErrors).clear();
}

// Prepares the rows at the present poses, and their matrix.
template <int W>
void prepare_articulations(const ArticulationBundle& plain, const LaneArrays& arrays, const LaneSettings& s) {
  prepare_bundle<W>(plain, arrays, s);
  const WideBundle<W> bundle(plain);
  if (plain.drive_count > 0) prepare_lane_drives(bundle);
  if (plain.servo_count > 0) prepare_lane_servos(bundle);
  if (plain.limit_count > 0) LimitSolver<W>(bundle, s, kNoErrors).begin();
}

// Before the warm start: after an impact the old impulses do not belong to this sub-step, and neither would
// their bias.
template <int W>
void compute_bundle_bias(const ArticulationBundle& plain, const LaneArrays& arrays, const LaneSettings& s) {
  const WideBundle<W> bundle(plain);
  load_velocities(bundle, arrays);
  compute_lane_bias(bundle, s, s.first_errors);
}

// Lanes in which a body rotates so far in a half step that the bias matters for its velocities.
template <int W>
GYRE_INLINE Mask<W> find_fast(const WideBundle<W>& bundle, float substep) {
  Wide<W> largest(0.0f);
  for (std::uint32_t i = 0; i < bundle.plain.moving_count; ++i)
    largest = max(largest, length_squared(bundle.bodies[i].angular));
  return (substep * substep) * largest > kSlowRotation * kSlowRotation;
}

// The impulses of equations start from zero, those of limits from the last ones. With drives, all start from
// the last ones.
template <int W>
void solve_bundle(const ArticulationBundle& plain, const LaneArrays& arrays, const LaneSettings& s) {
  const WideBundle<W> bundle(plain);
  load_velocities(bundle, arrays);
  const EnergyLimiter<W> limiter(
      bundle, Mask<W>::splat(s.limits_energy) & (extreme_ratio_lanes(bundle) | find_fast(bundle, s.substep)));
  warm_start_limits(bundle);
  if (plain.drive_count > 0) {
    warm_start_driven(bundle);
    solve_with_accumulated(bundle);
  } else {
    solve_rows<W, BiasUse::first>(bundle);
  }
  solve_limits(bundle, s, s.first_errors);
  limiter.limit_gain(s.rate, s.substep);     // before contacts respond to the gain
  compute_lane_bias(bundle, s, kMaxErrors);  // with velocities that agree with the joints
  store_velocities(bundle, arrays);
}

template <int W>
void solve_bundle_after_contacts(const ArticulationBundle& plain, const LaneArrays& arrays,
                                 const LaneSettings& s) {
  const WideBundle<W> bundle(plain);
  load_velocities(bundle, arrays);
  const EnergyLimiter<W> limiter(bundle);
  const Mask<W> kept = Mask<W>::of_bits(bundle.plain.presses_held);
  solve_with_accumulated(bundle, kept);
  solve_limits(bundle, s, kMaxErrors, Mask<W>::splat(true), kept);
  limiter.limit_gain(s.rate, s.substep);
  store_velocities(bundle, arrays);
}

template <int W>
__attribute__((noinline)) void sum_impulses(const WideBundle<W>& bundle) {
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    WideJoint<W>& joint = bundle.joints[n];
    joint.total_linear += joint.linear_impulse;
    joint.total_angular += joint.angular_impulse;
    if (node.has_twist) accumulate_limit(joint, joint.twist);
    if (node.has_swing) accumulate_limit(joint, joint.swing);
    if (node.has_servo) accumulate_limit(joint, bundle.servos[node.servo].axis);
    if (node.is_driven()) accumulate_drives(node, joint, bundle.drives[node.drives]);
  }
}

// Lanes in which a limit pushes a limb back faster than it may stay. That speed is removed at once: limits
// only push, so the next half step, whose limits start from these impulses, would not remove all of it.
template <int W>
GYRE_INLINE Mask<W> find_rebounding(const WideBundle<W>& bundle) {
  constexpr float kMaxReboundSpeed = 0.01f;  // rad/s
  Mask<W> rebounding = Mask<W>::splat(false);
  for (std::uint32_t n = 0; n < bundle.plain.node_count; ++n) {
    const LaneNode& node = bundle.plain.nodes[n];
    if (!node.has_twist && !node.has_swing) continue;
    const Vec3W<W> spin = relative_spin_of(bundle, node);
    const auto check = [&](const WideLimitAxis<W>& axis) {
      const Wide<W> speed = dot(axis.about, spin);
      rebounding = rebounding | ((axis.low_impulse > 0.0f) & (speed > kMaxReboundSpeed)) |
                   ((axis.high_impulse > 0.0f) & (speed < -kMaxReboundSpeed));
    };
    if (node.has_twist) check(bundle.joints[n].twist);
    if (node.has_swing) check(bundle.joints[n].swing);
  }
  return rebounding;
}

// After each move but the last: sums the impulses, and computes the bias of the next half step. The speed
// from error removal stays for that half step: only forces precede its first solve, which sets J v to the
// bias anyway. The speed is removed here where bodies rotate far, since the bias is computed from these
// velocities and limbs that start beyond their limits would be flung, and with drives, which would hold
// against it.
template <int W>
void end_half_step(const ArticulationBundle& plain, const LaneArrays& arrays, const LaneSettings& s) {
  const WideBundle<W> bundle(plain);
  load_velocities(bundle, arrays);
  const bool is_driven = plain.drive_count > 0;
  const Mask<W> fast = find_fast(bundle, s.substep), relaxed = is_driven ? Mask<W>::splat(true) : fast;
  // Motors and drives hold against each other.
  const Mask<W> limited = is_driven && plain.servo_count > 0 ? relaxed : fast | find_rebounding(bundle);
  const EnergyLimiter<W> limiter(bundle);
  relax(bundle, relaxed);
  if (any(limited)) solve_limits(bundle, s, kNoErrors, limited);
  const Mask<W> slowed = limiter.remove_gain();
  if (any(relaxed | limited | slowed)) store_velocities(bundle, arrays);
  compute_lane_bias(bundle, s, s.first_errors);
  sum_impulses(bundle);
}
// After the last move: removes all speed along the rows and into limits, and sums the impulses.
template <int W>
void end_step_bundle(const ArticulationBundle& plain, const LaneArrays& arrays, const LaneSettings& s) {
  const WideBundle<W> bundle(plain);
  load_velocities(bundle, arrays);
  const EnergyLimiter<W> limiter(bundle);
  relax(bundle, Mask<W>::splat(true));
  solve_limits(bundle, s, kNoErrors);
  limiter.remove_gain();
  sum_impulses(bundle);
  store_velocities(bundle, arrays);
}

template <int W>
constexpr ArticulationKernels articulation_kernels() {
  return {W,
          sizeof(WideBody<W>),
          sizeof(WideJoint<W>),
          sizeof(WideDrives<W>),
          sizeof(WideServo<W>),
          offsetof(WideBody<W>, linear),
          limit_room<W>,
          begin_articulation_bundles<W>,
          prepare_articulations<W>,
          compute_bundle_bias<W>,
          solve_bundle<W>,
          solve_bundle_after_contacts<W>,
          end_half_step<W>,
          end_step_bundle<W>};
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
