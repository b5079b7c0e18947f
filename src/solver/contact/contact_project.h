// Pushout of penetration, once a step, after the bodies have moved. Positions change, velocities do not, so
// no energy results, however deep the penetration. Part of the kernels (one template for every width).
//
// Each manifold removes a share of its penetration beyond the slop by displacements M^-1 J^T x with x >= 0
// (nonlinear projected Gauss-Seidel: J. Jansson, J. Vergeest, 2003; E. Catto, "Iterative Dynamics", 2005).
// The upper body yields (prepare_softness).
#pragma once

#include "solver/contact/contact_kernel.h"
#include "solver/core/error_bounds.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// Projected iterations over the points of a manifold.
constexpr int kProjectionIterations = 8;

// Displacements so far, without those of immovable bodies, whose records hold velocities.
template <int W, bool kHasA>
GYRE_INLINE PairMotion<W, kHasA> displacements(const ContactBlock<W>& block) {
  PairMotion<W, kHasA> pair = load_pair<W, kHasA>(block);
  if constexpr (kHasA) {
    const auto in_a = Mask<W>::of_bits(block.movable_a);
    pair.linear_a = keep<W>(in_a, pair.linear_a), pair.angular_a = keep<W>(in_a, pair.angular_a);
  }
  const auto in_b = Mask<W>::of_bits(block.movable_b);
  pair.linear_b = keep<W>(in_b, pair.linear_b), pair.angular_b = keep<W>(in_b, pair.angular_b);
  return pair;
}

// Effect of a unit impulse at each point on the two bodies (on A only if there is one), and on the
// separations of the points.
template <int W>
struct PushoutResponse {
  Wide<W> inverse_mass_a, inverse_mass_b;
  Vec3W<W> held_a, held_b;  // the effect of a unit impulse along locked axes, which is taken back
  Vec3W<W> angular_a[kMaxManifoldPoints], angular_b[kMaxManifoldPoints];
  Wide<W> k[10];
};

template <int W, bool kHasA>
GYRE_INLINE PushoutResponse<W> pushout_response(const ContactBlock<W>& block) {
  PushoutResponse<W> response;
  response.inverse_mass_b = block.cold->mobility_b * block.inverse_mass_b;
  Wide<W> masses = response.inverse_mass_b;
  if constexpr (kHasA) {
    response.inverse_mass_a = block.cold->mobility_a * block.inverse_mass_a;
    masses = response.inverse_mass_a + masses;
  }
  if (block.locked != 0) {
    const ContactBlockCold<W>& cold = *block.cold;
    response.held_b = by_axes<W>(cold.mobility_b * cold.locked_mass_b, block.normal);
    Wide<W> held = dot(response.held_b, block.normal);
    if constexpr (kHasA) {
      response.held_a = by_axes<W>(cold.mobility_a * cold.locked_mass_a, block.normal);
      held = held + dot(response.held_a, block.normal);
    }
    masses = select(Mask<W>::of_bits(block.locked), max(masses - held, Wide<W>(0.0f)), masses);
  }
  for (int i = 0; i < block.point_count; ++i) {
    const PointBlock<W>& point = block.points[i];
    Vec3W<W> angular = response.angular_b[i] =
        block.cold->mobility_b * (block.inverse_inertia_b * (point.arm + block.arm_shift_b));
    Wide<W> shifted = dot(block.arm_shift_b, angular);
    if constexpr (kHasA) {
      response.angular_a[i] =
          block.cold->mobility_a * (block.inverse_inertia_a * (point.arm + block.arm_shift_a));
      angular = response.angular_a[i] + angular;
      shifted = dot(block.arm_shift_a, response.angular_a[i]) + shifted;
    }
    const Wide<W> common = masses + shifted;
    for (int j = 0; j <= i; ++j) response.k[packed(i, j)] = common + dot(block.points[j].arm, angular);
  }
  return response;
}

// Displacement of the points in the step so far, with the present pushout.
template <int W, bool kHasA>
GYRE_INLINE NormalMotion<W> displacements_so_far(const ContactBlock<W>& block,
                                                 const PairMotion<W, kHasA>& pair) {
  const BodyDisplacement<W> b(block.read_b);
  const Vec3W<W> rotation_b = b.delta_rotation + pair.angular_b;
  if constexpr (kHasA) {
    const BodyDisplacement<W> a(block.read_a);
    NormalMotion<W> motion =
        normal_motion<W>(block, (b.delta_position - a.delta_position) + (pair.linear_b - pair.linear_a),
                         a.delta_rotation + pair.angular_a, rotation_b);
    if ((block.carried_a | block.carried_b) != 0)
      motion.common = motion.common + mean_arm_excess<W>(block, a, b);
    return motion;
  } else {
    return normal_motion<W>(block, b.delta_position + pair.linear_b, rotation_b);
  }
}

