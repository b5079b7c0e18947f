// Chooses the split of a node of the kd-tree. See broadphase_kdtree.h.
#include "collision/broadphase/broadphase_kdtree.h"

#include "collision/broadphase/box_tree.h"
#include "collision/broadphase/split_tree_build.h"

namespace gyre {
namespace {

// partition_by_center() takes the boxes' centres along an axis as its keys.
float key_of(const BoxEntry& entry, int axis) { return entry.box.low[axis] + entry.box.high[axis]; }

}  // namespace

bool KdSplitter::choose_split(std::span<BoxEntry> entries, Split& split) {
  Vec3 low = entries[0].box.low + entries[0].box.high, high = low;
  for (const BoxEntry& entry : entries) {
    const Vec3 middle = entry.box.low + entry.box.high;
    low = min(low, middle);
    high = max(high, middle);
  }
  const Vec3 spread = high - low;
  const int axis = spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
  if (!(spread[axis] > 0.0f)) return false;
  const std::size_t middle = entries.size() / 2;
  partition_by_center(entries, middle, axis);
  float value = key_of(entries[middle], axis);
  for (std::size_t i = middle; i < entries.size(); ++i) value = min(value, key_of(entries[i], axis));
  // If the whole lower half has one position, the next higher one splits.
  if (value == low[axis]) {
    value = high[axis];
    for (const BoxEntry& entry : entries) {
      const float key = key_of(entry, axis);
      if (key > low[axis]) value = min(value, key);
    }
  }
  split = {std::uint8_t(axis), value};
  return true;
}

template class SplitTree<KdSplitter>;

}  // namespace gyre
