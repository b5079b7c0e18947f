// The contact kernels: prepare, warm start, solve, project and finish, one template for every width. Lane i
// of a block computes exactly what a block of width 1 would, so the width never changes a bit.
//
// A manifold has up to four normal rows and one friction row triple at the centre of pressure: two tangents
// and the twist about the normal. An ellipsoid bounds the three together (S. Goyal, A. Ruina, J.
// Papadopoulos, "Planar sliding with dry friction", 1991; R. Howe, M. Cutkosky, 1996); it couples sliding
// with spinning like a patch of uniform pressure. Normal rows are soft springs (after E. Catto, "Soft
// Constraints", 2011) that stiffen with age and adapt to their mean load: docs/decisions/contact-softness.md.
// Pushout removes penetration apart from velocities (contact_project.h). The normal rows of a manifold are
// solved together: one after the other they would set every box rocking.
//
// Separation of a point: s = separation + n . (delta_b - delta_a + rotation_b x r_b - rotation_a x r_a),
// first order on purpose: the contact of a rolling ball does not rise with the material that was there.
#pragma once

#include "solver/contact/contact_pair.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The highest speed with which springs remove penetration, as a share of the pushout speed: unlike pushout,
// springs add momentum.
constexpr float kSpringSpeed = 0.125f;
// Penetration in slops (three tenths of the inner radius of the smaller body) from which a point of a jointed
// body is deep, and the share of its impulse that it then loses in a second. A head on the wrong side of a
// chest cannot return without passing it, and the neck would press it on the chest ever harder.
constexpr float kDeepPenetrationSlops = 750.0f, kDeepPenetrationLeak = 2.0f;
// Projected iterations over the points of a manifold with tensile points.
constexpr int kTensionIterations = 6;

template <int W, bool kHasA>
GYRE_INLINE void warm_start_block(ContactBlock<W>& block) {
  PairMotion<W, kHasA> pair = load_pair<W, kHasA>(block);
  Wide<W> total = block.impulses[0];
  Vec3W<W> angular_sum = total * block.points[0].arm;
  for (int k = 1; k < block.point_count; ++k) {
    total = total + block.impulses[k];
    angular_sum = angular_sum + block.impulses[k] * block.points[k].arm;
  }
  apply_normal_impulse<W>(block, pair, total, angular_sum);
  apply_impulse<W>(block, pair, block.friction_1 * block.tangent_1 + block.friction_2 * block.tangent_2,
                   block.friction_from_a, block.friction_from_b, block.twist * block.normal);
  if (block.has_rolling != 0) apply_angular_impulse<W>(block, pair, block.cold->rolling);
  store_pair<W>(block, pair);
}

template <int W>
void warm_start_blocks(void* memory, int begin, int end) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    blocks[i].has_a != 0 ? warm_start_block<W, true>(blocks[i]) : warm_start_block<W, false>(blocks[i]);
  }
}

// N s: below this there is no load. The square of its inverse is still a float; a load that dies away passes
// all of them down to zero.
constexpr float kMinLoad = 1.0e-18f;

// Sum of the normal impulses of a manifold.
template <int W>
GYRE_INLINE Wide<W> normal_load(const ContactBlock<W>& block) {
  Wide<W> load = block.impulses[0];
  for (int k = 1; k < block.point_count; ++k) load = load + block.impulses[k];
  return load;
}

