// The walk over a wide tree of boxes that most of a search for pairs is spent in: which items' boxes overlap a box. And that of
// casts: which items' boxes lie on the way of one (geometry/tree/ray_traversal.h).
//
// In: nodes, eight boxes side by side in each. Out: items, by the handful: whoever walks looks at what was found and goes on. It is
// a kernel, since a processor with eight lanes tests a node by a third of the instructions.
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

// A walk on its way: over when nothing waits any more.
struct BoxWalk {
  // Nodes hold three or more children when they are made, so 3^24 items at least.
  static constexpr int kMaxLevels = 24;
  static constexpr int kRoom = 64;

  const Aabb box;
  int found_count = 0;
  int depth = 1;
  // Not cleared: only the counted ones are ever read.
  union {
    std::uint32_t found[kRoom];
  };
  union {
    std::uint32_t waiting[2 * kMaxLevels * BoxLanes::kWidth];  // nodes, the higher ones first
  };

  BoxWalk(const Aabb& of, std::uint32_t root) : box(of) { waiting[0] = root; }
};

// Goes on until nothing waits or `found`, which is emptied before, has no room for another node.
using WalkBoxes = void (*)(const BoxTreeNode* nodes, BoxWalk& walk);

// The one that this machine runs best.
WalkBoxes select_box_walk();
RayTraversalKernel<BoxTreeNode> select_box_ray_traversal();

}  // namespace gyre
