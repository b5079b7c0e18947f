// Greedy colouring by bit masks, then a counting sort of constraints by colour.
#include "task/coloring.h"

#include "base/check.h"
#include "base/hash.h"

#include <algorithm>
#include <bit>

namespace gyre {

namespace {

bool moves(std::uint32_t body, std::span<const std::uint64_t> is_static) {
  if (body == ColoringPair::kNone) return false;
  return body / 64 >= is_static.size() || (is_static[body / 64] >> body % 64 & 1) == 0;
}

constexpr std::uint64_t bit(int color) { return std::uint64_t{1} << color; }

constexpr std::uint64_t all_colors(int count) { return count >= 64 ? ~std::uint64_t{0} : bit(count) - 1; }

int lowest(std::uint64_t free) { return std::countr_zero(free); }
int highest(std::uint64_t free) { return 63 - std::countl_zero(free); }

void choose_color(std::span<const ColoringPair> pairs, std::span<const std::uint64_t> is_static,
                  const ColoringOptions& options, std::size_t i, Coloring& out) {
  const auto [a, b] = pairs[i];
  const bool a_moves = moves(a, is_static);
  const bool b_moves = moves(b, is_static);
  const std::uint64_t used = (a_moves ? out.masks[a] : 0) | (b_moves ? out.masks[b] : 0);
  const std::uint64_t free = all_colors(options.max_colors) & ~used;
  if (free == 0) {
    out.color[i] = static_cast<std::uint8_t>(options.max_colors);
    return;
  }
  const bool from_top = options.statics_last && !(a_moves && b_moves);
  const int color = from_top ? highest(free) : lowest(free);
  out.color[i] = static_cast<std::uint8_t>(color);
  if (a_moves) out.masks[a] |= bit(color);
  if (b_moves) out.masks[b] |= bit(color);
}

// Constraints with neighbouring names that choose one after the other.
constexpr std::uint32_t kRun = 32;

// The order in which constraints choose: ascending, but descending in a random half of the runs.
void order_runs(std::span<const std::uint32_t> names, std::span<std::uint32_t> order) {
  for (std::size_t begin = 0; begin < names.size();) {
    const std::uint32_t run = names[begin] / kRun;
    std::size_t end = begin;
    for (; end < names.size() && names[end] / kRun == run; ++end)
      order[end] = static_cast<std::uint32_t>(end);
    const std::span<std::uint32_t> members = order.subspan(begin, end - begin);
    if ((mix_bits(run) & 1) != 0) std::reverse(members.begin(), members.end());
    begin = end;
  }
}

void group_by_color(int group_count, Coloring& out) {
  out.offsets.assign(static_cast<std::size_t>(group_count) + 1, 0u);
  for (const std::uint8_t color : out.color) ++out.offsets[color + 1];
  for (int g = 0; g < group_count; ++g) out.offsets[g + 1] += out.offsets[g];

  std::uint32_t next[ColoringOptions::kMaxColors + 1];
  for (int g = 0; g < group_count; ++g) next[g] = out.offsets[g];
  for (std::size_t i = 0; i < out.color.size(); ++i) {
    out.order[next[out.color[i]]++] = static_cast<std::uint32_t>(i);
  }
}

}  // namespace

void color_constraints(std::span<const ColoringPair> pairs, std::span<const std::uint32_t> names,
                       std::uint32_t body_count, std::span<const std::uint64_t> is_static,
                       const ColoringOptions& options, Coloring& out) {
  GYRE_ASSERT(names.empty() || names.size() == pairs.size(), "each constraint has a name, or none has");
  GYRE_ASSERT(options.max_colors >= 1 && options.max_colors <= ColoringOptions::kMaxColors,
              "a body's used colours fit in 64 bits");
  out.masks.assign(body_count, std::uint64_t{0});
  out.color.resize_uninitialized(pairs.size());
  out.order.resize_uninitialized(pairs.size());
  if (names.empty()) {
    for (std::uint32_t i = 0; i < pairs.size(); ++i) choose_color(pairs, is_static, options, i, out);
  } else {
    order_runs(names, out.order);
    for (const std::uint32_t i : out.order) choose_color(pairs, is_static, options, i, out);
  }
  group_by_color(options.max_colors + 1, out);
}

bool validate_coloring(std::span<const ColoringPair> pairs, std::uint32_t body_count,
                       std::span<const std::uint64_t> is_static, const ColoringOptions& options,
                       const Coloring& coloring) {
  const int groups = options.max_colors + 1;
  if (coloring.color.size() != pairs.size() || coloring.order.size() != pairs.size()) return false;
  if (coloring.group_count() != groups || coloring.offsets[0] != 0) return false;
  if (coloring.offsets.back() != pairs.size()) return false;

  // The last group with the body; groups count from one here.
  Array<std::uint32_t> seen;
  seen.resize(body_count);
  for (int g = 0; g < groups; ++g) {
    if (coloring.offsets[g] > coloring.offsets[g + 1] || coloring.offsets[g + 1] > pairs.size()) return false;
    const std::span<const std::uint32_t> members = coloring.group(g);
    for (std::size_t k = 0; k < members.size(); ++k) {
      const std::uint32_t i = members[k];
      if (i >= pairs.size() || coloring.color[i] != g) return false;
      if (k > 0 && members[k - 1] >= i) return false;
      if (g == coloring.overflow_group()) continue;
      const auto [a, b] = pairs[i];
      for (const std::uint32_t body : {a, b}) {
        if (!moves(body, is_static)) continue;
        if (body >= body_count || seen[body] == static_cast<std::uint32_t>(g) + 1) return false;
      }
      if (moves(a, is_static)) seen[a] = static_cast<std::uint32_t>(g) + 1;
      if (moves(b, is_static)) seen[b] = static_cast<std::uint32_t>(g) + 1;
    }
  }
  return true;
}

}  // namespace gyre
