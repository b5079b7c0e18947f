// A tree that splits boxes by planes, the base of the kd-tree and the BSP tree. Each node splits its boxes along one
// direction and stores the extent of each child along it; a query enters the children whose extents it overlaps. So a
// box that crosses a plane is neither cut nor stored twice.
//
// Moving boxes widen the extents of their nodes. A subtree that has received as many new items as it contains is
// rebuilt, which bounds depth and overlap.
//
// `Splitter` has kChildren, kDirections, Split {std::uint8_t direction; float value}, child_of(split, box), and
// choose_split(entries, split), which may reorder the entries and returns false if nothing splits them.
#pragma once

#include "collision/broadphase/box_buckets.h"
#include "collision/broadphase/broadphase_base.h"

#include <span>

namespace gyre {

struct Split {
  std::uint8_t direction = 0;
  float value = 0.0f;
};

// The split directions: the axes, the face diagonals and the space diagonals of a cube, not of unit length. The extent
// of a box along one is a sum of its corner coordinates in one order. Sums never decrease when a term grows, so boxes
// with a common point overlap along every direction, whatever the rounding.
struct SplitDirections {
  static constexpr int kCount = 13;
  static constexpr std::int8_t kSigns[kCount][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1}, {1, 1, 0},  {1, -1, 0},
                                                    {1, 0, 1},  {1, 0, -1}, {0, 1, 1}, {0, 1, -1}, {1, 1, 1},
                                                    {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};

  static float low(const Aabb& box, int direction) {
    float sum = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const int sign = kSigns[direction][axis];
      if (sign > 0) sum += box.low[axis];
      if (sign < 0) sum -= box.high[axis];
    }
    return sum;
  }
  static float high(const Aabb& box, int direction) {
    float sum = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const int sign = kSigns[direction][axis];
      if (sign > 0) sum += box.high[axis];
      if (sign < 0) sum -= box.low[axis];
    }
    return sum;
  }
};

template <class Splitter>
class SplitTree : public BucketIndex {
 public:
  static constexpr std::size_t kRebuildShare = Splitter::kRebuildShare;

  void clear();
  void finish_build();
  void insert(std::uint32_t item, const Aabb& box);
  void remove(std::uint32_t item);
  void move(std::uint32_t item, const Aabb& box);
  void improve(std::size_t) {}
  const char* find_fault() const;
  std::size_t bytes() const { return item_bytes() + nodes_.bytes() + free_.bytes(); }
  // The number of levels.
  int depth() const;

