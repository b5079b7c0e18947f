// The ray traversal with W lanes at once. See ray_traversal.h.
#pragma once

#include "geometry/tree/ray_traversal.h"
#include "math/wide.h"

#include <bit>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// A ray that is tested against many nodes.
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

  // Bit i is set if the box in lane i is met at a fraction from 0 to `max_fraction`; enter[i] is the first one. Boxes
  // with low > high are never met; NaN is not allowed.
  GYRE_INLINE unsigned meets(const Node& node, float max_fraction, float* enter) const {
    unsigned bits = 0;
    GYRE_UNROLL
    for (int first = 0; first < Node::kWidth; first += W) {
      Wide<W> begin(0.0f), end(max_fraction);
      GYRE_UNROLL
      for (int axis = 0; axis < 3; ++axis) {
        begin = max(begin, (planes(node, near_side_[axis], axis, first) - near_[axis]) * inverse_[axis]);
        end = min(end, (planes(node, far_side_[axis], axis, first) - far_[axis]) * inverse_[axis]);
      }
      // The stack is ordered by the bits of `enter`, so -0 must become 0.
      absolute(begin).store(enter + first);
      bits |= to_bits(begin <= end) << first;
    }
    return bits;
  }

 private:
  // Offset of the low and of the high columns in a node.
  static constexpr std::size_t kLow = 0, kHigh = sizeof(float) * 3 * Node::kWidth;

  static GYRE_INLINE Wide<W> planes(const Node& node, std::size_t side, int axis, int first) {
    const char* const columns = reinterpret_cast<const char*>(node.low) + side;
    return Wide<W>::load_unaligned(reinterpret_cast<const float*>(columns) + axis * Node::kWidth + first);
  }

  Wide<W> near_[3], far_[3], inverse_[3];
  std::size_t near_side_[3], far_side_[3];
};

// Most of the time goes into waiting for nodes, so they are prefetched when they are pushed.
template <class Node>
GYRE_INLINE void prefetch(const Node* node) {
  const char* const begin = reinterpret_cast<const char*>(node);
  GYRE_UNROLL
  for (std::size_t line = 0; line < sizeof(Node); line += 64) __builtin_prefetch(begin + line);
}

// Pushes the children in `lanes`, the nearest on top.
template <class Node>
GYRE_INLINE std::uint64_t* push_nearest_last(const Node* nodes, const Node& node, unsigned lanes,
                                             const float* enter, std::uint32_t child_bits,
                                             std::uint64_t* top) {
  const std::uint64_t* const bottom = top;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int lane = std::countr_zero(lanes);
    const std::uint32_t child = node.child[lane] | child_bits;
    if (!is_leaf(child)) prefetch(nodes + child);
    const std::uint64_t next = std::uint64_t(__builtin_bit_cast(std::uint32_t, enter[lane])) << 32 | child;
    std::uint64_t* slot = top++;
    for (; slot != bottom && slot[-1] < next; --slot) *slot = slot[-1];
    *slot = next;
  }
  return top;
}

// The mark that a tree adds to the children on its lowest level, if the children do not have it themselves.
GYRE_INLINE std::uint32_t leaf_mark(const StaticNode&) { return 0; }

template <int W, class Node>
bool next_ray_leaf(const Node* nodes, RayTraversal& walk) {
  const BoxRayLanes<W, Node> line(walk.line);
  const float max_fraction = walk.max_fraction;
  const std::uint64_t limit =
      std::uint64_t(__builtin_bit_cast(std::uint32_t, max_fraction)) << 32 | 0xffffffffu;
  std::uint64_t* top = walk.waiting + walk.depth;
  while (top != walk.waiting) {
    const std::uint64_t next = *--top;
    if (next > limit) continue;
    const auto item = std::uint32_t(next);
    if (is_leaf(item)) {
      walk.leaf = item & ~StaticNode::kLeafBit;
      walk.depth = int(top - walk.waiting);
      return true;
    }
    const Node& node = nodes[item];
    alignas(32) float enter[Node::kWidth];
    const unsigned lanes = line.meets(node, max_fraction, enter);
    top = push_nearest_last(nodes, node, lanes, enter, leaf_mark(node), top);
  }
  walk.depth = 0;
  return false;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
