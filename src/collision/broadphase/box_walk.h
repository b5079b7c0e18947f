// The traversals of a wide tree of boxes: the overlap test, in which the search for pairs spends most of its time, and
// that of casts (geometry/tree/ray_traversal.h).
//
// In: nodes with eight boxes each. Out: items, a few at a time; the caller handles them and calls again. The traversals
// are kernels: eight lanes test a node with a third fewer instructions.
#pragma once

#include "collision/broadphase/box_lanes.h"
#include "geometry/tree/ray_traversal.h"

#include <cstdint>

namespace gyre {

// Lanes from `count` on have a box that nothing overlaps.
struct alignas(64) BoxTreeNode : BoxLanes {
  std::uint32_t child[kWidth];  // nodes; on level 0, items
  std::uint32_t parent;
  std::uint8_t lane;  // in the parent
  std::uint8_t count;
  std::uint8_t level;  // 0: the children are items
  std::uint8_t used;   // 0: the node is on the free list
};

// The state of a traversal; it is over when no node waits.
struct BoxWalk {
  // New nodes have three or more children, so this is enough for 3^24 items.
  static constexpr int kMaxLevels = 24;
  static constexpr int kRoom = 64;

  const Aabb box;
  int found_count = 0;
  int depth = 1;
  // Not cleared: only counted ones are read.
  union {
    std::uint32_t found[kRoom];
  };
  union {
    std::uint32_t waiting[2 * kMaxLevels * BoxLanes::kWidth];  // nodes, the higher ones first
  };

  BoxWalk(const Aabb& of, std::uint32_t root) : box(of) { waiting[0] = root; }
};

// Continues until no node waits or `found`, which is emptied first, has no room for another node.
using WalkBoxes = void (*)(const BoxTreeNode* nodes, BoxWalk& walk);

// The kernels that this machine runs best.
WalkBoxes select_box_walk();
RayTraversalKernel<BoxTreeNode> select_box_ray_traversal();

}  // namespace gyre
