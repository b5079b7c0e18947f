// A box that moves along a line, or a ray (a box without size), against boxes: those of a tree, those of a height field.
// Never misses (ray_traversal.h).
#pragma once

#include "geometry/shape/height_field.h"
#include "geometry/tree/ray_traversal.h"
#include "geometry/tree/static_tree.h"

#include <gyre/math.h>

#include <bit>

namespace gyre {

// Whether the moving box meets `box` at a fraction from 0 to `reach`, and where first.
inline bool meets(const BoxRay& line, const Aabb& box, float reach, float& enter) {
  float begin = 0.0f, end = reach;
  for (int axis = 0; axis < 3; ++axis) {
    const float near_plane = line.negative[axis] ? box.high[axis] : box.low[axis];
    const float far_plane = line.negative[axis] ? box.low[axis] : box.high[axis];
    begin = max((near_plane - line.near[axis]) * line.inverse[axis], begin);
    end = min((far_plane - line.far[axis]) * line.inverse[axis], end);
  }
  enter = begin;
  return begin <= end;
}

// What waits in a walk from near to far.
template <class Place>
struct WaitingPlace {
  Place place;
  float enter;
};

// Puts the places that `mask` names on a stack so that the nearest is on top; equals keep their order.
template <class Place, class PlaceOf>
void push_nearest_last(WaitingPlace<Place>* stack, int& depth, unsigned mask, const float* enter,
                    PlaceOf&& place_of) {
  const int bottom = depth;
  for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    int i = depth++;
    for (; i > bottom && stack[i - 1].enter <= enter[lane]; --i) stack[i] = stack[i - 1];
    stack[i] = {place_of(lane), enter[lane]};
  }
}

// Calls visit(first position, count, reach) for each leaf whose box is met at a fraction from 0 to `reach`, roughly from
// near to far. visit returns the new reach, never more than the old one.
template <class Visit>
void traverse_cast(const StaticTree& tree, const BoxRay& line, float reach, Visit&& visit) {
  static_assert(StaticTree::kStackSize <= RayTraversal::kRoom);
  if (tree.nodes.empty()) return;
  const RayTraversalKernel<StaticNode> walk_on = select_static_ray_traversal();
  RayTraversal walk(line, 0, reach);
  while (walk_on(tree.nodes.data(), walk))
    walk.reach = visit(leaf_first(walk.leaf), leaf_count(walk.leaf), walk.reach);
}

// The same for the solid cells of a height field: visit(column, row, reach).
template <class Visit>
void traverse_cast(const HeightField& field, const BoxRay& line, float reach, Visit&& visit) {
  WaitingPlace<HeightBlock> stack[3 * 32 + 4];
  int depth = 0;
  stack[depth++] = {{int(field.levels.size()) - 1, 0, 0}, 0.0f};
  while (depth > 0) {
    const WaitingPlace<HeightBlock> next = stack[--depth];
    if (next.enter > reach) continue;
    const HeightBlock block = next.place;
    if (block.level == 0) {
      const std::uint32_t column = block.column << HeightField::kBlockShift,
                          row = block.row << HeightField::kBlockShift;
      const std::uint32_t size = 1u << HeightField::kBlockShift;
      for (std::uint32_t r = row; r < min(row + size, field.cell_rows()); ++r) {
        for (std::uint32_t c = column; c < min(column + size, field.cell_columns()); ++c) {
          float enter;
          if (is_solid_cell(field, c, r) && meets(line, block_box(field, {-1, c, r}), reach, enter)) {
            reach = visit(c, r, reach);
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
      const HeightBlock part = child(k);
      if (part.column >= finer.columns || part.row >= finer.rows) continue;
      const HeightRange& heights = finer.blocks[std::size_t(part.row) * finer.columns + part.column];
      if (heights.low <= heights.high && meets(line, block_box(field, part), reach, enter[k]))
        mask |= 1u << k;
    }
    push_nearest_last(stack, depth, mask, enter, child);
  }
}

}  // namespace gyre
