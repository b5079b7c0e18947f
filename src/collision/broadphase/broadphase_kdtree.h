// A kd-tree: each node splits its boxes at the median of their centres, along the axis with the largest spread.
//
// Sources: J. Bentley, "Multidimensional Binary Search Trees Used for Associative Searching", 1975; B. Ooi, K.
// McDonell, R. Sacks-Davis, "Spatial kd-Tree: An Indexing Mechanism for Spatial Databases", 1987 (each side stores its
// extent).
#pragma once

#include "collision/broadphase/split_tree.h"

namespace gyre {

struct KdSplitter {
  static constexpr int kChildren = 2;
  static constexpr int kDirections = 3;
  static constexpr std::size_t kRebuildShare = 2;

  // Twice the centre.
  static float key(const Split& split, const Aabb& box) {
    return box.low[split.direction] + box.high[split.direction];
  }
  static int child_of(const Split& split, const Aabb& box) { return key(split, box) < split.value ? 0 : 1; }
  static bool choose_split(std::span<BoxEntry> entries, Split& split);
};

using KdTree = SplitTree<KdSplitter>;

extern template class SplitTree<KdSplitter>;

}  // namespace gyre
