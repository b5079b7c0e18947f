// The overlap traversal of a wide tree with W lanes at once. See box_walk.h.
#pragma once

#include "collision/broadphase/box_walk.h"
#include "geometry/tree/ray_traversal_lanes.h"
#include "math/pack_lanes.h"

#include <cstddef>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

GYRE_INLINE std::uint32_t leaf_mark(const BoxTreeNode& node) {
  return node.level == 0 ? StaticNode::kLeafBit : 0;
}

// Tests two nodes at once, so that neither waits for the other, and packs the children that overlap without a branch
// for each.
template <int W>
void walk_boxes(const BoxTreeNode* nodes, BoxWalk& walk) {
  const OverlapLanes<W> test(walk.box);
  std::uint32_t* top = walk.waiting + walk.depth;
  std::uint32_t* found = walk.found;
  const std::uint32_t* const full = walk.found + BoxWalk::kRoom - 2 * BoxLanes::kWidth;
  const auto put = [&](const BoxTreeNode& node, unsigned lanes) {
    const bool finds = node.level == 0;
    const std::ptrdiff_t count = pack_lanes(node.child, lanes, finds ? found : top);
    found += finds ? count : 0;
    top += finds ? 0 : count;
  };
  while (top != walk.waiting && found <= full) {
    const BoxTreeNode& first = nodes[*--top];
    // Without a second node an old entry is read in its place and its result ignored.
    const bool is_alone = top == walk.waiting;
    top -= is_alone ? 0 : 1;
    const BoxTreeNode& second = nodes[*top];
    const unsigned first_lanes = test.mask(first), second_lanes = is_alone ? 0 : test.mask(second);
    // The lower one goes first, so that each level holds no more than the children of two nodes.
    put(second, second_lanes);
    put(first, first_lanes);
  }
  walk.depth = int(top - walk.waiting);
  walk.found_count = int(found - walk.found);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
