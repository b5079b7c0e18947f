// Graph colouring: divides constraints into groups in which no two share a moving body, so that many lanes and workers
// can solve a group at once in any order. Greedy, with one 64-bit mask of used colours a body. A pure function of its
// input; nothing is kept between steps.
//
// Greedy colouring needs at most one colour more than the two bodies have other constraints together. Constraints
// without a free colour (of a body with very many contacts) form the overflow group, which is solved one after the
// other.
#pragma once

#include "base/container/array.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace gyre {

// The two bodies of a constraint, or other things that must not be written twice. kNone and static bodies are only read
// and never conflict.
struct ColoringPair {
  static constexpr std::uint32_t kNone = 0xffffffff;

  std::uint32_t a = 0;
  std::uint32_t b = 0;
};

struct ColoringOptions {
  static constexpr int kMaxColors = 64;

  int max_colors = 32;  // 1 to kMaxColors
  // Constraints with one moving body are coloured from the top colour downward, so they are solved last: contacts with
  // the ground have the last word, since nothing must sink into the ground.
  bool statics_last = false;
};

// The groups, and the memory to find them; kept by the caller so that a warm step allocates nothing.
struct Coloring {
  Array<std::uint8_t> color;     // by constraint; max_colors is the overflow group
  Array<std::uint32_t> order;    // constraints by group, ascending in each
  Array<std::uint32_t> offsets;  // group g is order[offsets[g]] to before order[offsets[g + 1]]
  Array<std::uint64_t> masks;    // by body: colours used

  // Colours (some may be empty), then the overflow group.
  int group_count() const { return offsets.empty() ? 0 : static_cast<int>(offsets.size()) - 1; }
  int overflow_group() const { return group_count() - 1; }
  std::span<const std::uint32_t> group(int g) const {
    return order.view().subspan(offsets[g], offsets[g + 1] - offsets[g]);
  }
};

// `is_static`: bits by body, 64 to a word (Bitset::words()); bodies beyond its end move. Every body that is not kNone
// is below body_count.
//
// `names`: an ascending number for each constraint; if empty, constraints choose in input order. Colours are solved one
// after the other, and early constraints bear a little more load. In the order in which a wall was built, each brick's
// left neighbour comes before its right one, and the whole wall would lean. So runs of neighbouring names choose
// forward or backward at random (the first run forward), which favours no direction and still goes from the ground up.
// Names must not change between steps: in a new order the impulses that are carried over would drive bodies that they
// should hold.
void color_constraints(std::span<const ColoringPair> pairs, std::span<const std::uint32_t> names,
                       std::uint32_t body_count, std::span<const std::uint64_t> is_static,
                       const ColoringOptions& options, Coloring& out);

// True if each constraint is in one group, groups are ascending, and no colour has a moving body twice.
bool validate_coloring(std::span<const ColoringPair> pairs, std::uint32_t body_count,
                       std::span<const std::uint64_t> is_static, const ColoringOptions& options,
                       const Coloring& coloring);

}  // namespace gyre
