// A binary space partition: each node parts its boxes by a plane, which may be tilted, into those behind it, those before
// it, and those that it cuts, which make a third group that other planes part further. The plane is the one of 13
// directions and a few places each that cuts few and leaves two sides of like size; a sample of the boxes decides. Looking
// for good planes takes its time: this is for worlds in which little moves.
//
// Sources: H. Fuchs, Z. Kedem, B. Naylor, "On Visible Surface Generation by A Priori Tree Structures", 1980; C. Ericson,
// "Real-Time Collision Detection", 2005, chapter 8 (what cuts and balance cost).
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
