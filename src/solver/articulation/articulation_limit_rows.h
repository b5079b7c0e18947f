// Data of the limits and servos of a bundle in solver/articulation/articulation_limits_kernel.h, and their
// size.
#pragma once

#include "solver/articulation/articulation_block.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The limits at both ends of an axis; x are the impulses found beyond those of the axis. Servos follow the
// limits; their impulse is that of the low end, of either sign.
template <int W>
struct WideLimit {
  Wide<W> speed, low_bias, high_bias, low_x, high_x;
  Mask<W> low_on, high_on;
  WideLimitAxis<W>* axis;
  const LaneNode* node;
  bool has_low;  // a swing has only a high end
  // Bits of lanes: in which it is active, and in which its Delassus entries with all others so marked are
  // cached.
  std::uint32_t active, cached;
  bool has_response;        // the response is known in this half step
  bool has_reach;           // the columns of its response are known
  bool has_spins;           // the spins are known in this half step
  Vec3W<W> spin_a, spin_b;  // spins of its two bodies for an impulse of one
  Vec3W<W> cached_axis;     // in a's axes: the axis of the cached entries
};

// One end of a limit; each lane may hold another.
template <int W>
struct LimitSlot {
  Wide<W> excess;       // rad/s: speed towards the inside beyond the bias
  Wide<W> share;        // impulse for each rad/s of that, not positive
  Wide<W> min_impulse, room;  // min_impulse: lower bound; room: from there to the present impulse; both not
                              // positive
  // Only in bundles with servos: upper bound; `room` is then the impulse so far, since bounds may be far
  // beyond it.
  Wide<W> max_impulse;
};

// The layout of Delassus entries by slots, and bits of lanes with newer entries. Slots up to `cleared` have
// no other entries.
template <int W>
struct LimitDelassus {
  alignas(Wide<W>) std::uint32_t counts[W];
  std::uint32_t renewed, cleared;
};

constexpr float kMaxLimitImpulse = 3.0e38f;  // no upper bound

// Number of slots that stay in registers during the iteration.
constexpr std::uint32_t kRegisterSlots = 8;

template <int W>
constexpr std::size_t max_slots(const ArticulationBundle& bundle) {
  return bundle.limit_count > kRegisterSlots / 2 ? 2 * std::size_t(bundle.limit_count) : kRegisterSlots;
}

// Of all limits together; the data behind these words are aligned as vectors.
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
