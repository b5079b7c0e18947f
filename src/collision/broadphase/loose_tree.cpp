// Creates and removes cells. See loose_tree.h.
#include "collision/broadphase/loose_tree.h"

namespace gyre {
namespace {

float side_of_level(int level) {
  float side = 1.0f;
  for (int i = 0; i < level; ++i) side *= 2.0f;
  for (int i = 0; i > level; --i) side *= 0.5f;
  return side;
}

// The multiple of `side` at or below x.
float multiple_below(float x, float side) {
  const float whole = float(std::int64_t(x / side));
  return (whole > x / side ? whole - 1.0f : whole) * side;
}

}  // namespace

template <int kAxes>
std::uint32_t LooseTree<kAxes>::make_node(const Cell& cell, int level) {
  const std::uint32_t index = take_slot(nodes_, free_);
  Node& node = nodes_[index];
  node = Node();
  node.cell = cell;
  node.level = level;
  for (std::uint32_t& child : node.child) child = kNone;
  return index;
}

template <int kAxes>
void LooseTree<kAxes>::clear() {
  clear_items();
  nodes_.clear();
  free_.clear();
  root_ = kNone;
}

// Makes the first cell around the box, large relative to the last digit of its position, so that corners are exact.
template <int kAxes>
void LooseTree<kAxes>::make_root(const Aabb& box) {
  float size = 0.0f, coordinate = 0.0f;
  for (int i = 0; i < kAxes; ++i) {
    const int axis = kAxis[i];
    size = max(size, box.high[axis] - box.low[axis]);
    coordinate = max(coordinate, max(absolute(box.low[axis]), absolute(box.high[axis])));
  }
  const float min_side = max(1.125f * size, coordinate * (1.0f / 65536.0f));
  int level = kLowestLevel;
  float side = side_of_level(level);
  while (side < min_side && level < kHighestLevel) {
    side *= 2.0f;
    ++level;
  }
  Cell cell{};
  cell.side = side;
  for (int i = 0; i < kAxes; ++i) cell.low[i] = multiple_below(box.low[kAxis[i]], 0.0625f * side);
  root_ = make_node(cell, level);
}

// True if the cell contains the box's centre and the box does not extend too far beyond it.
template <int kAxes>
bool LooseTree<kAxes>::fits(const Cell& cell, const Aabb& box) {
  for (int i = 0; i < kAxes; ++i) {
    const float middle = 0.5f * box.low[kAxis[i]] + 0.5f * box.high[kAxis[i]];
    if (!(middle >= cell.low[i] && middle <= cell.low[i] + cell.side)) return false;
  }
  return gyre::contains(loose_box(cell), box);
}

template <int kAxes>
void LooseTree<kAxes>::enlarge_root(const Aabb& box) {
  while (!fits(nodes_[root_].cell, box) && nodes_[root_].level < kHighestLevel) {
    const std::uint32_t old = root_;
    const Cell small = nodes_[old].cell;
    Cell large{};
    large.side = 2.0f * small.side;
    int lane = 0;
    for (int i = 0; i < kAxes; ++i) {
      const float middle = small.low[i] + 0.5f * small.side;
      const bool grows_down = 0.5f * box.low[kAxis[i]] + 0.5f * box.high[kAxis[i]] < middle;
      large.low[i] = grows_down ? small.low[i] - small.side : small.low[i];
      if (grows_down) lane |= 1 << i;
    }
    root_ = make_node(large, nodes_[old].level + 1);
    Node& root = nodes_[root_];
    root.child[lane] = old;
    root.children = 1;
    root.is_split = true;
    nodes_[old].parent = root_;
    nodes_[old].lane = std::uint8_t(lane);
  }
}

template <int kAxes>
void LooseTree<kAxes>::finish_build() {
  clear();
  if (entries_.empty()) return;
  Aabb all = entries_[0].box;
  for (const BoxEntry& entry : entries_) all = merge(all, entry.box);
  make_root(all);
  for (const BoxEntry& entry : entries_) insert(entry.item, entry.box);
}

template <int kAxes>
bool LooseTree<kAxes>::fits_child(const Node& node, const Aabb& box, int& lane) const {
  if (node.level <= kLowestLevel) return false;
  // Positions here have no digits for smaller cells.
  const float eighth = 0.125f * node.cell.side;
  for (const float low : node.cell.low) {
    if (low + eighth - low != eighth) return false;
  }
  lane = lane_for(node.cell, box);
  return gyre::contains(loose_box(cell_of_child(node.cell, lane)), box);
}

// The child in a lane, created if missing.
template <int kAxes>
std::uint32_t LooseTree<kAxes>::child_in(std::uint32_t index, int lane) {
  if (nodes_[index].child[lane] == kNone) {
    const std::uint32_t made = make_node(cell_of_child(nodes_[index].cell, lane), nodes_[index].level - 1);
    nodes_[made].parent = index;
    nodes_[made].lane = std::uint8_t(lane);
    nodes_[index].child[lane] = made;
    ++nodes_[index].children;
  }
  return nodes_[index].child[lane];
}

// Puts an item that fits the node into the lowest cell below it.
template <int kAxes>
void LooseTree<kAxes>::insert_below(std::uint32_t index, std::uint32_t item, const Aabb& box) {
  int lane = 0;
  while (nodes_[index].is_split && fits_child(nodes_[index], box, lane)) index = child_in(index, lane);
  put(nodes_[index].items, index, item, box);
  ++nodes_[index].count;
  while (index != kNone && nodes_[index].count > kSplitAbove && !nodes_[index].is_split) index = split(index);
}

// Moves items that fit children into them. Returns a child that has too many items now, if any.
template <int kAxes>
std::uint32_t LooseTree<kAxes>::split(std::uint32_t index) {
  nodes_[index].is_split = true;
  BoxEntry entries[kSplitAbove + 1];
  std::uint32_t count = 0;
  buckets_.for_each(nodes_[index].items, [&](std::uint32_t item, const Aabb& box, std::uint32_t) {
    entries[count++] = {box, item};
  });
  std::uint32_t full = kNone;
  for (std::uint32_t i = 0; i < count; ++i) {
    int lane = 0;
    if (!fits_child(nodes_[index], entries[i].box, lane)) continue;
    const std::uint32_t child = child_in(index, lane);
    take(nodes_[index].items, entries[i].item);
    --nodes_[index].count;
    put(nodes_[child].items, child, entries[i].item, entries[i].box);
    if (++nodes_[child].count > kSplitAbove) full = child;
  }
  return full;
}

template <int kAxes>
void LooseTree<kAxes>::insert(std::uint32_t item, const Aabb& box) {
  grow_to(item);
  GYRE_ASSERT(slots_[item] == kNone, "the item is not in the tree yet");
  if (root_ == kNone) make_root(box);
  if (!fits(nodes_[root_].cell, box)) enlarge_root(box);
  insert_below(root_, item, box);
  ++size_;
}

template <int kAxes>
void LooseTree<kAxes>::drop_empty(std::uint32_t index) {
  while (nodes_[index].count == 0 && nodes_[index].children == 0) {
    const std::uint32_t parent = nodes_[index].parent;
    nodes_[index].used = false;
    free_.push_back(index);
    if (parent == kNone) {
      root_ = kNone;
      return;
    }
    nodes_[parent].child[nodes_[index].lane] = kNone;
    --nodes_[parent].children;
    index = parent;
  }
}

template <int kAxes>
void LooseTree<kAxes>::remove(std::uint32_t item) {
  GYRE_ASSERT(contains(item), "the item is in the tree");
  const std::uint32_t node = nodes_of_[item];
  take(nodes_[node].items, item);
  --nodes_[node].count;
  --size_;
  drop_empty(node);
}

template <int kAxes>
void LooseTree<kAxes>::move(std::uint32_t item, const Aabb& box) {
  GYRE_ASSERT(contains(item), "the item is in the tree");
  const std::uint32_t index = nodes_of_[item];
  const Node& node = nodes_[index];
  int lane = 0;
  if (gyre::contains(loose_box(node.cell), box) && !(node.is_split && fits_child(node, box, lane))) {
    buckets_.set_box(slots_[item], box);
    return;
  }
  remove(item);
  insert(item, box);
}

template <int kAxes>
const char* LooseTree<kAxes>::find_fault() const {
  std::size_t items = 0, used = 0;
  const char* fault = nullptr;
  for (std::uint32_t index = 0; index < nodes_.size(); ++index) {
    const Node& node = nodes_[index];
    if (!node.used) continue;
    ++used;
    if (index != root_ && (node.parent == kNone || nodes_[node.parent].child[node.lane] != index))
      return "a cell has no parent";
    if (node.count == 0 && node.children == 0) return "an empty cell exists";
    std::uint32_t count = 0;
    buckets_.for_each(node.items, [&](std::uint32_t item, const Aabb& box, std::uint32_t at) {
      ++count;
      if (slots_[item] != at || nodes_of_[item] != index) fault = "an item's slot is wrong";
      const bool whole_range = index == root_ && node.level == kHighestLevel;
      if (!whole_range && !gyre::contains(loose_box(node.cell), box))
        fault = "an item reaches too far out of its cell";
    });
    if (count != node.count) fault = "the number of a cell's items is wrong";
    items += count;
    std::uint8_t children = 0;
    for (int i = 0; i < kChildren; ++i) {
      if (node.child[i] == kNone) continue;
      ++children;
      const Cell cell = cell_of_child(node.cell, i);
      for (int axis = 0; axis < kAxes; ++axis) {
        if (nodes_[node.child[i]].cell.low[axis] != cell.low[axis])
          fault = "a cell is not where it should be";
      }
    }
    if (children != node.children) fault = "the number of a cell's children is wrong";
  }
  if (fault != nullptr) return fault;
  if (used + free_.size() != nodes_.size()) return "a cell is neither in use nor free";
  return items == size_ ? nullptr : "the number of items is wrong";
}

template class LooseTree<2>;
template class LooseTree<3>;

}  // namespace gyre