// Friction: the impulse that stops the slip, clamped to the ellipsoid of the load.
template <int W, bool kHasA>
GYRE_INLINE void solve_friction(ContactBlock<W>& block, PairMotion<W, kHasA>& pair) {
  const Wide<W> zero = Wide<W>(0.0f);
  const Wide<W> one = Wide<W>(1.0f);
  const Wide<W> load = normal_load<W>(block);
  const auto loaded = load > Wide<W>(kMinLoad);
  if (none(loaded) && none((block.friction_1 != zero) | (block.friction_2 != zero) | (block.twist != zero))) {
    block.slides = 0;
    return;
  }
  const Vec3W<W> slip = relative_velocity<W>(pair, block.friction_from_a, block.friction_from_b);
  Wide<W> v1 = dot(slip, block.tangent_1), v2 = dot(slip, block.tangent_2);
  if (block.has_surface_velocity != 0) v1 = v1 - block.cold->surface_1, v2 = v2 - block.cold->surface_2;
  const Wide<W> v3 = dot(relative_spin<W>(pair), block.normal);

  // Sticking: all three rows at once.
  Wide<W> f1 = block.friction_1 - (block.inverse_k11 * v1 + block.inverse_k12 * v2 + block.inverse_k13 * v3);
  Wide<W> f2 = block.friction_2 - (block.inverse_k12 * v1 + block.inverse_k22 * v2 + block.inverse_k23 * v3);
  Wide<W> f3 = block.twist - (block.inverse_k13 * v1 + block.inverse_k23 * v2 + block.inverse_k33 * v3);

  // Use of the limit: 1 is on the ellipsoid. Without load there is no friction.
  const auto was_sliding = Mask<W>::of_bits(block.slides);
  const Wide<W> per_load = select(loaded, one / select(loaded, load, one), zero);
  const Wide<W> inverse_limit =
      select(was_sliding, block.inverse_dynamic_friction, block.inverse_friction) * per_load;
  const Wide<W> inverse_twist_limit =
      select(was_sliding, block.inverse_dynamic_twist, block.inverse_static_twist) * per_load;
  const Wide<W> use = (f1 * f1 + f2 * f2) * (inverse_limit * inverse_limit) +
                      (f3 * f3) * (inverse_twist_limit * inverse_twist_limit);
  const auto sticks = (use <= one) | ~loaded;

  if (!all(sticks)) {
    // Sliding: a step along the slip, equal in every direction, then clamped to the ellipsoid.
    const Wide<W> g1 = block.friction_1 - block.cold->slide_mass * v1;
    const Wide<W> g2 = block.friction_2 - block.cold->slide_mass * v2;
    const Wide<W> g3 =
        block.twist - block.cold->slide_mass * (block.cold->twist_radius * block.cold->twist_radius) * v3;
    const Wide<W> inverse_slide_friction = block.inverse_dynamic_friction * per_load;
    const Wide<W> inverse_slide_twist = block.inverse_dynamic_twist * per_load;
    const Wide<W> use_of_limit = (g1 * g1 + g2 * g2) * (inverse_slide_friction * inverse_slide_friction) +
                                 (g3 * g3) * (inverse_slide_twist * inverse_slide_twist);
    const Wide<W> scale = select(use_of_limit > one, one / sqrt(use_of_limit), one);
    f1 = select(sticks, f1, g1 * scale);
    f2 = select(sticks, f2, g2 * scale);
    f3 = select(sticks, f3, g3 * scale);
  }
  f1 = keep(inverse_limit > zero, f1);
  f2 = keep(inverse_limit > zero, f2);
  f3 = keep(inverse_twist_limit > zero, f3);
  block.slides = lane_bits<W>(~sticks);

  const Wide<W> d1 = f1 - block.friction_1;
  const Wide<W> d2 = f2 - block.friction_2;
  const Wide<W> d3 = f3 - block.twist;
  block.friction_1 = f1;
  block.friction_2 = f2;
  block.twist = f3;
  apply_impulse<W>(block, pair, d1 * block.tangent_1 + d2 * block.tangent_2, block.friction_from_a,
                   block.friction_from_b, d3 * block.normal);
}

