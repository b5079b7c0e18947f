// Graph colouring: puts constraints into groups in which no two share a moving body, so that a group can be solved by
// many lanes and workers at once without their order mattering. Greedy, with one 64-bit mask of used
// colours a body; a pure function of its input, nothing is kept from step to step.
//
// Greedy colouring needs at most one colour more than the two bodies have other constraints together. Constraints that
// find no colour free (a body with a great many contacts) form the overflow group, to be solved one after the other.
#pragma once

#include "base/container/array.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace gyre {

// What a constraint acts on: two bodies (or particles, or whatever must not be written twice). kNone, or one that is
// static, is only read and never conflicts.
struct ColoringPair {
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

struct ColoringOptions {
  static constexpr int kMaxColors = 64;

  int max_colors = 32;  // 1 to kMaxColors
  // Constraints with just one moving body are coloured from the top colour downward, so they are solved last: contacts
  // with the ground then have the last word, and the ground is what must not be sunk into.
  bool statics_last = false;
};

// The groups, and the memory to find them; kept by the caller so that a warm step allocates nothing.
struct Coloring {
  Array<std::uint8_t> color;     // by constraint; max_colors is the overflow group
  Array<std::uint32_t> order;    // constraints by group, in each ascending
  Array<std::uint32_t> offsets;  // group g is order[offsets[g]] to before order[offsets[g + 1]]
  Array<std::uint64_t> masks;    // by body: colours used

  // Colours (some may be empty), then the overflow group.
  int group_count() const { return offsets.empty() ? 0 : static_cast<int>(offsets.size()) - 1; }
  int overflow_group() const { return group_count() - 1; }
  std::span<const std::uint32_t> group(int g) const {
    return order.view().subspan(offsets[g], offsets[g + 1] - offsets[g]);
  }
};

// `is_static`: bits by body, 64 to a word (Bitset::words()); bodies beyond its end move. Every body that is not kNone is
// below body_count.
//
// `names`: an ascending number for each constraint; none: constraints choose in input order. Colours are solved one after the other, and
// what comes first bears a little more. In the order in which a wall was built each brick's left neighbour comes before its right one, and
// the whole wall leans. So runs of neighbours by name choose forward or backward by lot (the first forward), which favours no direction,
// and still goes from the ground up. A name must stay from step to step: impulses are carried over, and if their order changes they drive
// what they should hold.
void color_constraints(std::span<const ColoringPair> pairs, std::span<const std::uint32_t> names,
                       std::uint32_t body_count, std::span<const std::uint64_t> is_static,
                       const ColoringOptions& options, Coloring& out);

// Whether each constraint is in one group, groups are ascending, and no colour has a moving body twice.
bool validate_coloring(std::span<const ColoringPair> pairs, std::uint32_t body_count,
                       std::span<const std::uint64_t> is_static, const ColoringOptions& options,
                       const Coloring& coloring);

}  // namespace gyre
