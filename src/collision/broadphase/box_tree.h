// A wide tree of moving boxes: eight boxes a node, side by side, so that one loop tests them all. All leaves lie at the
// same depth, as in a B-tree, so the tree cannot degenerate whatever is inserted and removed.
//
// In: items (small indices) with boxes. Out: walks over the items whose boxes overlap a box. A box that stays inside its
// node's is changed in place; others are taken out and put in again. Nodes that overflow are split where the two halves'
// surfaces are smallest. Each improve() regroups the grandchildren of a few nodes, in turn, so quality is kept up by
// bounded work a step. Many items at once are built from the top by halving along the longest side; where many of them move, but
// little against each other, nodes are only made to fit again.
//
// Which items a walk finds never depends on the tree's shape, only their order does.
//
// Sources: A. Guttman, "R-Trees", 1984; N. Beckmann et al., "The R*-Tree", 1990 (choice of split by surface);
// I. Wald et al., "Getting Rid of Packets: Efficient SIMD Single-Ray Traversal using Multi-branching BVHs", 2008.
#pragma once

#include "base/arena/shrink_policy.h"
#include "base/container/array.h"
#include "collision/broadphase/box_lanes.h"
#include "collision/broadphase/box_sweep.h"
#include "collision/broadphase/box_walk.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

class BoxTree {
 public:
  static constexpr int kWidth = BoxLanes::kWidth;
  static constexpr std::size_t kRebuildShare = 4;  // building is cheaper when more than a quarter changes

  std::size_t size() const { return size_; }
  bool contains(std::uint32_t item) const { return item < places_.size() && places_[item] != kNowhere; }

  void clear();
  // Forgets everything and builds anew: items[i] has boxes[i].
  void build(std::span<const std::uint32_t> items, std::span<const Aabb> boxes);
  // The same for items that come one by one: begin_build(), add_to_build() for each, finish_build().
  void begin_build() {
    clear();
    entries_.clear();
  }
  void add_to_build(std::uint32_t item, const Aabb& box) { entries_.push_back({box, item}); }
  void finish_build();
  // To be called once a step: what a build needed is given back when none came for long.
  void trim() {
    clock_.trim(entries_, entries_.size());
    entries_.clear();
  }
  void insert(std::uint32_t item, const Aabb& box);
  void remove(std::uint32_t item);
  // Gives an item that is in the tree another box.
  void move(std::uint32_t item, const Aabb& box);
  // Many boxes at once, nothing in or out: place() for each, and then refit() before anything is asked. False once the nodes have
  // grown so much against the boxes in them that the tree should be built anew.
  void place(std::uint32_t item, const Aabb& box) {
    set_lane_box(nodes_[places_[item] / kWidth], int(places_[item] % kWidth), box);
  }
  bool refit();
  // Regroups the children of a few inner nodes, going round the tree from call to call: one, and more after many changes.
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

  // Calls visit(item, reach) for each item whose box the sweep may touch from t = 0 to `reach`, roughly from near to far; it
  // returns the new reach, below 0 to end the walk. Returns the last one.
  template <class Visit>
  float for_each_along(const SweepTest& sweep, float reach, Visit&& visit) const {
    if (size_ == 0) return reach;
    static_assert(kMaxLevels * kWidth <= RayTraversal::kRoom);
    RayTraversal walk(sweep.line(), root_, reach);
    while (walk_line_(nodes_.data(), walk)) {
      walk.max_fraction = visit(walk.leaf, walk.max_fraction);
      if (walk.max_fraction < 0.0f) break;
    }
    return walk.max_fraction;
  }

  // The box of an item that is in the tree.
  Aabb box_of(std::uint32_t item) const {
    return lane_box(nodes_[places_[item] / kWidth], int(places_[item] % kWidth));
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

  // Null if all nodes hold what they should, otherwise what is wrong. Walks everything: for tests and debug builds.
  const char* find_fault() const;
  // Sum over inner nodes of their boxes' surface over the root's: how many nodes a walk meets, roughly.
  double cost() const;
  std::size_t bytes() const { return nodes_.bytes() + places_.bytes() + free_.bytes() + entries_.bytes(); }

 private:
  static constexpr std::uint32_t kNowhere = 0xffffffffu;
  static constexpr int kMaxLevels = BoxWalk::kMaxLevels;
  static constexpr int kMinInHalf = 3;

  using Node = BoxTreeNode;

  // A child on its way from node to node.
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
  Array<std::uint32_t> places_;  // by item: kWidth * node + lane, or kNowhere
  Array<Entry> entries_;         // of the present build
  ShrinkPolicy clock_;
  std::uint32_t root_ = kNowhere;
  std::uint32_t next_improved_ = 0;
  float looseness_ = 0.0f;  // when it was built: surface of the nodes over that of the boxes
  std::size_t size_ = 0;
};

// Puts the entries that belong into the lower `middle` places there, by their boxes' centres along `axis`: quickselect,
// median of three. The result is a function of the input alone.
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
    // [low, i) is not above the pivot, [i, high) not below it; between them may stand one equal to it.
    const std::size_t cut = i == low ? low + 1 : i;
    if (middle < cut) {
      high = cut;
    } else {
      low = cut;
    }
  }
}

}  // namespace gyre
