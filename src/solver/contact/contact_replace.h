// Replaces one lane of a contact block within a step: a speculative contact whose manifold was found anew. Part of the kernels
// (one template for every width).
//
// The lane is prepared and solved in a block of its own, since the other lanes of its block have been solved already, and then
// takes its place there.
#pragma once

#include "solver/contact/contact_prepare.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

template <int W>
int find_pushing_block(void* memory, int begin, int end, std::uint32_t& lanes) {
  auto* blocks = static_cast<ContactBlock<W>*>(memory);
  for (; begin < end; ++begin) {
    if (blocks[begin].pushing == 0) continue;
    lanes = blocks[begin].pushing;
    blocks[begin].pushing = 0;
    break;
  }
  return begin;
}

// Copies one lane of `count` vectors, one after the other in memory.
template <int W, class T>
void copy_lane(const T& from, T& to, int lane) {
  constexpr std::size_t kBytes = sizeof(T), kVector = sizeof(Wide<W>);
  static_assert(kBytes % kVector == 0);
  const auto* source = reinterpret_cast<const float*>(&from) + lane;
  auto* target = reinterpret_cast<float*>(&to) + lane;
  for (std::size_t i = 0; i < kBytes / kVector; ++i) target[std::size_t(W) * i] = source[std::size_t(W) * i];
}

template <int W>
void copy_cold_lane(const ContactBlockCold<W>& from, ContactBlockCold<W>& to, int lane) {
  const auto copy = [lane](const auto& source, auto& target) { copy_lane<W>(source, target, lane); };
  copy(from.slide_mass, to.slide_mass), copy(from.twist_radius, to.twist_radius);
  copy(from.surface_1, to.surface_1), copy(from.surface_2, to.surface_2);
  copy(from.k, to.k), copy(from.inverse_diagonal, to.inverse_diagonal);
  copy(from.fresh, to.fresh);
  copy(from.mobility_a, to.mobility_a), copy(from.mobility_b, to.mobility_b);
  copy(from.rolling_friction, to.rolling_friction), copy(from.rolling_mass, to.rolling_mass);
  copy(from.rolling, to.rolling);
}

// The bodies of the lane stay, and so do their masses.
template <int W>
void copy_block_lane(const ContactBlock<W>& from, ContactBlock<W>& to, int lane) {
  const auto copy = [lane](const auto& source, auto& target) { copy_lane<W>(source, target, lane); };
  const auto copy_bit = [lane](std::uint16_t source, std::uint16_t& target) {
    const unsigned bit = 1u << lane;
    target = static_cast<std::uint16_t>((target & ~bit) | (source & bit));
  };
  copy(from.normal, to.normal), copy(from.tangent_1, to.tangent_1), copy(from.tangent_2, to.tangent_2);
  copy(from.friction_from_a, to.friction_from_a), copy(from.friction_from_b, to.friction_from_b);
  copy(from.inverse_k11, to.inverse_k11), copy(from.inverse_k12, to.inverse_k12),
      copy(from.inverse_k13, to.inverse_k13);
  copy(from.inverse_k22, to.inverse_k22), copy(from.inverse_k23, to.inverse_k23),
      copy(from.inverse_k33, to.inverse_k33);
  copy(from.inverse_friction, to.inverse_friction),
      copy(from.inverse_dynamic_friction, to.inverse_dynamic_friction);
  copy(from.inverse_static_twist, to.inverse_static_twist),
      copy(from.inverse_dynamic_twist, to.inverse_dynamic_twist);
  copy(from.rate, to.rate), copy(from.compliance, to.compliance);
  copy(from.slop, to.slop), copy(from.pushout_speed, to.pushout_speed);
  copy(from.arm_shift_a, to.arm_shift_a), copy(from.arm_shift_b, to.arm_shift_b);
  copy(from.friction_1, to.friction_1), copy(from.friction_2, to.friction_2), copy(from.twist, to.twist);
  copy(from.total_1, to.total_1), copy(from.total_2, to.total_2);
  copy(from.impulses, to.impulses), copy(from.totals, to.totals);
  copy(from.points, to.points), copy(from.inverse_k, to.inverse_k);
  copy_bit(from.slides, to.slides);
  for (int k = 0; k < kMaxManifoldPoints; ++k) copy_bit(from.rows[k], to.rows[k]);
  copy_bit(0, to.speculative);
  // Its arms are those of the impact already.
  copy_bit(0, to.carried_a), copy_bit(0, to.carried_b);
  to.has_rolling |= from.has_rolling, to.has_surface_velocity |= from.has_surface_velocity;
  copy_cold_lane<W>(*from.cold, *to.cold, lane);
}

// Makes room for more points: the other lanes miss them.
template <int W>
void add_missing_points(ContactBlock<W>& block, int count) {
  const Wide<W> zero(0.0f);
  for (int k = block.point_count; k < count; ++k) {
    block.points[k] = {{zero, zero, zero}, zero, zero};
    block.impulses[k] = block.totals[k] = block.cold->inverse_diagonal[k] = zero;
    block.rows[k] = 0;
    for (int i = 0; i <= k; ++i) block.cold->k[packed(i, k)] = block.inverse_k[packed(i, k)] = zero;
  }
  if (count > block.point_count) block.point_count = count;
}

template <int W>
void solve_lane_anew(void* memory, int index, int lane, const ContactConstraint& constraint,
                     ContactBodies bodies, const ContactSettings& settings) {
  ContactBlock<W>& block = static_cast<ContactBlock<W>*>(memory)[index];
  ContactBlockCold<W> cold{};
  ContactBlock<W> own{};
  own.cold = &cold;
  std::uint32_t order[W];
  for (std::uint32_t& each : order) each = 0xffffffffu;
  order[lane] = 0;
  prepare_block<W>(own, &constraint, order, bodies, settings);
  own.speculative = own.carried_a = own.carried_b = 0;
  own.has_a != 0 ? solve_block<W, true>(own, settings.substep) : solve_block<W, false>(own, settings.substep);
  add_missing_points<W>(block, constraint.point_count == 3 ? 4 : constraint.point_count);
  copy_block_lane<W>(own, block, lane);
  mark_uneven_points<W>(block);
  block.is_settled = 0;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
