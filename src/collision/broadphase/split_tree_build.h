// Builds and changes a split tree; included by the two sources that instantiate one. See split_tree.h.
#pragma once

#include "collision/broadphase/split_tree.h"

#include <limits>

namespace gyre {

template <class Splitter>
std::uint32_t SplitTree<Splitter>::make_node(std::uint32_t parent) {
  const std::uint32_t index = take_slot(nodes_, free_);
  nodes_[index] = Node();
  nodes_[index].parent = parent;
  constexpr float kEnd = std::numeric_limits<float>::infinity();
  for (int i = 0; i < kChildren; ++i) {
    nodes_[index].low[i] = kEnd;
    nodes_[index].high[i] = -kEnd;
  }
  return index;
}

template <class Splitter>
void SplitTree<Splitter>::clear() {
  clear_items();
  nodes_.clear();
  free_.clear();
  root_ = kNone;
}

template <class Splitter>
void SplitTree<Splitter>::widen(Node& node, int child, const Aabb& box) {
  node.low[child] = min(node.low[child], SplitDirections::low(box, node.split.direction));
  node.high[child] = max(node.high[child], SplitDirections::high(box, node.split.direction));
}

template <class Splitter>
void SplitTree<Splitter>::fill_leaf(std::uint32_t index, std::span<const BoxEntry> entries) {
  nodes_[index].leaf = true;
  for (const BoxEntry& entry : entries) put(nodes_[index].items, index, entry.item, entry.box);
}

// Fills an empty node with the entries.
template <class Splitter>
void SplitTree<Splitter>::fill(std::uint32_t index, std::span<BoxEntry> entries, int depth) {
  nodes_[index].count = std::uint32_t(entries.size());
  nodes_[index].arrivals = 0;
  Split split;
  if (entries.size() <= kBuiltLeafSize || depth >= kMaxDepth / 2 || !Splitter::choose_split(entries, split)) {
    fill_leaf(index, entries);
    return;
  }
  // Moves the entries of each child to the front, in one pass each.
  std::size_t begins[kChildren + 1] = {};
  for (int i = 0; i < kChildren; ++i) {
    std::size_t end = begins[i];
    for (std::size_t k = end; k < entries.size(); ++k) {
      if (i + 1 < kChildren && Splitter::child_of(split, entries[k].box) != i) continue;
      const BoxEntry entry = entries[k];
      entries[k] = entries[end];
      entries[end++] = entry;
    }
    begins[i + 1] = end;
  }
  nodes_[index].leaf = false;
  nodes_[index].split = split;
  for (int i = 0; i < kChildren; ++i) {
    const std::span<BoxEntry> group = entries.subspan(begins[i], begins[i + 1] - begins[i]);
    const std::uint32_t child = make_node(index);
    nodes_[index].child[i] = child;
    for (const BoxEntry& entry : group) widen(nodes_[index], i, entry.box);
    fill(child, group, depth + 1);
  }
}

template <class Splitter>
void SplitTree<Splitter>::finish_build() {
  clear();
  if (entries_.empty()) return;
  for (const BoxEntry& entry : entries_) grow_to(entry.item);
  size_ = entries_.size();
  root_ = make_node(kNone);
  fill(root_, entries_, 0);
}

// Appends all items below a node to entries_.
template <class Splitter>
void SplitTree<Splitter>::gather(std::uint32_t index) {
  const Node& node = nodes_[index];
  if (node.is_leaf()) {
    buckets_.for_each(node.items, [&](std::uint32_t item, const Aabb& box, std::uint32_t) {
      entries_.push_back({box, item});
    });
    return;
  }
  for (const std::uint32_t child : node.child) gather(child);
}

// Frees the subtree below a node and its items; the node itself stays, empty.
template <class Splitter>
void SplitTree<Splitter>::free_subtree(std::uint32_t index) {
  Node& node = nodes_[index];
  if (node.is_leaf()) {
    buckets_.free_list(node.items);
    node.items = kNone;
    return;
  }
  for (const std::uint32_t child : node.child) {
    free_subtree(child);
    nodes_[child].used = false;
    free_.push_back(child);
  }
}

template <class Splitter>
void SplitTree<Splitter>::rebuild(std::uint32_t index) {
  int depth = 0;
  for (std::uint32_t above = nodes_[index].parent; above != kNone; above = nodes_[above].parent) ++depth;
  entries_.clear();
  gather(index);
  free_subtree(index);
  constexpr float kEnd = std::numeric_limits<float>::infinity();
  for (int i = 0; i < kChildren; ++i) {
    nodes_[index].low[i] = kEnd;
    nodes_[index].high[i] = -kEnd;
  }
  fill(index, entries_, depth);
}

// The leaf in which a box belongs; widens the extents above it.
template <class Splitter>
std::uint32_t SplitTree<Splitter>::descend(const Aabb& box) {
  std::uint32_t index = root_;
  while (!nodes_[index].is_leaf()) {
    Node& node = nodes_[index];
    const int child = Splitter::child_of(node.split, box);
    widen(node, child, box);
    index = node.child[child];
  }
  return index;
}

template <class Splitter>
void SplitTree<Splitter>::remove_from_leaf(std::uint32_t item) {
  const std::uint32_t leaf = nodes_of_[item];
  take(nodes_[leaf].items, item);
  for (std::uint32_t index = leaf; index != kNone; index = nodes_[index].parent) --nodes_[index].count;
}

// Adds an item to a leaf, and rebuilds the subtree that has degenerated.
template <class Splitter>
void SplitTree<Splitter>::add_to_leaf(std::uint32_t leaf, std::uint32_t item, const Aabb& box) {
  put(nodes_[leaf].items, leaf, item, box);
  std::uint32_t to_rebuild = kNone;
  int depth = 0;
  for (std::uint32_t index = leaf; index != kNone; index = nodes_[index].parent, ++depth) {
    Node& node = nodes_[index];
    ++node.count;
    if (++node.arrivals > max(kMinArrivals, node.count) && !node.is_leaf()) to_rebuild = index;
  }
  const std::uint32_t count = nodes_[leaf].count;
  // A leaf that cannot be split is tried again only at twice its size.
  const bool full = count == kMaxInLeaf + 1 || (count > kMaxInLeaf && (count & (count - 1)) == 0);
  if (full && to_rebuild == kNone) to_rebuild = depth > kMaxDepth / 2 ? root_ : leaf;
  if (to_rebuild != kNone) rebuild(to_rebuild);
}

template <class Splitter>
void SplitTree<Splitter>::insert(std::uint32_t item, const Aabb& box) {
  grow_to(item);
  GYRE_ASSERT(slots_[item] == kNone, "the item is not in the tree yet");
  if (root_ == kNone) root_ = make_node(kNone);
  ++size_;
  add_to_leaf(descend(box), item, box);
}

template <class Splitter>
void SplitTree<Splitter>::remove(std::uint32_t item) {
  GYRE_ASSERT(contains(item), "the item is in the tree");
  remove_from_leaf(item);
  if (--size_ == 0) clear();
}

template <class Splitter>
void SplitTree<Splitter>::move(std::uint32_t item, const Aabb& box) {
  GYRE_ASSERT(contains(item), "the item is in the tree");
  const std::uint32_t leaf = descend(box);
  if (leaf == nodes_of_[item]) {
    buckets_.set_box(slots_[item], box);
    return;
  }
  remove_from_leaf(item);
  add_to_leaf(leaf, item, box);
}

template <class Splitter>
int SplitTree<Splitter>::depth() const {
  int deepest = 0;
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    if (!nodes_[i].used) continue;
    int depth = 0;
    for (std::uint32_t above = i; above != kNone; above = nodes_[above].parent) ++depth;
    deepest = max(deepest, depth);
  }
  return deepest;
}