// Lanes with a row for a point, without speculative contacts.
template <int W>
GYRE_INLINE Mask<W> pushed_rows(const ContactBlock<W>& block, int point) {
  return Mask<W>::of_bits(std::uint32_t(block.rows[point] & ~block.speculative));
}

// The pushout of each point, or the negative distance by which it may close. False if no lane penetrates.
template <int W, bool kHasA>
GYRE_INLINE bool find_pushouts(const ContactBlock<W>& block, const PairMotion<W, kHasA>& pair, float step,
                               Wide<W>* pushouts) {
  const Wide<W> zero(0.0f);
  const NormalMotion<W> displacements = displacements_so_far<W>(block, pair);
  const Wide<W> max_pushout = block.pushout_speed * Wide<W>(step);
  auto overlaps = zero < zero;
  for (int i = 0; i < block.point_count; ++i) {
    const PointBlock<W>& point = block.points[i];
    const Wide<W> over =
        zero - (point.separation + displacements.at(point) + Wide<W>(float(kPushoutSlopFactor)) * block.slop);
    const auto exists = pushed_rows<W>(block, i);
    const auto deep = (over > zero) & exists;
    overlaps = overlaps | deep;
    pushouts[i] =
        select(exists, select(deep, min(Wide<W>(float(kPushoutShare)) * over, max_pushout), over), zero);
  }
  return any(overlaps);
}

template <int W, bool kHasA>
GYRE_INLINE void project_block(ContactBlock<W>& block, float step) {
  const Wide<W> zero(0.0f);
  PairMotion<W, kHasA> pair = displacements<W, kHasA>(block);
  Wide<W> pushouts[kMaxManifoldPoints];
  if (!find_pushouts<W>(block, pair, step, pushouts)) return;
  const PushoutResponse<W> response = pushout_response<W, kHasA>(block);
  const int count = block.point_count;
  Wide<W> impulses[kMaxManifoldPoints], inverse_diagonal[kMaxManifoldPoints];
  for (int i = 0; i < count; ++i) {
    impulses[i] = zero;
    const Wide<W> k = response.k[packed(i, i)];
    inverse_diagonal[i] = select((k > zero) & pushed_rows<W>(block, i),
                                 Wide<W>(1.0f) / select(k > zero, k, Wide<W>(1.0f)), zero);
  }
  GYRE_ROLLED
  for (int iteration = 0; iteration < kProjectionIterations; ++iteration) {
    auto unchanged = zero == zero;
    for (int i = 0; i < count; ++i) {
      Wide<W> left = pushouts[i];
      for (int j = 0; j < count; ++j) left = left - response.k[packed(i, j)] * impulses[j];
      const Wide<W> now = max(impulses[i] + inverse_diagonal[i] * left, zero);
      unchanged = unchanged & (now == impulses[i]);
      impulses[i] = now;
    }
    // If an iteration changes nothing, the next would not either.
    if (all(unchanged)) break;
  }
  Wide<W> total = zero;
  for (int i = 0; i < count; ++i) {
    total = total + impulses[i];
    if constexpr (kHasA) pair.angular_a = pair.angular_a - impulses[i] * response.angular_a[i];
    pair.angular_b = pair.angular_b + impulses[i] * response.angular_b[i];
  }
  if constexpr (kHasA) pair.linear_a = pair.linear_a - (response.inverse_mass_a * total) * block.normal;
  pair.linear_b = pair.linear_b + (response.inverse_mass_b * total) * block.normal;
  if (block.locked != 0) {
    const auto locked = Mask<W>::of_bits(block.locked);
    if constexpr (kHasA)
      pair.linear_a = select<W>(locked, pair.linear_a + total * response.held_a, pair.linear_a);
    pair.linear_b = select<W>(locked, pair.linear_b - total * response.held_b, pair.linear_b);
  }
  store_pair<W>(block, pair);
}

template <int W>
void project_blocks(void* memory, int begin, int end, float step) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (int i = begin; i < end; ++i) {
    blocks[i].has_a != 0 ? project_block<W, true>(blocks[i], step) : project_block<W, false>(blocks[i], step);
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