  template <class Visit>
  void for_each_overlap(const Aabb& box, Visit&& visit) const {
    if (root_ == kNone) return;
    float low[Splitter::kDirections], high[Splitter::kDirections];
    for (int i = 0; i < Splitter::kDirections; ++i) {
      low[i] = SplitDirections::low(box, i);
      high[i] = SplitDirections::high(box, i);
    }
    std::uint32_t stack[kStackSize];
    int depth = 0;
    stack[depth++] = root_;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (node.is_leaf()) {
        buckets_.for_each_overlap(node.items, box, [&](std::uint32_t item, std::uint32_t) { visit(item); });
        continue;
      }
      const int direction = node.split.direction;
      for (int i = 0; i < kChildren; ++i) {
        if (node.low[i] <= high[direction] && node.high[i] >= low[direction]) stack[depth++] = node.child[i];
      }
    }
  }

  template <class Visit>
  float for_each_along(const CastTest& cast_test, float max_fraction, Visit&& visit) const {
    if (root_ == kNone) return max_fraction;
    struct Waiting {
      std::uint32_t node;
      CastRange range;
    };
    Waiting stack[kStackSize];
    int depth = 0;
    stack[depth++] = {root_, {0.0f, max_fraction}};
    while (depth > 0) {
      Waiting next = stack[--depth];
      next.range.leave = min(next.range.leave, max_fraction);
      if (next.range.is_empty()) continue;
      const Node& node = nodes_[next.node];
      if (node.is_leaf()) {
        max_fraction = buckets_.for_each_along(
            node.items, cast_test, max_fraction,
            [&](std::uint32_t item, float so_far, std::uint32_t) { return visit(item, so_far); });
        if (max_fraction < 0.0f) return max_fraction;
        continue;
      }
      const int bottom = depth;
      for (int i = 0; i < kChildren; ++i) {
        CastRange range = next.range;
        if (!(node.low[i] <= node.high[i])) continue;
        clip(cast_test, node, i, range);
        if (range.is_empty()) continue;
        int k = depth++;
        for (; k > bottom && stack[k - 1].range.enter <= range.enter; --k) stack[k] = stack[k - 1];
        stack[k] = {node.child[i], range};
      }
    }
    return max_fraction;
  }

  // The bounds of the items below each inner node.
  template <class Visit>
  void for_each_node(Visit&& visit) const {
    if (root_ != kNone) visit_node(root_, 0, visit);
  }

 private:
  static constexpr int kChildren = Splitter::kChildren;
  static constexpr std::uint32_t kMaxInLeaf = 32;
  static constexpr std::uint32_t kBuiltLeafSize = 16;  // of a new leaf
  static constexpr std::uint32_t kMinArrivals = 64;
  static constexpr int kMaxDepth = 96;
  static constexpr int kStackSize = (kMaxDepth + 2) * kChildren;

  struct Node {
    Split split;
    std::uint32_t parent = kNone;
    std::uint32_t items = kNone;  // of a leaf: a list of buckets_
    std::uint32_t count = 0;      // items below
    std::uint32_t arrivals = 0;   // since it was built
    std::uint32_t child[kChildren] = {};
    float low[kChildren];
    float high[kChildren];
    bool leaf = true;
    bool used = true;

    bool is_leaf() const { return leaf; }
  };

  static void clip(const CastTest& cast_test, const Node& node, int child, CastRange& range) {
    const int direction = node.split.direction;
    if (direction < 3) {
      cast_test.clip(direction, node.low[child], node.high[child], range);
    } else {
      cast_test.clip_along(SplitDirections::kSigns[direction], node.low[child], node.high[child], range);
    }
  }
  template <class Visit>
  Aabb visit_node(std::uint32_t index, int depth, Visit&& visit) const;

  std::uint32_t make_node(std::uint32_t parent);
  void free_subtree(std::uint32_t index);
  void gather(std::uint32_t index);
  void fill(std::uint32_t index, std::span<BoxEntry> entries, int depth);
  void fill_leaf(std::uint32_t index, std::span<const BoxEntry> entries);
  void rebuild(std::uint32_t index);
  std::uint32_t descend(const Aabb& box);
  void add_to_leaf(std::uint32_t leaf, std::uint32_t item, const Aabb& box);
  void remove_from_leaf(std::uint32_t item);
  void widen(Node& node, int child, const Aabb& box);

  Array<Node> nodes_;
  Array<std::uint32_t> free_;
  std::uint32_t root_ = kNone;
};

template <class Splitter>
template <class Visit>
Aabb SplitTree<Splitter>::visit_node(std::uint32_t index, int depth, Visit&& visit) const {
  const Node& node = nodes_[index];
  constexpr float kEnd = std::numeric_limits<float>::infinity();
  Aabb all{{kEnd, kEnd, kEnd}, {-kEnd, -kEnd, -kEnd}};
  if (node.is_leaf()) {
    buckets_.for_each(node.items,
                      [&](std::uint32_t, const Aabb& box, std::uint32_t) { all = merge(all, box); });
  } else {
    for (const std::uint32_t child : node.child) all = merge(all, visit_node(child, depth + 1, visit));
  }
  if (all.low.x <= all.high.x) visit(all, depth);
  return all;
}

}  // namespace gyre
