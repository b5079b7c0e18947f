// A loose tree of cubes: each cell has cells of half its side below it and takes boxes that extend beyond it by up to
// half its side. So any box that is not larger than a cell fits the cell that contains its centre, which is found
// without a search. With three axes it is the loose octree. With two (x and z, for flat worlds) it is the loose
// quadtree, whose cells are endless columns.
//
// A cell is split when it would contain more than a few dozen boxes, and removed when it is empty. The root doubles its
// side when a box lies outside.
//
// Sources: R. Finkel, J. Bentley, "Quad Trees: A Data Structure for Retrieval on Composite Keys", 1974; T. Ulrich,
// "Loose Octrees", Game Programming Gems, 2000.
#pragma once

#include "collision/broadphase/box_buckets.h"
#include "collision/broadphase/broadphase_base.h"

#include <limits>

namespace gyre {

template <int kAxes>
class LooseTree : public BucketIndex {
  static_assert(kAxes == 2 || kAxes == 3);

 public:
  static constexpr std::size_t kRebuildShare = 1;  // moving is as cheap as building

  void clear();
  void finish_build();
  void insert(std::uint32_t item, const Aabb& box);
  void remove(std::uint32_t item);
  void move(std::uint32_t item, const Aabb& box);
  void improve(std::size_t) {}
  const char* find_fault() const;
  std::size_t bytes() const { return item_bytes() + nodes_.bytes() + free_.bytes(); }

  template <class Visit>
  void for_each_overlap(const Aabb& box, Visit&& visit) const {
    if (root_ == kNone) return;
    std::uint32_t stack[kStackSize];
    int depth = 0;
    stack[depth++] = root_;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      buckets_.for_each_overlap(node.items, box, [&](std::uint32_t item, std::uint32_t) { visit(item); });
      if (node.children == 0) continue;
      for (int i = 0; i < kChildren; ++i) {
        if (node.child[i] != kNone && overlap(loose_box(cell_of_child(node.cell, i)), box))
          stack[depth++] = node.child[i];
      }
    }
  }

  template <class Visit>
  float for_each_along(const CastTest& cast_test, float max_fraction, Visit&& visit) const {
    if (root_ == kNone) return max_fraction;
    struct Waiting {
      std::uint32_t node;
      float enter;
    };
    Waiting stack[kStackSize];
    int depth = 0;
    stack[depth++] = {root_, 0.0f};
    while (depth > 0) {
      const Waiting next = stack[--depth];
      if (!(next.enter <= max_fraction * 1.00001f)) continue;
      const Node& node = nodes_[next.node];
      max_fraction = buckets_.for_each_along(
          node.items, cast_test, max_fraction,
          [&](std::uint32_t item, float so_far, std::uint32_t) { return visit(item, so_far); });
      if (max_fraction < 0.0f) return max_fraction;
      const int bottom = depth;
      for (int i = 0; i < kChildren; ++i) {
        if (node.child[i] == kNone) continue;
        const CastRange range = cast_test.clip(loose_box(cell_of_child(node.cell, i)), {0.0f, max_fraction});
        if (range.is_empty()) continue;
        int k = depth++;
        for (; k > bottom && stack[k - 1].enter <= range.enter; --k) stack[k] = stack[k - 1];
        stack[k] = {node.child[i], range.enter};
      }
    }
    return max_fraction;
  }

  // The cells without their loose margin; those of a quadtree are as high as all boxes together.
  template <class Visit>
  void for_each_node(Visit&& visit) const;

 private:
  static constexpr int kChildren = 1 << kAxes;
  static constexpr int kAxis[3] = {0, kAxes == 3 ? 1 : 2, 2};
  static constexpr std::uint32_t kSplitAbove = 32;  // items of a cell before it is split
  static constexpr int kLowestLevel = -24;          // sides of 2^level metres
  static constexpr int kHighestLevel = 126;
  static constexpr int kStackSize = (kHighestLevel - kLowestLevel + 1) * (kChildren - 1) + 1;

