// A box that moves along a line, or a ray (a box without size), against boxes: one, eight side by side, those of a tree,
// those of a height field.
//
// Never misses: the moving box is enlarged by more than what rounding to float can do, so a caller who tests exactly
// afterwards loses nothing. Where the line runs along an axis no division goes wrong: a way below 1e-30 m counts as such a
// way, with the sign that it has.
//
// Source: T. Kay, J. Kajiya, "Ray Tracing Complex Scenes", 1986 (slabs); the near and far planes chosen once by the sign of
// the direction as in A. Williams et al., "An Efficient and Robust Ray-Box Intersection Algorithm", 2005.
#pragma once

#include "geometry/height_field.h"
#include "geometry/static_tree.h"
#include "math/wide.h"

#include <gyre/math.h>

#include <bit>

namespace gyre {

class BoxCast {
 public:
  // A box of half size `half` around `origin` that moves by `way`. Boxes that hold coordinates much larger than all
  // three are met late or early by no more than their own rounding.
  BoxCast(DVec3 origin, DVec3 way, Vec3 half) {
    const double o[3] = {origin.x, origin.y, origin.z}, w[3] = {way.x, way.y, way.z};
    for (int axis = 0; axis < 3; ++axis) {
      const double size = absolute(o[axis]) + absolute(w[axis]) + double(half[axis]);
      const double margin = double(half[axis]) + kSlack * size;
      negative_[axis] = w[axis] < 0.0;
      const double least = absolute(w[axis]) < kStill ? kStill : absolute(w[axis]);
      inverse_[axis] = float((negative_[axis] ? -1.0 : 1.0) / least);
      near_[axis] = float(negative_[axis] ? o[axis] - margin : o[axis] + margin);
      far_[axis] = float(negative_[axis] ? o[axis] + margin : o[axis] - margin);
    }
  }

  // Which of eight boxes, given as columns, are met at a fraction from 0 to `reach`: bit i for box i, and the fraction
  // at which box i is met in enter[i]. A box with low > high or NaN is never met.
  unsigned meets(const float (&low)[3][8], const float (&high)[3][8], float reach, float* enter) const {
    using Half = Wide<4>;
    unsigned mask = 0;
    for (int first = 0; first < 8; first += 4) {
      Half begin(0.0f), end(reach);
      for (int axis = 0; axis < 3; ++axis) {
        const float* const near_planes = negative_[axis] ? high[axis] : low[axis];
        const float* const far_planes = negative_[axis] ? low[axis] : high[axis];
        const Half inverse(inverse_[axis]);
        begin = max((Half::load_unaligned(near_planes + first) - Half(near_[axis])) * inverse, begin);
        end = min((Half::load_unaligned(far_planes + first) - Half(far_[axis])) * inverse, end);
      }
      begin.store_unaligned(enter + first);
      const Mask<4> exists = Half::load_unaligned(low[0] + first) <= Half::load_unaligned(high[0] + first);
      mask |= unsigned(to_bits((begin <= end) & exists)) << first;
    }
    return mask;
  }

  // The same for one box.
  bool meets(const Aabb& box, float reach, float& enter) const {
    float begin = 0.0f, end = reach;
    for (int axis = 0; axis < 3; ++axis) {
      const float near_plane = negative_[axis] ? box.high[axis] : box.low[axis];
      const float far_plane = negative_[axis] ? box.low[axis] : box.high[axis];
      begin = max((near_plane - near_[axis]) * inverse_[axis], begin);
      end = min((far_plane - far_[axis]) * inverse_[axis], end);
    }
    enter = begin;
    return begin <= end;
  }

 private:
  static constexpr double kSlack = 4.0e-7;  // six roundings of floats
  static constexpr double kStill = 1.0e-30;

  bool negative_[3];
  float inverse_[3];
  float near_[3], far_[3];
};

// What waits in a walk from near to far.
template <class Place>
struct WaitingPlace {
  Place place;
  float enter;
};

// Puts the places that `mask` names on a stack so that the nearest is on top; equals keep their order.
template <class Place, class PlaceOf>
void push_near_last(WaitingPlace<Place>* stack, int& depth, unsigned mask, const float* enter,
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
void walk_cast(const StaticTree& tree, const BoxCast& cast, float reach, Visit&& visit) {
  if (tree.nodes.empty()) return;
  WaitingPlace<std::uint32_t> stack[StaticTree::kStackSize];
  int depth = 0;
  stack[depth++] = {0, 0.0f};
  while (depth > 0) {
    const WaitingPlace<std::uint32_t> next = stack[--depth];
    if (next.enter > reach) continue;
    if (is_leaf(next.place)) {
      reach = visit(leaf_first(next.place), leaf_count(next.place), reach);
      continue;
    }
    const StaticTree::Node& node = tree.nodes[next.place];
    float enter[StaticTree::kWidth];
    const unsigned mask = cast.meets(node.low, node.high, reach, enter);
    push_near_last(stack, depth, mask, enter, [&](int lane) { return node.child[lane]; });
  }
}

// The same for the solid cells of a height field: visit(column, row, reach).
template <class Visit>
void walk_cast(const HeightField& field, const BoxCast& cast, float reach, Visit&& visit) {
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
          if (is_solid_cell(field, c, r) && cast.meets(block_box(field, {-1, c, r}), reach, enter)) {
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
      if (heights.low <= heights.high && cast.meets(block_box(field, part), reach, enter[k])) mask |= 1u << k;
    }
    push_near_last(stack, depth, mask, enter, child);
  }
}

}  // namespace gyre
