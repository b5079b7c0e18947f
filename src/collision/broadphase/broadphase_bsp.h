// A binary space partition: each node has a plane, which may be tilted, and three groups of boxes: behind it, before
// it, and cut by it; other planes divide each group further. The plane has one of 13 directions and comes from a sample
// of the boxes; it cuts few boxes and leaves two sides of similar size. The search for planes takes long, so this broad
// phase suits worlds in which little moves.
//
// Sources: H. Fuchs, Z. Kedem, B. Naylor, "On Visible Surface Generation by A Priori Tree Structures", 1980; C.
// Ericson, "Real-Time Collision Detection", 2005, chapter 8 (costs of cuts and balance).
#pragma once

#include "collision/broadphase/split_tree.h"

namespace gyre {

struct BspSplitter {
  static constexpr int kChildren = 3;  // behind, cut, before
  static constexpr int kDirections = SplitDirections::kCount;
  static constexpr std::size_t kRebuildShare = 2;

  static int child_of(const Split& split, const Aabb& box) {
    if (SplitDirections::high(box, split.direction) < split.value) return 0;
    return SplitDirections::low(box, split.direction) > split.value ? 2 : 1;
  }
  static bool choose_split(std::span<BoxEntry> entries, Split& split);
};

using BspTree = SplitTree<BspSplitter>;

extern template class SplitTree<BspSplitter>;

}  // namespace gyre