  // Corners are multiples of the side; both are exact.
  struct Cell {
    float low[kAxes];
    float side;
  };
  struct Node {
    Cell cell;
    int level = 0;
    std::uint32_t parent = kNone;
    std::uint32_t items = kNone;  // a list of buckets_
    std::uint32_t count = 0;      // in that list
    std::uint32_t child[kChildren];
    std::uint8_t children = 0;
    std::uint8_t lane = 0;  // in the parent
    bool is_split = false;  // items that fit a child go there
    bool used = true;
  };

  static Aabb loose_box(const Cell& cell) {
    constexpr float kEnd = std::numeric_limits<float>::infinity();
    float low[3] = {-kEnd, -kEnd, -kEnd}, high[3] = {kEnd, kEnd, kEnd};
    const float half = 0.5f * cell.side;
    for (int i = 0; i < kAxes; ++i) {
      low[kAxis[i]] = cell.low[i] - half;
      high[kAxis[i]] = cell.low[i] + cell.side + half;
    }
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
  }
  static Cell cell_of_child(const Cell& cell, int lane) {
    Cell child{};
    child.side = 0.5f * cell.side;
    for (int i = 0; i < kAxes; ++i)
      child.low[i] = (lane >> i & 1) != 0 ? cell.low[i] + child.side : cell.low[i];
    return child;
  }
  // The child that contains the centre of `box`.
  static int lane_for(const Cell& cell, const Aabb& box) {
    int lane = 0;
    for (int i = 0; i < kAxes; ++i) {
      const int axis = kAxis[i];
      const float middle = cell.low[i] + 0.5f * cell.side;
      if (0.5f * box.low[axis] + 0.5f * box.high[axis] >= middle) lane |= 1 << i;
    }
    return lane;
  }

  static bool fits(const Cell& cell, const Aabb& box);
  std::uint32_t make_node(const Cell& cell, int level);
  void make_root(const Aabb& box);
  void enlarge_root(const Aabb& box);
  bool fits_child(const Node& node, const Aabb& box, int& lane) const;
  void insert_below(std::uint32_t node, std::uint32_t item, const Aabb& box);
  std::uint32_t child_in(std::uint32_t node, int lane);
  std::uint32_t split(std::uint32_t node);
  void drop_empty(std::uint32_t node);

  Array<Node> nodes_;
  Array<std::uint32_t> free_;
  std::uint32_t root_ = kNone;
};

template <int kAxes>
template <class Visit>
void LooseTree<kAxes>::for_each_node(Visit&& visit) const {
  if (root_ == kNone) return;
  float lowest = std::numeric_limits<float>::max(), highest = -lowest;
  for (const Node& node : nodes_) {
    if (!node.used) continue;
    buckets_.for_each(node.items, [&](std::uint32_t, const Aabb& box, std::uint32_t) {
      lowest = min(lowest, box.low.y);
      highest = max(highest, box.high.y);
    });
  }
  std::uint32_t stack[kStackSize];
  int depth = 0;
  stack[depth++] = root_;
  while (depth > 0) {
    const Node& node = nodes_[stack[--depth]];
    float low[3] = {0.0f, lowest, 0.0f}, high[3] = {0.0f, highest, 0.0f};
    for (int i = 0; i < kAxes; ++i) {
      low[kAxis[i]] = node.cell.low[i];
      high[kAxis[i]] = node.cell.low[i] + node.cell.side;
    }
    visit(Aabb{{low[0], low[1], low[2]}, {high[0], high[1], high[2]}}, nodes_[root_].level - node.level);
    for (int i = kChildren - 1; i >= 0; --i) {
      if (node.child[i] != kNone) stack[depth++] = node.child[i];
    }
  }
}

using LooseOctree = LooseTree<3>;
using LooseQuadtree = LooseTree<2>;

extern template class LooseTree<2>;
extern template class LooseTree<3>;

}  // namespace gyre