// Rolling friction: a torque against relative rotation, at most rolling_friction times the load.
template <int W, bool kHasA>
GYRE_INLINE void solve_rolling(ContactBlock<W>& block, PairMotion<W, kHasA>& pair) {
  const Wide<W> zero = Wide<W>(0.0f);
  const Wide<W> one = Wide<W>(1.0f);
  const Vec3W<W> spin = relative_spin<W>(pair);
  const Vec3W<W> roll = spin - dot(spin, block.normal) * block.normal;
  const Vec3W<W> target = block.cold->rolling - block.cold->rolling_mass * roll;
  const Wide<W> limit = block.cold->rolling_friction * normal_load<W>(block);
  const Wide<W> size = sqrt(dot(target, target));
  const Wide<W> scale = select(size > limit, limit / select(size > zero, size, one), one);
  // A lane without rolling friction must get the bits of a block without it, even where `target` overflows.
  const auto has_rolling = block.cold->rolling_friction > zero;
  const Vec3W<W> bounded = scale * target;
  const Vec3W<W> next{select(has_rolling, bounded.x, zero), select(has_rolling, bounded.y, zero),
                      select(has_rolling, bounded.z, zero)};
  apply_angular_impulse<W>(block, pair, next - block.cold->rolling);
  block.cold->rolling = next;
}

// Projected iterations for the impulses of lanes with tensile points, into `next`; other lanes stay. They
// start from the accumulated impulses: the clamped answer of the block is too strong, and piles would shake.
template <int W, int Count>
GYRE_INLINE void iterate_manifold_points(const ContactBlockCold<W>& cold, const Wide<W>* residual,
                                         const Wide<W>* accumulated, Mask<W> tensile, Wide<W>* next) {
  const Wide<W> zero(0.0f), one(1.0f);
  Wide<W> tried[Count], change[Count];
  GYRE_UNROLL
  for (int i = 0; i < Count; ++i) {
    tried[i] = max(accumulated[i], zero);
    change[i] = tried[i] - accumulated[i];
  }
  GYRE_ROLLED
  for (int iteration = 0; iteration < kTensionIterations; ++iteration) {
    auto unchanged = one > zero;
    GYRE_UNROLL
    for (int i = 0; i < Count; ++i) {
      Wide<W> speed = residual[i];
      GYRE_UNROLL
      for (int j = 0; j < Count; ++j) speed = speed + cold.k[packed(i, j)] * change[j];
      const Wide<W> now = max(tried[i] - cold.inverse_diagonal[i] * speed, zero);
      unchanged = unchanged & (now == tried[i]);
      tried[i] = now;
      change[i] = now - accumulated[i];
    }
    // If an iteration changes nothing in these lanes, the next would not either. Other lanes do not matter.
    if (none(and_not(tensile, unchanged))) break;
  }
  GYRE_UNROLL
  for (int i = 0; i < Count; ++i) next[i] = select(tensile, tried[i], next[i]);
}

// Holds back the impulses of speculative lanes, and marks those that would push; the last solution counts.
template <int W, int Count>
__attribute__((noinline)) void hold_speculative(ContactBlock<W>& block, Wide<W> (&next)[Count]) {
  const Wide<W> zero(0.0f);
  auto pushes = next[0] > zero;
  for (int i = 1; i < Count; ++i) pushes = pushes | (next[i] > zero);
  block.pushing = std::uint16_t(lane_bits<W>(pushes) & block.speculative);
  const auto held = Mask<W>::of_bits(block.speculative);
  for (int i = 0; i < Count; ++i) next[i] = select(held, zero, next[i]);
}

