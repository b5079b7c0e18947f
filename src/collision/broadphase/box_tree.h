// A bounding volume hierarchy of moving boxes with eight boxes a node, side by side, so that one loop tests them all.
// All leaves lie at the same depth, as in a B-tree, so the tree cannot degenerate under any insertions and removals.
//
// In: items (small indices) with boxes. Out: the items whose boxes overlap a box or a cast. A box that stays inside its
// node's box changes in place; others are removed and inserted. Overfull nodes are split so that the surfaces of both
// halves are smallest. Each improve() regroups the grandchildren of a few nodes, in turn, which maintains the quality
// at a bounded cost a step. Many items at once are built from the top by halving along the longest side. If many boxes
// move but little against each other, the nodes are only refitted.
//
// The set of items found never depends on the shape of the tree, only their order does.
//
// Sources: A. Guttman, "R-Trees", 1984; N. Beckmann et al., "The R*-Tree", 1990 (choice of split by surface); I. Wald
// et al., "Getting Rid of Packets: Efficient SIMD Single-Ray Traversal using Multi-branching BVHs", 2008.
#pragma once

#include "base/arena/shrink_policy.h"
#include "base/container/array.h"
#include "collision/broadphase/box_lanes.h"
#include "collision/broadphase/box_walk.h"
#include "collision/broadphase/cast_box.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

class BoxTree {
 public:
  static constexpr int kWidth = BoxLanes::kWidth;
  static constexpr std::size_t kRebuildShare = 4;  // a build is cheaper if more than a quarter changes

  std::size_t size() const { return size_; }
  bool contains(std::uint32_t item) const { return item < slots_.size() && slots_[item] != kNowhere; }

  void clear();
  // Rebuilds the whole tree: items[i] has boxes[i].
  void build(std::span<const std::uint32_t> items, std::span<const Aabb> boxes);
  // The same for items one by one: begin_build(), add_to_build() for each, finish_build().
  void begin_build() {
    clear();
    entries_.clear();
  }
  void add_to_build(std::uint32_t item, const Aabb& box) { entries_.push_back({box, item}); }
  void finish_build();
  // To be called once a step: releases the memory of builds if there was no build for long.
  void trim() {
    clock_.trim(entries_, entries_.size());
    entries_.clear();
  }
  void insert(std::uint32_t item, const Aabb& box);
  void remove(std::uint32_t item);
  // Changes the box of an item in the tree.
  void move(std::uint32_t item, const Aabb& box);
  // Changes many boxes at once without insertions or removals: set_box() for each, then refit() before any query.
  // refit() returns false once the nodes are so loose that the tree should be rebuilt.
  void set_box(std::uint32_t item, const Aabb& box) {
    set_lane_box(nodes_[slots_[item] / kWidth], int(slots_[item] % kWidth), box);
  }
  bool refit();
  // Regroups the children of a few inner nodes, in turn: one node, and more after many changes.
  void improve(std::size_t changes);

  // Calls visit(item) for each item whose box overlaps `box`.
  template <class Visit>
  void for_each_overlap(const Aabb& box, Visit&& visit) const {
    if (size_ == 0) return;
    BoxWalk walk(box, root_);
    do {
      walk_boxes_(nodes_.data(), walk);
      for (int i = 0; i < walk.found_count; ++i) visit(walk.found[i]);
    } while (walk.depth > 0);
  }

  // Calls visit(item, max_fraction) for each item whose box the cast may touch from t = 0 to `max_fraction`, roughly
  // from near to far. visit returns the new max_fraction, below 0 to end. Returns the last one.
  template <class Visit>
  float for_each_along(const CastTest& cast_test, float max_fraction, Visit&& visit) const {
    if (size_ == 0) return max_fraction;
    static_assert(kMaxLevels * kWidth <= RayTraversal::kRoom);
    RayTraversal walk(cast_test.line(), root_, max_fraction);
    while (walk_line_(nodes_.data(), walk)) {
      walk.max_fraction = visit(walk.leaf, walk.max_fraction);
      if (walk.max_fraction < 0.0f) break;
    }
    return walk.max_fraction;
  }

