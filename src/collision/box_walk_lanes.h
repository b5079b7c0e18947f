// The walk over a wide tree with W lanes at once. See box_walk.h.
#pragma once

#include "collision/box_walk.h"
#include "geometry/line_walk_lanes.h"

#include <bit>

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// The children whose bits are set. Returns the place behind the last.
GYRE_INLINE std::uint32_t* append_children(const BoxTreeNode& node, unsigned lanes, std::uint32_t* to) {
  for (; lanes != 0; lanes &= lanes - 1) *to++ = node.child[std::countr_zero(lanes)];
  return to;
}

GYRE_INLINE std::uint32_t leaf_mark(const BoxTreeNode& node) {
  return node.level == 0 ? StaticNode::kLeafBit : 0;
}

template <int W>
void walk_boxes(const BoxTreeNode* nodes, BoxWalk& walk) {
  const OverlapLanes<W> test(walk.box);
  std::uint32_t* top = walk.waiting + walk.depth;
  std::uint32_t* found = walk.found;
  const std::uint32_t* const full = walk.found + BoxWalk::kRoom - BoxLanes::kWidth;
  while (top != walk.waiting && found <= full) {
    const BoxTreeNode& node = nodes[*--top];
    const unsigned lanes = test.mask(node);
    if (node.level == 0) {
      found = append_children(node, lanes, found);
    } else {
      top = append_children(node, lanes, top);
    }
  }
  walk.depth = int(top - walk.waiting);
  walk.found_count = int(found - walk.found);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