// The normal rows of a manifold, solved together as a small complementarity problem: first as if all points
// were in compression (all alike: no order, no rocking), then, if some are tensile, by projected iterations
// on the impulses. Soft: the spring draws its points to a penetration of `slop`, from both sides, and yields
// to load beyond the mean. Rigid: only approach is stopped, and the speed from springs is removed under load.
template <int W, bool kSprung, int Count, bool kHasA>
GYRE_INLINE void solve_points(ContactBlock<W>& block, PairMotion<W, kHasA>& pair, float substep) {
  const Wide<W> zero(0.0f), one(1.0f), rate(1.0f / substep);
  const NormalMotion<W> displacements = normal_displacements<W, kHasA>(block),
                        speeds = normal_speeds<W>(block, pair);
  const Wide<W> deep_separation = Wide<W>(-kDeepPenetrationSlops) * block.slop;
  const Wide<W> leak(1.0f / (1.0f + kDeepPenetrationLeak * substep));
  Wide<W> residual[Count];     // speed that the row removes
  Wide<W> accumulated[Count];  // the accumulated impulse, minus the yield of the spring
  GYRE_UNROLL
  for (int i = 0; i < Count; ++i) {
    const PointBlock<W>& point = block.points[i];
    const Wide<W> separation = point.separation + displacements.at(point);
    const Wide<W> speed = speeds.at(point);
    const auto apart = separation > zero;
    if constexpr (kSprung) {
      const Wide<W> bias = (separation + block.slop) * block.rate;
      const Wide<W> fastest = zero - Wide<W>(kSpringSpeed) * block.pushout_speed;
      const auto is_capped = bias < fastest;
      residual[i] = speed + select(apart, separation * rate + block.slop * block.rate, max(bias, fastest));
      // Where the speed is capped, the yield shrinks by the same share: the spring still carries its load.
      const Wide<W> share =
          any(is_capped) ? select(is_capped, fastest / select(is_capped, bias, one), one) : one;
      // The yield of a point fades while it separates.
      const Wide<W> near = max(block.slop - max(separation, zero), zero);
      accumulated[i] = block.impulses[i] -
                       (block.compliance * near) * share * max(block.impulses[i] - point.mean_impulse, zero);
      if (block.jointed != 0) {
        accumulated[i] = select(Mask<W>::of_bits(block.jointed) & (separation < deep_separation),
                                leak * accumulated[i], accumulated[i]);
      }
    } else {
      // A separated point may be released but never pulled: that would brake a body about to land.
      const Wide<W> excess = select(block.impulses[i] > zero, max(speed + separation * rate, zero), zero);
      residual[i] = select(apart, excess, speed);
      accumulated[i] = block.impulses[i];
    }
    // A missing point of a lane must stay out of the sums even where speeds overflow: 0 times infinity would
    // not be a number, and a block of the lane alone would not have it.
    if (block.has_uneven_points != 0) residual[i] = keep(Mask<W>::of_bits(block.rows[i]), residual[i]);
  }
  Wide<W> next[Count];
  auto tensile = one < zero;
  GYRE_UNROLL
  for (int i = 0; i < Count; ++i) {
    Wide<W> change = block.inverse_k[packed(i, 0)] * residual[0];
    GYRE_UNROLL
    for (int j = 1; j < Count; ++j) change = change + block.inverse_k[packed(i, j)] * residual[j];
    const Wide<W> target = accumulated[i] - change;
    tensile = tensile | (target < zero);
    next[i] = max(target, zero);
  }
  if (Count > 1 && any(tensile))
    iterate_manifold_points<W, Count>(*block.cold, residual, accumulated, tensile, next);
  if (block.speculative != 0) hold_speculative<W, Count>(block, next);
  Wide<W> total = next[0] - block.impulses[0];
  Vec3W<W> angular_sum = total * block.points[0].arm;
  block.impulses[0] = next[0];
  GYRE_UNROLL
  for (int i = 1; i < Count; ++i) {
    const Wide<W> change = next[i] - block.impulses[i];
    block.impulses[i] = next[i];
    total = total + change;
    angular_sum = angular_sum + change * block.points[i].arm;
  }
  apply_normal_impulse<W>(block, pair, total, angular_sum);
}

template <int W, bool kSprung, bool kHasA>
GYRE_INLINE void solve_normals(ContactBlock<W>& block, PairMotion<W, kHasA>& pair, float substep) {
  switch (block.point_count) {
    case 1:
      return solve_points<W, kSprung, 1>(block, pair, substep);
    case 2:
      return solve_points<W, kSprung, 2>(block, pair, substep);
    default:
      return solve_points<W, kSprung, 4>(block, pair, substep);
  }
}