  // The box of an item that is in the tree.
  Aabb box_of(std::uint32_t item) const {
    return lane_box(nodes_[slots_[item] / kWidth], int(slots_[item] % kWidth));
  }
  // Calls visit(box, depth) for every node, from the root (depth 0) down.
  template <class Visit>
  void for_each_node(Visit&& visit) const {
    if (size_ == 0) return;
    std::uint32_t stack[kMaxLevels * kWidth];
    int depth = 0;
    stack[depth++] = root_;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      visit(bounds_of(node), int(nodes_[root_].level) - int(node.level));
      if (node.level == 0) continue;
      for (int lane = int(node.count) - 1; lane >= 0; --lane) stack[depth++] = node.child[lane];
    }
  }

  // Null if all nodes are right, otherwise the fault in words. Visits everything: for tests and debug builds.
  const char* find_fault() const;
  // Sum of the surfaces of inner nodes over the root's: roughly the number of nodes that a query visits.
  double cost() const;
  std::size_t bytes() const { return nodes_.bytes() + slots_.bytes() + free_.bytes() + entries_.bytes(); }

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffffu;
  static constexpr int kMaxLevels = BoxWalk::kMaxLevels;
  static constexpr int kMinInHalf = 3;

  using Node = BoxTreeNode;

  // A child between two nodes.
  struct Entry {
    Aabb box;
    std::uint32_t child;
  };

  static Aabb bounds_of(const Node& node);

  float refit_nodes();
  std::uint32_t make_node(int level);
  void free_node(std::uint32_t index);
  void set_child(std::uint32_t node, int lane, const Entry& entry);
  void append_child(std::uint32_t node, const Entry& entry);
  void remove_lane(std::uint32_t node, int lane);
  void refit_up(std::uint32_t node);
  void insert_entry(const Entry& entry);
  void add_or_split(std::uint32_t node, Entry entry);
  std::uint32_t split(std::uint32_t node, const Entry& extra);
  void shorten_root();
  void regroup(std::uint32_t node);
  std::uint32_t build_node(std::span<Entry> entries, int level, int lowest);
  const char* find_fault(std::uint32_t node, std::size_t& items) const;

  WalkBoxes walk_boxes_ = select_box_walk();
  RayTraversalKernel<BoxTreeNode> walk_line_ = select_box_ray_traversal();
  Array<Node> nodes_;
  Array<std::uint32_t> free_;
  Array<std::uint32_t> slots_;  // by item: kWidth * node + lane, or kNowhere
  Array<Entry> entries_;        // of the present build
  ShrinkPolicy clock_;
  std::uint32_t root_ = kNowhere;
  std::uint32_t next_improved_ = 0;
  float looseness_ = 0.0f;  // surface of the nodes over that of the boxes when it was built
  std::size_t size_ = 0;
};

// Moves the entries with the lowest centres along `axis` into the first `middle` positions: quickselect, median of
// three. The result is a function of the input alone.
template <class Entry>
void partition_by_center(std::span<Entry> entries, std::size_t middle, int axis) {
  const auto key = [axis](const Entry& entry) { return entry.box.low[axis] + entry.box.high[axis]; };
  std::size_t low = 0, high = entries.size();
  while (high - low > 1) {
    const float a = key(entries[low]), b = key(entries[low + (high - low) / 2]), c = key(entries[high - 1]);
    const float pivot = a < b ? (b < c ? b : (a < c ? c : a)) : (a < c ? a : (b < c ? c : b));
    std::size_t i = low, k = high - 1;
    for (;;) {
      while (key(entries[i]) < pivot) ++i;
      while (pivot < key(entries[k])) --k;
      if (i >= k) break;
      const Entry swapped = entries[i];
      entries[i++] = entries[k];
      entries[k--] = swapped;
    }
    // Entries in [low, i) are not above the pivot, those in [i, high) not below it; one equal to it may stand between
    // them.
    const std::size_t cut = i == low ? low + 1 : i;
    if (middle < cut) {
      high = cut;
    } else {
      low = cut;
    }
  }
}

}  // namespace gyre