template <class Splitter>
const char* SplitTree<Splitter>::find_fault() const {
  const char* fault = nullptr;
  std::size_t items = 0, used = 0;
  for (std::uint32_t index = 0; index < nodes_.size(); ++index) {
    const Node& node = nodes_[index];
    if (!node.used) continue;
    ++used;
    if (index != root_ && node.parent == kNone) return "a node has no parent";
    if (!node.is_leaf()) {
      std::uint32_t count = 0;
      for (const std::uint32_t child : node.child) {
        if (nodes_[child].parent != index) return "a node does not know its parent";
        count += nodes_[child].count;
      }
      if (count != node.count) return "the number of a node's items is wrong";
      continue;
    }
    std::uint32_t count = 0;
    buckets_.for_each(node.items, [&](std::uint32_t item, const Aabb& box, std::uint32_t slot) {
      ++count;
      if (slots_[item] != slot || nodes_of_[item] != index) fault = "an item's slot is wrong";
      std::uint32_t below = index;
      for (std::uint32_t above = node.parent; above != kNone; below = above, above = nodes_[above].parent) {
        int lane = 0;
        while (nodes_[above].child[lane] != below) ++lane;
        const int direction = nodes_[above].split.direction;
        if (SplitDirections::low(box, direction) < nodes_[above].low[lane] ||
            SplitDirections::high(box, direction) > nodes_[above].high[lane])
          fault = "an item reaches farther than a node above it knows";
      }
    });
    if (count != node.count) return "the number of a leaf's items is wrong";
    items += count;
  }
  if (fault != nullptr) return fault;
  if (used + free_.size() != nodes_.size()) return "a node is neither in use nor free";
  if (depth() > kMaxDepth) return "nodes lie too deep";
  return items == size_ ? nullptr : "the number of items is wrong";
}

}  // namespace gyre