// New contacts: friction has no load to bound it, so the normals are solved first once.
template <int W>
GYRE_INLINE void apply_new_contact_impulse(ContactBlock<W>& block, PairMotion<W>& pair, float substep) {
  const auto fresh = block.cold->fresh > Wide<W>(0.0f);
  const PairMotion<W> old = pair;
  Wide<W> impulses[kMaxManifoldPoints];
  for (int k = 0; k < block.point_count; ++k) impulses[k] = block.impulses[k];
  const Wide<W> friction_1 = block.friction_1, friction_2 = block.friction_2, twist = block.twist;
  const std::uint32_t slides = block.slides;
  solve_normals<W, true>(block, pair, substep);
  solve_friction<W>(block, pair);
  for (int k = 0; k < block.point_count; ++k) {
    block.impulses[k] = select(fresh, block.impulses[k], impulses[k]);
  }
  block.friction_1 = select(fresh, block.friction_1, friction_1);
  block.friction_2 = select(fresh, block.friction_2, friction_2);
  block.twist = select(fresh, block.twist, twist);
  block.slides = static_cast<std::uint16_t>((block.slides & to_bits(fresh)) | (slides & ~to_bits(fresh)));
  block.has_fresh = 0;
  pair.linear_a = select<W>(fresh, pair.linear_a, old.linear_a);
  pair.angular_a = select<W>(fresh, pair.angular_a, old.angular_a);
  pair.linear_b = select<W>(fresh, pair.linear_b, old.linear_b);
  pair.angular_b = select<W>(fresh, pair.angular_b, old.angular_b);
}

// The part before friction and normals. It is a function of its own that loads the bodies itself, so the
// others may keep them in registers. Few contacts come here, so blocks without a body A are treated as if
// they had one.
template <int W>
__attribute__((noinline)) PairMotion<W> begin_pair(ContactBlock<W>& block, float substep) {
  PairMotion<W> pair = load_pair<W>(block);
  if (block.has_fresh != 0) apply_new_contact_impulse<W>(block, pair, substep);
  if (block.has_rolling != 0) solve_rolling<W>(block, pair);
  return pair;
}

// The part of a pair for blocks in which no lane has a body A.
template <bool kHasA, int W>
GYRE_INLINE PairMotion<W, kHasA> reduce_pair(const PairMotion<W>& pair) {
  if constexpr (kHasA) {
    return pair;
  } else {
    return {pair.linear_b, pair.angular_b};
  }
}

// True if nothing moves, to the bit, so that a block has one answer.
template <int W>
GYRE_INLINE WideInt<W> all_bits(Vec3W<W> v) {
  return bit_pattern(v.x) | bit_pattern(v.y) | bit_pattern(v.z);
}
template <int W, bool kHasA>
GYRE_INLINE bool is_still(const PairMotion<W, kHasA>& pair) {
  WideInt<W> bits = all_bits<W>(pair.linear_b) | all_bits<W>(pair.angular_b);
  if constexpr (kHasA) bits = bits | all_bits<W>(pair.linear_a) | all_bits<W>(pair.angular_a);
  return all(bits == WideInt<W>(0));
}
// True if the bodies have not moved since the step began.
template <int W, bool kHasA>
GYRE_INLINE bool is_undisplaced(const ContactBlock<W>& block) {
  const BodyDisplacement<W> b(block.read_b);
  WideInt<W> bits = all_bits<W>(b.delta_position) | all_bits<W>(b.delta_rotation);
  if constexpr (kHasA) {
    const BodyDisplacement<W> a(block.read_a);
    bits = bits | all_bits<W>(a.delta_position) | all_bits<W>(a.delta_rotation);
  }
  return all(bits == WideInt<W>(0));
}

// The impulses that a block without rolling friction keeps between sub-steps.
template <int W>
struct SavedImpulses {
  Wide<W> points[kMaxManifoldPoints], friction_1, friction_2, twist;
  std::uint32_t slides;

