// Casts of a moving box or a ray (a box without size) against the boxes of a tree or of a height field. Never misses a
// box (ray_traversal.h).
#pragma once

#include "geometry/shape/height_field.h"
#include "geometry/tree/ray_traversal.h"
#include "geometry/tree/static_tree.h"

#include <gyre/math.h>

#include <bit>

namespace gyre {

// True if the moving box meets `box` at a fraction from 0 to `max_fraction`; `enter` is the first one.
inline bool meets(const BoxRay& line, const Aabb& box, float max_fraction, float& enter) {
  float begin = 0.0f, end = max_fraction;
  for (int axis = 0; axis < 3; ++axis) {
    const float near_plane = line.negative[axis] ? box.high[axis] : box.low[axis];
    const float far_plane = line.negative[axis] ? box.low[axis] : box.high[axis];
    begin = max((near_plane - line.near[axis]) * line.inverse[axis], begin);
    end = min((far_plane - line.far[axis]) * line.inverse[axis], end);
  }
  enter = begin;
  return begin <= end;
}

// An item that is still to be visited in a traversal from near to far.
template <class Item>
struct StackEntry {
  Item item;
  float enter;
};

// Pushes the items that `mask` names, so that the nearest is on top. Equally near items keep their order.
template <class Item, class ItemOf>
void push_nearest_last(StackEntry<Item>* stack, int& depth, unsigned mask, const float* enter,
                       ItemOf&& item_of) {
  const int bottom = depth;
  for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    int i = depth++;
    for (; i > bottom && stack[i - 1].enter <= enter[lane]; --i) stack[i] = stack[i - 1];
    stack[i] = {item_of(lane), enter[lane]};
  }
}

// Calls visit(first position, count, max_fraction) for each leaf whose box is met at a fraction from 0 to
// `max_fraction`, roughly from near to far. visit returns the new max_fraction, never more than the old one.
template <class Visit>
void traverse_cast(const StaticTree& tree, const BoxRay& line, float max_fraction, Visit&& visit) {
  static_assert(StaticTree::kStackSize <= RayTraversal::kRoom);
  if (tree.nodes.empty()) return;
  const RayTraversalKernel<StaticNode> walk_on = select_static_ray_traversal();
  RayTraversal walk(line, 0, max_fraction);
  while (walk_on(tree.nodes.data(), walk))
    walk.max_fraction = visit(leaf_first(walk.leaf), leaf_count(walk.leaf), walk.max_fraction);
}

// The same for the solid cells of a height field: visit(column, row, max_fraction).
template <class Visit>
void traverse_cast(const HeightField& field, const BoxRay& line, float max_fraction, Visit&& visit) {
  StackEntry<HeightBlock> stack[3 * 32 + 4];
  int depth = 0;
  stack[depth++] = {{int(field.levels.size()) - 1, 0, 0}, 0.0f};
  while (depth > 0) {
    const StackEntry<HeightBlock> next = stack[--depth];
    if (next.enter > max_fraction) continue;
    const HeightBlock block = next.item;
    if (block.level == 0) {
      const std::uint32_t column = block.column << HeightField::kBlockShift,
                          row = block.row << HeightField::kBlockShift;
      const std::uint32_t size = 1u << HeightField::kBlockShift;
      for (std::uint32_t r = row; r < min(row + size, field.cell_rows()); ++r) {
        for (std::uint32_t c = column; c < min(column + size, field.cell_columns()); ++c) {
          float enter;
          if (is_solid_cell(field, c, r) && meets(line, block_box(field, {-1, c, r}), max_fraction, enter)) {
            max_fraction = visit(c, r, max_fraction);
          }
        }
      }
      continue;
    }
    const HeightField::Level& finer = field.levels[std::size_t(block.level) - 1];
    float enter[4];
    unsigned mask = 0;
    const auto child = [&](int k) {
      return HeightBlock{block.level - 1, 2 * block.column + std::uint32_t(k & 1),
                         2 * block.row + std::uint32_t(k >> 1)};
    };
    for (int k = 0; k < 4; ++k) {
      const HeightBlock finer_block = child(k);
      if (finer_block.column >= finer.columns || finer_block.row >= finer.rows) continue;
      const HeightRange& heights =
          finer.blocks[std::size_t(finer_block.row) * finer.columns + finer_block.column];
      if (heights.low <= heights.high && meets(line, block_box(field, finer_block), max_fraction, enter[k]))
        mask |= 1u << k;
    }
    push_nearest_last(stack, depth, mask, enter, child);
  }
}

}  // namespace gyre
