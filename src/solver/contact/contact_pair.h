// Contact blocks and the pairs of bodies that they act on: their data, access to velocities, effect of
// impulses, and relative motion of points. Part of the kernels (contact_kernel.h).
#pragma once

#include "math/wide_vec.h"
#include "solver/contact/contact_block.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
struct PointBlock {
  Vec3W<W> arm;          // from a centre of mass to the point, times the normal: the angular effect of an
                         // impulse along the normal
  Wide<W> separation;    // as the step began
  Wide<W> mean_impulse;  // the mean normal impulse
};

// Index of row i, column j (either order) in a packed upper triangle, column by column (00 01 11 02 12 22 03
// 13 23 33). The triangle of fewer points is its beginning.
constexpr int packed(int i, int j) { return i <= j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j; }

// Data of a block that only some stages or lanes need.
template <int W>
struct ContactBlockCold {
  // Used where contacts slide or surfaces move.
  Wide<W> slide_mass;    // scalar step for sliding, so that friction opposes the slip equally in every
                         // direction
  Wide<W> twist_radius;  // m: scale of the twist row beside the tangents
  Wide<W> surface_1, surface_2;
  // Used where points are tensile: K = J M^-1 J^T of the normal rows, upper triangle. It and
  // `inverse_diagonal` are 0 in rows of missing points.
  Wide<W> k[10];
  Wide<W> inverse_diagonal[kMaxManifoldPoints];  // 1 / K_ii
  // Targets of velocities if not all bodies of a side are movable: `nowhere` for those that are not.
  float* write_a[W];
  float* write_b[W];
  // Inverse masses along locked world axes, 0 along free ones. Set if the block has locked axes.
  Vec3W<W> locked_mass_a, locked_mass_b;
  Wide<W> fresh;                   // 1 where no load is known yet
  Wide<W> mobility_a, mobility_b;  // shares of the inverse masses in pushout
  // Rolling friction.
  Wide<W> rolling_friction, rolling_mass;
  Vec3W<W> rolling;
  // m: how far the arms on A and B have moved since the step began, in the lanes of `carried_a` and `carried_b`, and may move.
  Vec3W<W> moved_a, moved_b;
  Wide<W> reach_a, reach_b;
  alignas(64) float nowhere[kRecordFloats];
};

// Data that all stages read. Blocks of a large island do not fit into the caches and are loaded anew in each
// stage, as fast as the prefetcher predicts the lines: three times as fast without gaps.
template <int W>
struct alignas(64) ContactBlock {
  // Motion records of the bodies: zeros for none.
  float* read_a[W];
  float* read_b[W];
  ContactBlockCold<W>* cold;
  std::int32_t point_count = 0;  // the largest of any lane; three are prepared as four, because each number
                                 // is a kernel of its own
  // True if any lane has rolling friction; is fresh; has a surface velocity; misses a row that others have.
  std::uint8_t has_rolling = 0, has_fresh = 0, has_surface_velocity = 0, has_uneven_points = 0;
  std::int32_t is_settled = 0;  // a solve with resting bodies left all impulses unchanged, and so will
                                // the next
  // Lanes as bits: with a body that cannot move along some axes; with a jointed body; with a body A, B; with a movable body A, B; with friction at its
  // limit; with a row for a point; that are speculative; of these, those that would push; whose arms on A, B move.
  std::uint16_t locked = 0, jointed = 0, has_a = 0, has_b = 0, movable_a = 0, movable_b = 0, slides = 0,
                rows[kMaxManifoldPoints] = {}, speculative = 0, pushing = 0, carried_a = 0, carried_b = 0;
  Vec3W<W> normal, tangent_1, tangent_2;
  // Friction at the centre of pressure.
  Vec3W<W> friction_from_a, friction_from_b;
  Wide<W> inverse_k11, inverse_k12, inverse_k13, inverse_k22, inverse_k23,
      inverse_k33;  // of (tangent_1, tangent_2, twist)
  // Inverse friction coefficients, static and dynamic, and those of the twist (1/m): 0 without friction.
  Wide<W> inverse_friction, inverse_dynamic_friction, inverse_static_twist, inverse_dynamic_twist;
  Wide<W> inverse_mass_a, inverse_mass_b;
  Sym3W<W> inverse_inertia_a, inverse_inertia_b;
  Wide<W> rate, compliance, slop, pushout_speed;
  // Difference between all arms on a body and `arm`: zero for the body whose centre is nearer.
  Vec3W<W> arm_shift_a, arm_shift_b;
  // Impulses of this sub-step, and sums over the step.
  Wide<W> friction_1, friction_2, twist, total_1, total_2;
  Wide<W> impulses[kMaxManifoldPoints], totals[kMaxManifoldPoints];
  PointBlock<W> points[kMaxManifoldPoints];
  Wide<W> inverse_k[10];  // of K, regularised
};
constexpr std::uint16_t all_lanes(int width) { return static_cast<std::uint16_t>((1u << width) - 1u); }

