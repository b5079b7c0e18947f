// An immutable 8-wide tree of boxes, for the triangles of a mesh or anything else that never moves against its owner.
//
// In: one box for each item. Out: an order of the items in which every node owns one contiguous run (the "position" is
// the index of an item in that order), and traversals over the boxes that overlap a box or a ray. A node has the boxes
// of its eight children side by side, so one loop tests them all. Traversals visit positions in ascending order and
// need no heap memory.
//
// Sources: I. Wald, S. Boulos, P. Shirley, "Ray Tracing Deformable Scenes using Dynamic Bounding Volume Hierarchies",
// 2007 (binned surface area heuristic); H. Dammertz, J. Hanika, A. Keller, "Shallow Bounding Volume Hierarchies", 2008.
#pragma once

#include "geometry/tree/static_node.h"
#include "math/wide.h"

#include <gyre/math.h>

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

struct StaticTree {
  using Node = StaticNode;
  static constexpr int kWidth = Node::kWidth;
  static constexpr std::uint32_t kMaxLeaf = 4;
  static constexpr std::uint32_t kMaxItems = Node::kMaxItems;
  // Nodes above this depth are split by the heuristic, those below into halves. So the depth is bounded for any input.
  static constexpr int kHeuristicDepth = 20;
  static constexpr int kMaxDepth = kHeuristicDepth + 12;
  static constexpr int kStackSize = kMaxDepth * (kWidth - 1) + kWidth;

  static constexpr std::uint32_t kLeafBit = Node::kLeafBit;
  static constexpr std::uint32_t kNoChild = Node::kNoChild;

  std::vector<Node> nodes;           // the root is the first
  std::vector<std::uint32_t> items;  // by position: the index of the item in the input
  Aabb box;
};

constexpr Aabb child_box(const StaticTree::Node& node, int lane) {
  return {{node.low[0][lane], node.low[1][lane], node.low[2][lane]},
          {node.high[0][lane], node.high[1][lane], node.high[2][lane]}};
}

// Builds the tree over 1 to kMaxItems boxes with finite corners. Equal input gives an equal tree.
void build_static_tree(std::span<const Aabb> boxes, StaticTree& tree);

// A bit for each child whose box overlaps `box`.
inline unsigned overlap_mask(const StaticTree::Node& node, const Aabb& box) {
  constexpr int kHalf = 4;
  using Floats = Wide<kHalf>;
  unsigned mask = 0;
  for (int i = 0; i < StaticTree::kWidth; i += kHalf) {
    const auto overlap = [&](int axis) {
      return (Floats::load_unaligned(node.low[axis] + i) <= Floats(box.high[axis])) &
             (Floats(box.low[axis]) <= Floats::load_unaligned(node.high[axis] + i));
    };
    mask |= to_bits(overlap(0) & overlap(1) & overlap(2)) << i;
  }
  return mask;
}

// Calls visit(first position, count) for each leaf whose box overlaps `box`, in ascending order. Calls enter(node
// index, lane) before each child, and skips the child if that returns false.
template <class Enter, class Visit>
void walk_overlaps(const StaticTree& tree, const Aabb& box, Enter&& enter, Visit&& visit) {
  if (tree.nodes.empty()) return;
  std::uint32_t stack[StaticTree::kStackSize];
  int depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t child = stack[--depth];
    if (is_leaf(child)) {
      visit(leaf_first(child), leaf_count(child));
      continue;
    }
    const StaticTree::Node& node = tree.nodes[child];
    // The last lane goes to the bottom, so the first comes off first.
    for (unsigned mask = overlap_mask(node, box); mask != 0;) {
      const int lane = int(std::bit_width(mask)) - 1;
      mask ^= 1u << lane;
      if (enter(child, lane)) stack[depth++] = node.child[lane];
    }
  }
}

// The positions in all leaves whose boxes overlap `box`, ascending; the boxes of the items themselves may not overlap
// it. Writes at most `out.size()` positions and returns how many there are.
std::uint32_t find_overlaps(const StaticTree& tree, const Aabb& box, std::span<std::uint32_t> out);

}  // namespace gyre
