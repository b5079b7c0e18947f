// What is known of the stops and servos of a bundle of linkages while solver/articulation/articulation_limits_kernel.h solves them, and how much room that takes.
#pragma once

#include "solver/articulation/articulation_block.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The stops at either end of an axis: x are the impulses found, beyond those that the axis has. Behind all of them stand the servos, whose
// impulse is that of the low end, of either sign.
template <int W>
struct WideLimit {
  Wide<W> speed, low_bias, high_bias, low_x, high_x;
  Mask<W> low_on, high_on;
  WideLimitAxis<W>* axis;
  const LaneNode* node;
  bool has_low;  // a swing has only the other one
  // Lanes, a bit for each: that have it in question, and in which the ways between it and all others so marked are kept.
  std::uint32_t active, cached;
  bool has_response;        // it is known what an impulse makes of the linkage, in this part of the sub-step
  bool has_reach;           // it is known which columns that impulse reaches
  bool has_spins;           // the next are known, in this part of the sub-step
  Vec3W<W> spin_a, spin_b;  // how an impulse of one turns its two bodies
  Vec3W<W> cached_axis;      // in a's axes: the axis for which ways are kept
};

// One end of a stop, in each lane another.
template <int W>
struct LimitSlot {
  Wide<W> excess;       // rad/s: by how much its speed towards the inside is more than what is asked
  Wide<W> share;        // impulse for each rad/s of that, not positive
  Wide<W> min_impulse, room;  // least: of the impulse, room: from there to where it is, both not positive
  // Only in bundles with servos: how far it may grow; `room` is what has been given there, since bounds may be far beyond that.
  Wide<W> max_impulse;
};

// For which slots of each lane the ways are laid out, and lanes, a bit for each, in which they have been found anew since. Up to
// `cleared` slots there is nothing else.
template <int W>
struct LimitDelassus {
  alignas(Wide<W>) std::uint32_t counts[W];
  std::uint32_t renewed, cleared;
};

constexpr float kUnboundedImpulse = 3.0e38f;  // how far a stop's impulse may grow

// As many slots stand in registers while they are swept.
constexpr std::uint32_t kRegisterSlots = 8;

template <int W>
constexpr std::size_t max_slots(const ArticulationBundle& bundle) {
  return bundle.limit_count > kRegisterSlots / 2 ? 2 * std::size_t(bundle.limit_count) : kRegisterSlots;
}

// Of all stops together; what lies behind these words is aligned as vectors are.
constexpr std::size_t all_reach_words(const ArticulationBundle& bundle) {
  constexpr std::size_t kWords = 64 / sizeof(std::uint64_t);
  return (bundle.limit_count * reach_words(bundle.column_count) + kWords - 1) / kWords * kWords;
}

template <int W>
constexpr std::size_t limit_room(const ArticulationBundle& bundle) {
  const std::size_t n = bundle.limit_count, slots = max_slots<W>(bundle);
  if (n == 0) return 0;
  return n * (sizeof(WideLimit<W>) + n * (sizeof(Wide<W>) + sizeof(std::uint32_t)) +
              bundle.row_count * 2 * W * sizeof(float)) +
         all_reach_words(bundle) * sizeof(std::uint64_t) + bundle.node_count * sizeof(QuatW<W>) +
         bundle.moving_count * sizeof(Vec3W<W>) + sizeof(LimitDelassus<W>) +
         slots * (sizeof(LimitSlot<W>) + slots * sizeof(Wide<W>) + 2 * W);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