template <int W>
GYRE_INLINE std::uint16_t lane_bits(Mask<W> mask) {
  return static_cast<std::uint16_t>(to_bits(mask));
}

// Velocities of the two bodies of each lane; of B alone if kHasA is false, in blocks where all lanes lie on
// the ground.
template <int W, bool kHasA = true>
struct PairMotion {
  Vec3W<W> linear_a, angular_a, linear_b, angular_b;
};
template <int W>
struct PairMotion<W, false> {
  Vec3W<W> linear_b, angular_b;
};

template <int W>
GYRE_INLINE void load_velocities(float* const (&records)[W], Vec3W<W>& linear, Vec3W<W>& angular) {
  Wide<W> columns[8];
  gather_columns<8, W>(records, kMotionLinear, columns);
  linear = {columns[0], columns[1], columns[2]};
  angular = {columns[3], columns[4], columns[5]};
}
template <int W, bool kHasA = true>
GYRE_INLINE PairMotion<W, kHasA> load_pair(const ContactBlock<W>& block) {
  PairMotion<W, kHasA> pair;
  if constexpr (kHasA) load_velocities<W>(block.read_a, pair.linear_a, pair.angular_a);
  load_velocities<W>(block.read_b, pair.linear_b, pair.angular_b);
  return pair;
}

template <int W>
GYRE_INLINE void store_velocities(float* const (&records)[W], Vec3W<W> linear, Vec3W<W> angular) {
  // Adding zero keeps -0 out of the state: lanes with fewer points than their block add zeros of either sign.
  const Wide<W> zero(0.0f);
  const Wide<W> columns[6] = {linear.x + zero,  linear.y + zero,  linear.z + zero,
                              angular.x + zero, angular.y + zero, angular.z + zero};
  scatter_columns<6, W>(records, kMotionLinear, columns);
}
template <int W, bool kHasA>
GYRE_INLINE void store_pair(ContactBlock<W>& block, const PairMotion<W, kHasA>& pair) {
  if constexpr (kHasA)
    store_velocities<W>(block.movable_a == all_lanes(W) ? block.read_a : block.cold->write_a, pair.linear_a,
                        pair.angular_a);
  store_velocities<W>(block.movable_b == all_lanes(W) ? block.read_b : block.cold->write_b, pair.linear_b,
                      pair.angular_b);
}

