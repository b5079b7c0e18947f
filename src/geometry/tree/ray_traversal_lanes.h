// The walk along a line with W lanes at once. See ray_traversal.h.
#pragma once

#include "geometry/tree/ray_traversal.h"
#include "math/wide.h"

#include <bit>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// A line to be held against many nodes.
template <int W, class Node>
class BoxRayLanes {
 public:
  GYRE_INLINE explicit BoxRayLanes(const BoxRay& line) {
    GYRE_UNROLL
    for (int axis = 0; axis < 3; ++axis) {
      near_[axis] = line.near[axis];
      far_[axis] = line.far[axis];
      inverse_[axis] = line.inverse[axis];
      near_side_[axis] = line.negative[axis] ? kHigh : kLow;
      far_side_[axis] = line.negative[axis] ? kLow : kHigh;
    }
  }

  // Bit i: lane i's box is met at a fraction from 0 to `reach`, and first at enter[i]. Boxes with low > high never are; none
  // may have NaN.
  GYRE_INLINE unsigned meets(const Node& node, float reach, float* enter) const {
    unsigned bits = 0;
    GYRE_UNROLL
    for (int first = 0; first < Node::kWidth; first += W) {
      Wide<W> begin(0.0f), end(reach);
      GYRE_UNROLL
      for (int axis = 0; axis < 3; ++axis) {
        begin = max(begin, (planes(node, near_side_[axis], axis, first) - near_[axis]) * inverse_[axis]);
        end = min(end, (planes(node, far_side_[axis], axis, first) - far_[axis]) * inverse_[axis]);
      }
      // What waits goes by the bits of this, so -0 must not stand for 0.
      absolute(begin).store(enter + first);
      bits |= to_bits(begin <= end) << first;
    }
    return bits;
  }

 private:
  // Where a side's columns begin in a node.
  static constexpr std::size_t kLow = 0, kHigh = sizeof(float) * 3 * Node::kWidth;

  static GYRE_INLINE Wide<W> planes(const Node& node, std::size_t side, int axis, int first) {
    const char* const columns = reinterpret_cast<const char*>(node.low) + side;
    return Wide<W>::load_unaligned(reinterpret_cast<const float*>(columns) + axis * Node::kWidth + first);
  }

  Wide<W> near_[3], far_[3], inverse_[3];
  std::size_t near_side_[3], far_side_[3];
};

// Most of a walk is spent waiting for nodes: they are asked for when they are put aside.
template <class Node>
GYRE_INLINE void ask_for(const Node* node) {
  const char* const begin = reinterpret_cast<const char*>(node);
  GYRE_UNROLL
  for (std::size_t line = 0; line < sizeof(Node); line += 64) __builtin_prefetch(begin + line);
}

// Puts the lanes' children on the stack so that the nearest is on top.
template <class Node>
GYRE_INLINE std::uint64_t* push_nearest_last(const Node* nodes, const Node& node, unsigned lanes,
                                          const float* enter, std::uint32_t child_bits, std::uint64_t* top) {
  const std::uint64_t* const bottom = top;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const std::uint32_t child = node.child[lane] | child_bits;
    if (!is_leaf(child)) ask_for(nodes + child);
    const std::uint64_t next = std::uint64_t(__builtin_bit_cast(std::uint32_t, enter[lane])) << 32 | child;
    std::uint64_t* place = top++;
    for (; place != bottom && place[-1] < next; --place) *place = place[-1];
    *place = next;
  }
  return top;
}

// What a tree marks its leaves with on its lowest level, if not in the child itself.
GYRE_INLINE std::uint32_t leaf_mark(const StaticNode&) { return 0; }

template <int W, class Node>
bool next_ray_leaf(const Node* nodes, RayTraversal& walk) {
  const BoxRayLanes<W, Node> line(walk.line);
  const float reach = walk.reach;
  const std::uint64_t last = std::uint64_t(__builtin_bit_cast(std::uint32_t, reach)) << 32 | 0xffffffffu;
  std::uint64_t* top = walk.waiting + walk.depth;
  while (top != walk.waiting) {
    const std::uint64_t next = *--top;
    if (next > last) continue;
    const auto place = std::uint32_t(next);
    if (is_leaf(place)) {
      walk.leaf = place & ~StaticNode::kLeafBit;
      walk.depth = int(top - walk.waiting);
      return true;
    }
    const Node& node = nodes[place];
    alignas(32) float enter[Node::kWidth];
    const unsigned lanes = line.meets(node, reach, enter);
    top = push_nearest_last(nodes, node, lanes, enter, leaf_mark(node), top);
  }
  walk.depth = 0;
  return false;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