  GYRE_INLINE void save(const ContactBlock<W>& block) {
    for (int k = 0; k < block.point_count; ++k) points[k] = block.impulses[k];
    friction_1 = block.friction_1, friction_2 = block.friction_2, twist = block.twist, slides = block.slides;
  }
  // To the bit.
  GYRE_INLINE bool equal(const ContactBlock<W>& block) const {
    const auto change = [](Wide<W> a, Wide<W> b) { return bit_pattern(a) ^ bit_pattern(b); };
    WideInt<W> bits = change(friction_1, block.friction_1) | change(friction_2, block.friction_2) |
                      change(twist, block.twist);
    for (int k = 0; k < block.point_count; ++k) bits = bits | change(points[k], block.impulses[k]);
    return slides == block.slides && all(bits == WideInt<W>(0));
  }
};

// Normals come last, so that the final velocities close nowhere; an error of the slip does no harm.
template <int W, bool kHasA>
GYRE_INLINE void solve_block(ContactBlock<W>& block, float substep) {
  const bool begins = (block.has_fresh | block.has_rolling) != 0;
  PairMotion<W, kHasA> pair =
      begins ? reduce_pair<kHasA>(begin_pair<W>(block, substep)) : load_pair<W, kHasA>(block);
  if constexpr (kHasA) {
    if ((block.carried_a | block.carried_b) != 0) move_arms<W>(block, pair, substep);
  }
  const bool still = !begins && is_still<W>(pair) && is_undisplaced<W, kHasA>(block);
  if (!still || block.is_settled == 0) {
    SavedImpulses<W> saved;
    if (still) saved.save(block);
    solve_friction<W>(block, pair);
    solve_normals<W, true>(block, pair, substep);
    store_pair<W>(block, pair);
    block.is_settled = still && is_still<W>(pair) && saved.equal(block) ? 1 : 0;
  }
  for (int k = 0; k < block.point_count; ++k) block.totals[k] = block.totals[k] + block.impulses[k];
  block.total_1 = block.total_1 + block.friction_1;
  block.total_2 = block.total_2 + block.friction_2;
}

template <int W>
void solve_blocks(void* memory, int begin, int end, float substep) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  // At width 1, too: where an impulse times an arm overflows, the zero inverse inertia of a missing body A makes it no number.
  for (int i = begin; i < end; ++i)
    blocks[i].has_a != 0 ? solve_block<W, true>(blocks[i], substep)
                         : solve_block<W, false>(blocks[i], substep);
}

// Another iteration in the same half-step, whose impulses take the place of the last.
template <int W>
void solve_blocks_again(void* memory, int begin, int end, float substep) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    ContactBlock<W>& block = blocks[i];
    for (int k = 0; k < block.point_count; ++k) block.totals[k] = block.totals[k] - block.impulses[k];
    block.total_1 = block.total_1 - block.friction_1;
    block.total_2 = block.total_2 - block.friction_2;
    solve_blocks<W>(memory, i, i + 1, substep);
  }
}

// Runs once at the end of a step, so blocks without body A are treated as if they had one.
template <int W>
GYRE_INLINE void relax_block(ContactBlock<W>& block, float substep) {
  PairMotion<W> pair = load_pair<W>(block);
  const Wide<W> friction_1 = block.friction_1, friction_2 = block.friction_2;
  Wide<W> impulses[kMaxManifoldPoints];
  for (int k = 0; k < block.point_count; ++k) impulses[k] = block.impulses[k];
  if (block.has_rolling != 0) solve_rolling<W>(block, pair);
  solve_friction<W>(block, pair);
  solve_normals<W, false>(block, pair, substep);
  for (int k = 0; k < block.point_count; ++k) {
    block.totals[k] = block.totals[k] + (block.impulses[k] - impulses[k]);
  }
  block.total_1 = block.total_1 + (block.friction_1 - friction_1);
  block.total_2 = block.total_2 + (block.friction_2 - friction_2);
  store_pair<W>(block, pair);
}

template <int W>
void relax_blocks(void* memory, int begin, int end, float substep) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) relax_block<W>(blocks[i], substep);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