template <int W>
GYRE_INLINE Vec3W<W> by_axes(Vec3W<W> a, Vec3W<W> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
// Takes back what an impulse gave along locked axes, `p` times the inverse mass, to the bit if they had no velocity.
template <int W, bool kHasA>
__attribute__((noinline)) void hold_locked_axes(const ContactBlock<W>& block, PairMotion<W, kHasA>& pair,
                                                Vec3W<W> p) {
  const auto locked = Mask<W>::of_bits(block.locked);
  const ContactBlockCold<W>& cold = *block.cold;
  if constexpr (kHasA)
    pair.linear_a = select<W>(locked, pair.linear_a + by_axes<W>(cold.locked_mass_a, p), pair.linear_a);
  pair.linear_b = select<W>(locked, pair.linear_b - by_axes<W>(cold.locked_mass_b, p), pair.linear_b);
}
// How an impulse along u moves the bodies along v by their masses; where no axis is locked, `free` instead.
template <int W>
__attribute__((noinline)) Wide<W> inverse_masses_between(const ContactBlock<W>& block, Vec3W<W> u, Vec3W<W> v,
                                                         Wide<W> free) {
  const ContactBlockCold<W>& cold = *block.cold;
  const auto along = [&](Wide<W> locked_a, Wide<W> locked_b) {
    return (block.inverse_mass_a - locked_a) + (block.inverse_mass_b - locked_b);
  };
  const Vec3W<W> masses{along(cold.locked_mass_a.x, cold.locked_mass_b.x),
                        along(cold.locked_mass_a.y, cold.locked_mass_b.y),
                        along(cold.locked_mass_a.z, cold.locked_mass_b.z)};
  return select(Mask<W>::of_bits(block.locked), dot(u, by_axes<W>(masses, v)), free);
}

// Applies the impulse `p` to B at `from_b` (and -p to A at `from_a`), and the angular impulse `t` to B (and
// -t to A).
template <int W, bool kHasA>
GYRE_INLINE void apply_impulse(const ContactBlock<W>& block, PairMotion<W, kHasA>& pair, Vec3W<W> p,
                               Vec3W<W> from_a, Vec3W<W> from_b, Vec3W<W> t) {
  if constexpr (kHasA) {
    pair.linear_a = pair.linear_a - block.inverse_mass_a * p;
    pair.angular_a = pair.angular_a - block.inverse_inertia_a * (cross(from_a, p) + t);
  }
  pair.linear_b = pair.linear_b + block.inverse_mass_b * p;
  if (block.locked != 0) hold_locked_axes<W, kHasA>(block, pair, p);
  pair.angular_b = pair.angular_b + block.inverse_inertia_b * (cross(from_b, p) + t);
}

// Applies an impulse `p` along the normal; `moment` is the sum of impulses times the arms of their points.
template <int W, bool kHasA>
GYRE_INLINE void apply_normal_impulse(const ContactBlock<W>& block, PairMotion<W, kHasA>& pair, Wide<W> p,
                                      Vec3W<W> moment) {
  if constexpr (kHasA) {
    pair.linear_a = pair.linear_a - (block.inverse_mass_a * p) * block.normal;
    pair.angular_a = pair.angular_a - block.inverse_inertia_a * (moment + p * block.arm_shift_a);
  }
  pair.linear_b = pair.linear_b + (block.inverse_mass_b * p) * block.normal;
  if (block.locked != 0) hold_locked_axes<W, kHasA>(block, pair, p * block.normal);
  pair.angular_b = pair.angular_b + block.inverse_inertia_b * (moment + p * block.arm_shift_b);
}

// Motion of B's points against A's along the normal: a common part, and a rotation that adds for each point.
template <int W>
struct NormalMotion {
  Wide<W> common;
  Vec3W<W> rotation;

  GYRE_INLINE Wide<W> at(const PointBlock<W>& point) const { return common + dot(rotation, point.arm); }
};
// For two bodies, and for one on the static world.
template <int W>
GYRE_INLINE NormalMotion<W> normal_motion(const ContactBlock<W>& block, Vec3W<W> displacement,
                                          Vec3W<W> rotation_a, Vec3W<W> rotation_b) {
  return {dot(displacement, block.normal) +
              (dot(rotation_b, block.arm_shift_b) - dot(rotation_a, block.arm_shift_a)),
          rotation_b - rotation_a};
}
template <int W>
GYRE_INLINE NormalMotion<W> normal_motion(const ContactBlock<W>& block, Vec3W<W> displacement,
                                          Vec3W<W> rotation_b) {
  return {dot(displacement, block.normal) + dot(rotation_b, block.arm_shift_b), rotation_b};
}
template <int W, bool kHasA>
GYRE_INLINE NormalMotion<W> normal_speeds(const ContactBlock<W>& block, const PairMotion<W, kHasA>& pair) {
  if constexpr (kHasA) {
    return normal_motion<W>(block, pair.linear_b - pair.linear_a, pair.angular_a, pair.angular_b);
  } else {
    return normal_motion<W>(block, pair.linear_b, pair.angular_b);
  }
}

// Displacement of a body since the step began.
template <int W>
struct BodyDisplacement {
  Vec3W<W> delta_position, delta_rotation;
  GYRE_INLINE explicit BodyDisplacement(float* const (&records)[W]) {
    Wide<W> columns[8];
    gather_columns<8, W>(records, kMotionDeltaPosition, columns);
    delta_position = {columns[0], columns[1], columns[2]};
    delta_rotation = {columns[3], columns[4], columns[5]};
  }
};

// In sizes of the contact: paths that deviate less from their tangent in a step count as straight. What lies on a turntable then creeps
// outward by 6e-4 sizes a second at most, at 60 steps a second.
constexpr float kMinBend = 1.0e-5f;

// Arms move only so far that the response to an impulse grows by at most this share: rows keep the effective mass of the step's beginning,
// and a larger response feeds on itself. Heaps of ragdolls that met at 40 m/s gained energy without end; with 0.1, one of 40 at 60 m/s still
// gained 13 %, with 0.03 to 0.05 none more than 1e-4.
constexpr float kMaxResponseGrowth = 0.03f;

// How far the arm on a body may move. An impulse along the normal is answered by `rotation` where the body turns, and by `response` in all;
// the root of the former grows with the length of the arm, at most by the root of the largest inverse moment.
template <int W>
GYRE_INLINE Wide<W> find_reach(const Sym3W<W>& inverse_inertia, Wide<W> rotation, Wide<W> response) {
  const Wide<W> most = max(inverse_inertia.xx + inverse_inertia.yy + inverse_inertia.zz, Wide<W>(1.0e-30f));
  const Wide<W> growth = Wide<W>(kMaxResponseGrowth) * response;
  return growth / ((sqrt(rotation + growth) + sqrt(rotation)) * sqrt(most));
}
template <int W>
GYRE_INLINE Vec3W<W> within(Vec3W<W> moved, Wide<W> reach) {
  return (reach / max(max(reach, length(moved)), Wide<W>(1.0e-30f))) * moved;
}

// Finds the lanes in which the body whose centre is farther turns, and carries the other along an arc. `from_a` and `from_b` are the arms
// of one point.
template <int W>
__attribute__((noinline)) void find_carried(ContactBlock<W>& block, Mask<W> nearer_a, Vec3W<W> from_a,
                                            Vec3W<W> from_b, Wide<W> size, float step) {
  const Wide<W> zero(0.0f), half_step_squared(0.5f * step * step);
  const PairMotion<W> pair = load_pair<W>(block);
  const Wide<W> radius = length(from_a - from_b);
  const auto bends = [&](Vec3W<W> spin) {
    return half_step_squared * length_squared(spin) * radius > Wide<W>(kMinBend) * size;
  };
  const auto pairs = Mask<W>::of_bits(std::uint32_t(block.has_a & block.has_b));
  block.carried_a = lane_bits<W>(pairs & ~nearer_a & bends(pair.angular_a));
  block.carried_b = lane_bits<W>(pairs & nearer_a & bends(pair.angular_b));
  block.cold->moved_a = block.cold->moved_b = {zero, zero, zero};
  const Vec3W<W> moment_a = cross(from_a, block.normal), moment_b = cross(from_b, block.normal);
  const Wide<W> of_a = dot(moment_a, block.inverse_inertia_a * moment_a),
                of_b = dot(moment_b, block.inverse_inertia_b * moment_b);
  const Wide<W> response = block.inverse_mass_a + block.inverse_mass_b + of_a + of_b;
  block.cold->reach_a = find_reach<W>(block.inverse_inertia_a, of_a, response);
  block.cold->reach_b = find_reach<W>(block.inverse_inertia_b, of_b, response);
}

// A support that turns carries what lies on it: the point of contact stays where it is on the body whose centre is nearer, and moves over
// the other one, whose arm changes by the motion of the two centres against each other. Both bodies then act at one point, so their
// angular momentum is kept, and the surface has the velocity of the place where the carried body is. Displacements use the mean of the
// arm's first and last value: for two bodies that turn about a common axis they are then right to second order.
template <int W>
__attribute__((noinline)) void move_arms(ContactBlock<W>& block, const PairMotion<W>& pair, float substep) {
  const BodyDisplacement<W> a(block.read_a), b(block.read_b);
  // In the middle of the sub-step, where speeds are taken.
  const Vec3W<W> moved =
      (b.delta_position - a.delta_position) + Wide<W>(0.5f * substep) * (pair.linear_b - pair.linear_a);
  const auto move = [&](std::uint16_t lanes, Vec3W<W> now, Vec3W<W>& before, Vec3W<W>& friction_arm,
                        Vec3W<W>& arm_shift) {
    const auto carried = Mask<W>::of_bits(lanes);
    const Vec3W<W> change = now - before;
    friction_arm = select<W>(carried, friction_arm + change, friction_arm);
    arm_shift = select<W>(carried, arm_shift + cross(change, block.normal), arm_shift);
    before = select<W>(carried, now, before);
  };
  move(block.carried_a, within<W>(moved, block.cold->reach_a), block.cold->moved_a, block.friction_from_a,
       block.arm_shift_a);
  move(block.carried_b, within<W>(-moved, block.cold->reach_b), block.cold->moved_b, block.friction_from_b,
       block.arm_shift_b);
}
// The difference that the mean arm makes to the displacement along the normal.
template <int W>
__attribute__((noinline)) Wide<W> mean_arm_excess(const ContactBlock<W>& block, const BodyDisplacement<W>& a,
                                                  const BodyDisplacement<W>& b) {
  const Vec3W<W> half = Wide<W>(0.5f) * (b.delta_position - a.delta_position);
  const ContactBlockCold<W>& cold = *block.cold;
  const Wide<W> of_a =
                    dot(a.delta_rotation, cross(cold.moved_a - within<W>(half, cold.reach_a), block.normal)),
                of_b =
                    dot(b.delta_rotation, cross(cold.moved_b + within<W>(half, cold.reach_b), block.normal));
  return keep(Mask<W>::of_bits(block.carried_a), of_a) - keep(Mask<W>::of_bits(block.carried_b), of_b);
}

template <int W, bool kHasA>
GYRE_INLINE NormalMotion<W> normal_displacements(const ContactBlock<W>& block) {
  const BodyDisplacement<W> b(block.read_b);
  if constexpr (kHasA) {
    const BodyDisplacement<W> a(block.read_a);
    NormalMotion<W> motion =
        normal_motion<W>(block, b.delta_position - a.delta_position, a.delta_rotation, b.delta_rotation);
    if ((block.carried_a | block.carried_b) != 0)
      motion.common = motion.common + mean_arm_excess<W>(block, a, b);
    return motion;
  } else {
    return normal_motion<W>(block, b.delta_position, b.delta_rotation);
  }
}

// Applies the angular impulse `t` to B (and -t to A).
template <int W, bool kHasA>
GYRE_INLINE void apply_angular_impulse(const ContactBlock<W>& block, PairMotion<W, kHasA>& pair, Vec3W<W> t) {
  if constexpr (kHasA) pair.angular_a = pair.angular_a - block.inverse_inertia_a * t;
  pair.angular_b = pair.angular_b + block.inverse_inertia_b * t;
}

// Velocity of B's material against A's at a point.
template <int W, bool kHasA>
GYRE_INLINE Vec3W<W> relative_velocity(const PairMotion<W, kHasA>& pair, Vec3W<W> from_a, Vec3W<W> from_b) {
  const Vec3W<W> velocity = pair.linear_b + cross(pair.angular_b, from_b);
  if constexpr (kHasA) return velocity - (pair.linear_a + cross(pair.angular_a, from_a));
  return velocity;
}
// Angular velocity of B against A.
template <int W, bool kHasA>
GYRE_INLINE Vec3W<W> relative_spin(const PairMotion<W, kHasA>& pair) {
  if constexpr (kHasA) return pair.angular_b - pair.angular_a;
  return pair.angular_b;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
