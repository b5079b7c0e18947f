// Sweep and prune: boxes in the order of their low ends along the axis with the largest spread. Overlapping boxes are
// near in that order, and the order hardly changes from step to step, so insertion sort maintains it in little more
// than one pass. If most boxes have moved, one sweep finds all pairs; otherwise each moved box searches backward from
// its high end.
//
// Boxes lie eight to a block in that order. Groups of blocks store their highest end, so that searches skip what ends
// too early even if one huge box covers all.
//
// Sources: D. Baraff, "Dynamic Simulation of Non-Penetrating Rigid Bodies", 1992; J. Cohen, M. Lin, D. Manocha, M.
// Ponamgi, "I-COLLIDE", 1995.
#pragma once

#include "collision/broadphase/box_buckets.h"
#include "collision/broadphase/broadphase_base.h"

#include <bit>

namespace gyre {

class SortedAxis {
 public:
  static constexpr std::size_t kRebuildShare = 1;
  static constexpr std::size_t kWidth = BoxLanes::kWidth;

  std::size_t size() const { return size_; }
  bool contains(std::uint32_t item) const { return item < boxes_.size() && present_[item] != 0; }
  Aabb box_of(std::uint32_t item) const { return boxes_[item]; }
  int axis() const { return axis_; }

  void clear();
  void begin_build() { clear(); }
  void add_to_build(std::uint32_t item, const Aabb& box) { insert(item, box); }
  void finish_build();
  void insert(std::uint32_t item, const Aabb& box);
  void remove(std::uint32_t item);
  void move(std::uint32_t item, const Aabb& box);
  // Restores the order.
  void improve(std::size_t changes);
  void trim();
  const char* find_fault() const;
  std::size_t bytes() const;

  template <class Visit>
  void for_each_overlap(const Aabb& box, Visit&& visit) const {
    const OverlapTest test(box);
    for_each_block_down(blocks_before(box.high[axis_]), box.low[axis_], [&](const Block& block) {
      for (unsigned left = test.mask(block); left != 0; left &= left - 1)
        visit(block.item[std::countr_zero(left)]);
      return true;
    });
  }

  template <class Visit>
  float for_each_along(const CastTest& cast_test, float max_fraction, Visit&& visit) const {
    const Aabb all = cast_test.box_of({0.0f, max_fraction});
    for_each_block_down(blocks_before(all.high[axis_]), all.low[axis_], [&](const Block& block) {
      float enter[kWidth];
      for (unsigned left = cast_test.mask(block, max_fraction, enter); left != 0; left &= left - 1) {
        max_fraction = visit(block.item[std::countr_zero(left)], max_fraction);
        if (max_fraction < 0.0f) return false;
      }
      return true;
    });
    return max_fraction;
  }

  template <class Visit>
  void for_each_node(Visit&&) const {}

  // For the sweep: calls visit(item) for each item behind `position` in the order that overlaps `box`, the box there.
  template <class Visit>
  void for_each_behind(std::size_t position, const Aabb& box, Visit&& visit) const {
    const OverlapTest test(box);
    const float end = box.high[axis_];
    unsigned lanes = ~0u << (position % kWidth) << 1;
    for (std::size_t i = position / kWidth; i < blocks_.size() && blocks_[i].low[axis_][0] <= end;
         ++i, lanes = ~0u) {
      for (unsigned left = test.mask(blocks_[i]) & lanes; left != 0; left &= left - 1)
        visit(blocks_[i].item[std::countr_zero(left)]);
    }
  }
  std::uint32_t item_at(std::size_t position) const {
    return blocks_[position / kWidth].item[position % kWidth];
  }

 private:
  static constexpr std::size_t kGroup = 16;  // blocks

  // Lanes beyond the last item have a box that nothing overlaps.
  struct alignas(64) Block : BoxLanes {
    std::uint32_t item[kWidth];
  };
  struct Ordered {
    float low;
    std::uint32_t item;
  };

  // The number of blocks that begin at or below `x`; no later block does.
  std::size_t blocks_before(float x) const {
    std::size_t first = 0, last = blocks_.size();
    while (first < last) {
      const std::size_t middle = (first + last) / 2;
      blocks_[middle].low[axis_][0] <= x ? first = middle + 1 : last = middle;
    }
    return first;
  }
  // Calls visit(block), while it returns true, from block `count` - 1 down, for groups whose high end is at least
  // `min_high`.
  template <class Visit>
  void for_each_block_down(std::size_t count, float min_high, Visit&& visit) const {
    for (std::size_t group = (count + kGroup - 1) / kGroup; group-- > 0;) {
      if (running_high_[group] < min_high) return;
      if (group_high_[group] < min_high) continue;
      for (std::size_t i = min(count, (group + 1) * kGroup); i-- > group * kGroup;) {
        if (!visit(blocks_[i])) return;
      }
    }
  }

  int best_axis() const;
  void sort_all();
  void write_blocks();

  Array<Aabb> boxes_;                         // by item
  Array<std::uint8_t> present_;               // by item
  Array<Ordered> order_;                      // between changes includes removed items
  Array<Block> blocks_;                       // in that order
  Array<float> group_high_;                   // by group: highest end of its boxes
  Array<float> running_high_;                 // by group: highest end up to this group
  Array<std::uint64_t> keys_, keys_scratch_;  // of the present sort
  Array<std::uint32_t> values_, values_scratch_;
  ShrinkPolicy clock_;
  std::size_t size_ = 0;
  std::size_t gone_ = 0;
  std::size_t changes_since_axis_ = 0;
  int axis_ = 0;
};

class BroadphaseSap final : public BroadphaseBase<SortedAxis> {
 public:
  void find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved, PairFilter filter,
                  TaskSystem& tasks, Array<std::uint64_t>& pairs) override;

 private:
  Array<std::uint32_t> moved_fixed_;
};

}  // namespace gyre
