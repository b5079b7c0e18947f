// Pushing apart what overlaps, once a step, after the bodies have moved. Places change, velocities do not: no energy comes
// of it, however deep the overlap. Part of the kernels (one template for every width).
//
// Each manifold asks for a share of its overlap beyond the slop back, by displacements along the least-mass direction
// M^-1 J^T x with x >= 0 (nonlinear projected Gauss-Seidel: J. Jansson, J. Vergeest, 2003; E. Catto, "Iterative Dynamics",
// 2005), whereby the body on top is the one that gives way (prepare_softness).
#pragma once

#include "solver/contact/contact_kernel.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The share of an overlap that is taken back in a step, and the overlap that may stay, as a multiple of the springs' slop.
constexpr float kProjectedShare = 0.4f;
constexpr float kProjectionSlop = 1.5f;
// Projected sweeps over the points of a manifold.
constexpr int kProjectionSweeps = 8;

// Displacements so far, without those of bodies that nothing pushes: their records hold velocities.
template <int W, bool kHasA>
GYRE_INLINE PairMotion<W, kHasA> displacements(const ContactBlock<W>& block) {
  PairMotion<W, kHasA> pair = load_pair<W, kHasA>(block);
  if constexpr (kHasA) {
    const auto in_a = Mask<W>::of_bits(block.pushes_a);
    pair.linear_a = keep<W>(in_a, pair.linear_a), pair.angular_a = keep<W>(in_a, pair.angular_a);
  }
  const auto in_b = Mask<W>::of_bits(block.pushes_b);
  pair.linear_b = keep<W>(in_b, pair.linear_b), pair.angular_b = keep<W>(in_b, pair.angular_b);
  return pair;
}

// What a unit push at each point does to the two bodies (A's part only where there is one), and to the separations of the points.
template <int W>
struct PushResponse {
  Wide<W> inverse_mass_a, inverse_mass_b;
  Vec3W<W> turn_a[kMaxManifoldPoints], turn_b[kMaxManifoldPoints];
  Wide<W> k[10];
};

template <int W, bool kHasA>
GYRE_INLINE PushResponse<W> push_response(const ContactBlock<W>& block) {
  PushResponse<W> response;
  response.inverse_mass_b = block.aside->mobility_b * block.inverse_mass_b;
  Wide<W> masses = response.inverse_mass_b;
  if constexpr (kHasA) {
    response.inverse_mass_a = block.aside->mobility_a * block.inverse_mass_a;
    masses = response.inverse_mass_a + masses;
  }
  for (int i = 0; i < block.point_count; ++i) {
    const PointBlock<W>& point = block.points[i];
    Vec3W<W> turn = response.turn_b[i] =
        block.aside->mobility_b * (block.inverse_inertia_b * (point.arm + block.arm_shift_b));
    Wide<W> shifted = dot(block.arm_shift_b, turn);
    if constexpr (kHasA) {
      response.turn_a[i] = block.aside->mobility_a * (block.inverse_inertia_a * (point.arm + block.arm_shift_a));
      turn = response.turn_a[i] + turn;
      shifted = dot(block.arm_shift_a, response.turn_a[i]) + shifted;
    }
    const Wide<W> common = masses + shifted;
    for (int j = 0; j <= i; ++j) response.k[packed(i, j)] = common + dot(block.points[j].arm, turn);
  }
  return response;
}

// The way of the points so far in the step, and what was pushed already.
template <int W, bool kHasA>
GYRE_INLINE NormalMotion<W> pushed_ways(const ContactBlock<W>& block, const PairMotion<W, kHasA>& pair) {
  const BodyWay<W> b(block.read_b);
  const Vec3W<W> turn_b = b.turned + pair.angular_b;
  if constexpr (kHasA) {
    const BodyWay<W> a(block.read_a);
    return normal_motion<W>(block, (b.moved - a.moved) + (pair.linear_b - pair.linear_a),
                            a.turned + pair.angular_a, turn_b);
  } else {
    return normal_motion<W>(block, b.moved + pair.linear_b, turn_b);
  }
}

// How far each point wants to be pushed; at least minus the way that it may close. False if no lane overlaps.
template <int W, bool kHasA>
GYRE_INLINE bool wanted_pushes(const ContactBlock<W>& block, const PairMotion<W, kHasA>& pair, float step,
                               Wide<W>* target_speed) {
  const Wide<W> zero(0.0f);
  const NormalMotion<W> ways = pushed_ways<W>(block, pair);
  const Wide<W> most = block.push_speed * Wide<W>(step);
  auto overlaps = zero < zero;
  for (int i = 0; i < block.point_count; ++i) {
    const PointBlock<W>& point = block.points[i];
    const Wide<W> over = zero - (point.separation + ways.at(point) + Wide<W>(kProjectionSlop) * block.slop);
    const auto exists = Mask<W>::of_bits(block.rows[i]);
    const auto deep = (over > zero) & exists;
    overlaps = overlaps | deep;
    target_speed[i] = select(exists, select(deep, min(Wide<W>(kProjectedShare) * over, most), over), zero);
  }
  return any(overlaps);
}

template <int W, bool kHasA>
GYRE_INLINE void project_block(ContactBlock<W>& block, float step) {
  const Wide<W> zero(0.0f);
  PairMotion<W, kHasA> pair = displacements<W, kHasA>(block);
  Wide<W> target_speed[kMaxManifoldPoints];
  if (!wanted_pushes<W>(block, pair, step, target_speed)) return;
  const PushResponse<W> response = push_response<W, kHasA>(block);
  const int count = block.point_count;
  Wide<W> pushes[kMaxManifoldPoints], relief[kMaxManifoldPoints];
  for (int i = 0; i < count; ++i) {
    pushes[i] = zero;
    const Wide<W> k = response.k[packed(i, i)];
    relief[i] = select((k > zero) & Mask<W>::of_bits(block.rows[i]),
                       Wide<W>(1.0f) / select(k > zero, k, Wide<W>(1.0f)), zero);
  }
  GYRE_ROLLED
  for (int sweep = 0; sweep < kProjectionSweeps; ++sweep) {
    auto stands = zero == zero;
    for (int i = 0; i < count; ++i) {
      Wide<W> left = target_speed[i];
      for (int j = 0; j < count; ++j) left = left - response.k[packed(i, j)] * pushes[j];
      const Wide<W> now = max(pushes[i] + relief[i] * left, zero);
      stands = stands & (now == pushes[i]);
      pushes[i] = now;
    }
    // What all of them left as it was the next sweep would not change either.
    if (all(stands)) break;
  }
  Wide<W> total = zero;
  for (int i = 0; i < count; ++i) {
    total = total + pushes[i];
    if constexpr (kHasA) pair.angular_a = pair.angular_a - pushes[i] * response.turn_a[i];
    pair.angular_b = pair.angular_b + pushes[i] * response.turn_b[i];
  }
  if constexpr (kHasA) pair.linear_a = pair.linear_a - (response.inverse_mass_a * total) * block.normal;
  pair.linear_b = pair.linear_b + (response.inverse_mass_b * total) * block.normal;
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
