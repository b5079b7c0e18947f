// Builds, changes and maintains the wide tree. See box_tree.h.
#include "collision/broadphase/box_tree.h"

#include <limits>

namespace gyre {
namespace {

// Children of a new node; the remaining lanes are for later children.
constexpr std::size_t kFill = 6;

// After refits the tree is rebuilt once the surface of its nodes, relative to that of their items, has grown by this
// factor.
constexpr float kMaxLooseness = 1.2f;

// Items below a node of this level when it is built.
std::size_t room_of(int level) {
  std::size_t room = kFill;
  for (int i = 0; i < level; ++i) room *= kFill;
  return room;
}

template <class Entry>
int longest_axis(std::span<const Entry> entries) {
  Vec3 low = entries[0].box.low + entries[0].box.high;
  Vec3 high = low;
  for (const Entry& entry : entries) {
    const Vec3 middle = entry.box.low + entry.box.high;
    low = min(low, middle);
    high = max(high, middle);
  }
  const Vec3 d = high - low;
  return d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
}

template <class Entry>
float area_of(std::span<const Entry> entries) {
  Aabb box = entries[0].box;
  for (const Entry& entry : entries) box = merge(box, entry.box);
  return half_area(box);
}

template <class Entry>
float cost_of_groups(std::span<const Entry> entries, std::span<const std::size_t> sizes) {
  float cost = 0.0f;
  for (const std::size_t size : sizes) {
    cost += area_of(entries.first(size));
    entries = entries.subspan(size);
  }
  return cost;
}

// Up to this many entries are split along the axis with the smallest surfaces, more along the longest axis.
constexpr std::size_t kFewEntries = 64;

// Orders the entries so that each group is one run, all of nearly the same size. At most eight groups.
template <class Entry>
void split_into_groups(std::span<Entry> entries, int groups, std::size_t* sizes) {
  if (groups == 1) {
    *sizes = entries.size();
    return;
  }
  const int left = groups / 2;
  const std::size_t middle = entries.size() * std::size_t(left) / std::size_t(groups);
  int best_axis = longest_axis<Entry>(entries);
  if (entries.size() <= kFewEntries) {
    float min_cost = std::numeric_limits<float>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      partition_by_center(entries, middle, axis);
      const float cost = area_of<Entry>(entries.first(middle)) + area_of<Entry>(entries.subspan(middle));
      if (cost < min_cost) {
        min_cost = cost;
        best_axis = axis;
      }
    }
  }
  partition_by_center(entries, middle, best_axis);
  split_into_groups(entries.first(middle), left, sizes);
  split_into_groups(entries.subspan(middle), groups - left, sizes + left);
}

}  // namespace

Aabb BoxTree::bounds_of(const Node& node) {
  Aabb box = lane_box(node, 0);
  for (int lane = 1; lane < node.count; ++lane) box = merge(box, lane_box(node, lane));
  return box;
}

std::uint32_t BoxTree::make_node(int level) {
  const std::uint32_t index = take_slot(nodes_, free_);
  Node& node = nodes_[index];
  for (int lane = 0; lane < kWidth; ++lane) {
    clear_lane_box(node, lane);
    node.child[lane] = kNowhere;
  }
  node.parent = kNowhere;
  node.lane = 0;
  node.count = 0;
  node.level = std::uint8_t(level);
  node.used = 1;
  return index;
}

void BoxTree::free_node(std::uint32_t index) {
  nodes_[index].used = 0;
  free_.push_back(index);
}

void BoxTree::clear() {
  nodes_.clear();
  free_.clear();
  for (std::uint32_t& slot : slots_) slot = kNowhere;
  root_ = kNowhere;
  next_improved_ = 0;
  size_ = 0;
}

void BoxTree::set_child(std::uint32_t node, int lane, const Entry& entry) {
  Node& n = nodes_[node];
  set_lane_box(n, lane, entry.box);
  n.child[lane] = entry.child;
  if (n.level == 0) {
    slots_[entry.child] = node * kWidth + std::uint32_t(lane);
  } else {
    nodes_[entry.child].parent = node;
    nodes_[entry.child].lane = std::uint8_t(lane);
  }
}

void BoxTree::append_child(std::uint32_t node, const Entry& entry) {
  const int lane = nodes_[node].count++;
  set_child(node, lane, entry);
}

void BoxTree::remove_lane(std::uint32_t node, int lane) {
  Node& n = nodes_[node];
  const int last = --n.count;
  if (lane != last) set_child(node, lane, {lane_box(n, last), n.child[last]});
  clear_lane_box(n, last);
  n.child[last] = kNowhere;
}

// Makes the boxes of `node` in its ancestors exact again, as far up as they change.
void BoxTree::refit_up(std::uint32_t node) {
  while (nodes_[node].parent != kNowhere) {
    const Aabb box = bounds_of(nodes_[node]);
    Node& parent = nodes_[nodes_[node].parent];
    const int lane = nodes_[node].lane;
    if (lane_box(parent, lane) == box) return;
    set_lane_box(parent, lane, box);
    node = nodes_[node].parent;
  }
}

void BoxTree::shorten_root() {
  while (nodes_[root_].level > 0 && nodes_[root_].count == 1) {
    const std::uint32_t old = root_;
    root_ = nodes_[old].child[0];
    nodes_[root_].parent = kNowhere;
    free_node(old);
  }
}

// ------------------------------------------------------------------------------------------------ one at a time

void BoxTree::insert(std::uint32_t item, const Aabb& box) {
  if (slots_.size() <= item) slots_.resize(std::size_t(item) + 1, kNowhere);
  GYRE_ASSERT(slots_[item] == kNowhere, "the item is not in the tree yet");
  insert_entry({box, item});
  ++size_;
}

void BoxTree::insert_entry(const Entry& entry) {
  if (root_ == kNowhere) root_ = make_node(0);
  std::uint32_t index = root_;
  while (nodes_[index].level > 0) {
    Node& node = nodes_[index];
    // The child whose surface grows least; among equals the smallest.
    int best = 0;
    float min_growth = std::numeric_limits<float>::infinity(), min_area = min_growth;
    for (int lane = 0; lane < node.count; ++lane) {
      const Aabb box = lane_box(node, lane);
      const float area = half_area(box);
      const float growth = half_area(merge(box, entry.box)) - area;
      if (growth < min_growth || (growth == min_growth && area < min_area)) {
        best = lane;
        min_growth = growth;
        min_area = area;
      }
    }
    set_lane_box(node, best, merge(lane_box(node, best), entry.box));
    index = node.child[best];
  }
  add_or_split(index, entry);
}

void BoxTree::add_or_split(std::uint32_t node, Entry entry) {
  for (;;) {
    if (nodes_[node].count < kWidth) {
      append_child(node, entry);
      return;
    }
    const std::uint32_t sibling = split(node, entry);
    const std::uint32_t parent = nodes_[node].parent;
    entry = {bounds_of(nodes_[sibling]), sibling};
    if (parent == kNowhere) {
      root_ = make_node(nodes_[node].level + 1);
      append_child(root_, {bounds_of(nodes_[node]), node});
      append_child(root_, entry);
      return;
    }
    set_lane_box(nodes_[parent], nodes_[node].lane, bounds_of(nodes_[node]));
    node = parent;
  }
}

// Divides the children of a full node and one more between the node and a new sibling, which is returned.
std::uint32_t BoxTree::split(std::uint32_t node, const Entry& extra) {
  constexpr int kCount = kWidth + 1;
  Entry by_axis[3][kCount];
  float min_cost = std::numeric_limits<float>::infinity();
  int best_axis = 0, best_left = kCount / 2;
  for (int axis = 0; axis < 3; ++axis) {
    Entry* const sorted = by_axis[axis];
    for (int i = 0; i < kCount; ++i) {
      const Entry entry = i < kWidth ? Entry{lane_box(nodes_[node], i), nodes_[node].child[i]} : extra;
      const float key = entry.box.low[axis] + entry.box.high[axis];
      int k = i;
      for (; k > 0 && key < sorted[k - 1].box.low[axis] + sorted[k - 1].box.high[axis]; --k) {
        sorted[k] = sorted[k - 1];
      }
      sorted[k] = entry;
    }
    float right_area[kCount];
    Aabb right = sorted[kCount - 1].box;
    for (int i = kCount - 1; i > 0; --i) {
      right = merge(right, sorted[i].box);
      right_area[i] = half_area(right);
    }
    Aabb left = sorted[0].box;
    for (int count = 1; count < kCount; ++count) {
      left = merge(left, sorted[count - 1].box);
      if (count < kMinInHalf || kCount - count < kMinInHalf) continue;
      const float cost = float(count) * half_area(left) + float(kCount - count) * right_area[count];
      if (cost < min_cost) {
        min_cost = cost;
        best_axis = axis;
        best_left = count;
      }
    }
  }
  const std::uint32_t sibling = make_node(nodes_[node].level);
  while (nodes_[node].count > 0) remove_lane(node, nodes_[node].count - 1);
  for (int i = 0; i < kCount; ++i) append_child(i < best_left ? node : sibling, by_axis[best_axis][i]);
  return sibling;
}

void BoxTree::remove(std::uint32_t item) {
  GYRE_ASSERT(contains(item), "the item is in the tree");
  std::uint32_t node = slots_[item] / kWidth;
  int lane = int(slots_[item] % kWidth);
  slots_[item] = kNowhere;
  --size_;
  for (;;) {
    remove_lane(node, lane);
    if (nodes_[node].count > 0) break;
    const std::uint32_t parent = nodes_[node].parent;
    lane = nodes_[node].lane;
    free_node(node);
    if (parent == kNowhere) {
      root_ = kNowhere;
      return;
    }
    node = parent;
  }
  refit_up(node);
  shorten_root();
}

void BoxTree::move(std::uint32_t item, const Aabb& box) {
  GYRE_ASSERT(contains(item), "the item is in the tree");
  const std::uint32_t index = slots_[item] / kWidth;
  Node& node = nodes_[index];
  bool stays = node.parent == kNowhere;
  if (!stays) {
    const Aabb home = lane_box(nodes_[node.parent], node.lane);
    const Vec3 middle = center(box);
    stays = gyre::contains(home, {middle, middle});
  }
  if (stays) {
    set_lane_box(node, int(slots_[item] % kWidth), box);
    refit_up(index);
  } else {
    remove(item);
    insert(item, box);
  }
}

// -------------------------------------------------------------------------------------------------- many at once

void BoxTree::build(std::span<const std::uint32_t> items, std::span<const Aabb> boxes) {
  begin_build();
  for (std::size_t i = 0; i < items.size(); ++i) add_to_build(items[i], boxes[i]);
  finish_build();
}

void BoxTree::finish_build() {
  if (entries_.empty()) return;
  std::uint32_t highest = 0;
  for (const Entry& entry : entries_) highest = max(highest, entry.child);
  if (slots_.size() <= highest) slots_.resize(std::size_t(highest) + 1, kNowhere);
  size_ = entries_.size();
  int level = 0;
  while (size_ > room_of(level)) ++level;
  root_ = build_node(entries_, level, 0);
  looseness_ = refit_nodes();
}

bool BoxTree::refit() { return refit_nodes() <= kMaxLooseness * looseness_; }

// Makes the boxes of children in all nodes exact, from the bottom up. Returns their surface divided by that of the
// items.
float BoxTree::refit_nodes() {
  if (root_ == kNowhere) return 0.0f;
  float items = 0.0f, inner = 0.0f;
  for (int level = 0; level <= nodes_[root_].level; ++level) {
    for (Node& node : nodes_) {
      if (node.used == 0 || node.level != level) continue;
      for (int lane = 0; lane < node.count; ++lane) {
        if (level > 0) set_lane_box(node, lane, bounds_of(nodes_[node.child[lane]]));
        (level > 0 ? inner : items) += half_area(lane_box(node, lane));
      }
    }
  }
  return items > 0.0f ? inner / items : inner;
}

// `lowest`: the level of the nodes that take the entries themselves as children.
std::uint32_t BoxTree::build_node(std::span<Entry> entries, int level, int lowest) {
  const std::uint32_t node = make_node(level);
  if (level == lowest) {
    for (const Entry& entry : entries) append_child(node, entry);
    return node;
  }
  const std::size_t room = room_of(level - 1);
  std::size_t sizes[kWidth];
  const int groups = int((entries.size() + room - 1) / room);
  split_into_groups<Entry>(entries, groups, sizes);
  for (int i = 0; i < groups; ++i) {
    const std::uint32_t child = build_node(entries.first(sizes[i]), level - 1, lowest);
    append_child(node, {bounds_of(nodes_[child]), child});
    entries = entries.subspan(sizes[i]);
  }
  return node;
}

void BoxTree::improve(std::size_t changes) {
  if (root_ == kNowhere) return;
  constexpr std::size_t kChangesPerNode = 256;
  int nodes = int(1 + changes / kChangesPerNode);
  // Most nodes are on level 0 and have nothing to regroup: a bounded number of them is skipped.
  for (int passed = 0; nodes > 0 && passed < 16 * nodes + 64; ++passed) {
    if (next_improved_ >= nodes_.size()) next_improved_ = 0;
    const std::uint32_t index = next_improved_++;
    if (nodes_[index].used == 0 || nodes_[index].level == 0) continue;
    regroup(index);
    --nodes;
  }
}

void BoxTree::regroup(std::uint32_t index) {
  Entry entries[kWidth * kWidth];
  std::size_t count = 0;
  float cost_before = 0.0f;
  const int level = nodes_[index].level;
  const int groups_before = nodes_[index].count;
  for (int lane = 0; lane < groups_before; ++lane) {
    const Node& child = nodes_[nodes_[index].child[lane]];
    for (int i = 0; i < child.count; ++i) entries[count++] = {lane_box(child, i), child.child[i]};
    cost_before += half_area(lane_box(nodes_[index], lane));
  }
  const int groups = int(min((count + kFill - 1) / kFill, std::size_t(kWidth)));
  std::size_t sizes[kWidth];
  split_into_groups<Entry>({entries, count}, groups, sizes);
  const float cost = cost_of_groups(std::span<const Entry>(entries, count), {sizes, std::size_t(groups)});
  // Fewer groups are always better: empty lanes cost traversal time, too.
  if (groups >= groups_before && cost >= cost_before) return;
  while (nodes_[index].count > 0) {
    const int lane = nodes_[index].count - 1;
    free_node(nodes_[index].child[lane]);
    remove_lane(index, lane);
  }
  std::span<Entry> left(entries, count);
  for (int i = 0; i < groups; ++i) {
    const std::uint32_t child = build_node(left.first(sizes[i]), level - 1, level - 1);
    append_child(index, {bounds_of(nodes_[child]), child});
    left = left.subspan(sizes[i]);
  }
  refit_up(index);
  shorten_root();
}

// ---------------------------------------------------------------------------------------------------------- checks

double BoxTree::cost() const {
  if (root_ == kNowhere) return 0.0;
  double sum = 0.0;
  for (const Node& node : nodes_) {
    if (node.used != 0) sum += double(half_area(bounds_of(node)));
  }
  return sum / double(half_area(bounds_of(nodes_[root_])));
}

const char* BoxTree::find_fault() const {
  std::size_t items = 0;
  if (root_ != kNowhere) {
    if (nodes_[root_].parent != kNowhere) return "the root has a parent";
    if (const char* const fault = find_fault(root_, items)) return fault;
  }
  if (items != size_) return "the number of items is wrong";
  std::size_t used = 0;
  for (const Node& node : nodes_) used += node.used;
  if (used + free_.size() != nodes_.size()) return "a node is neither in use nor free";
  return nullptr;
}

const char* BoxTree::find_fault(std::uint32_t index, std::size_t& items) const {
  const Node& node = nodes_[index];
  if (node.used == 0) return "a node in the tree is on the free list";
  if (node.count == 0 || node.count > kWidth) return "a node is empty";
  for (int lane = 0; lane < kWidth; ++lane) {
    if (lane >= node.count) {
      if (!(node.low[0][lane] > node.high[0][lane])) return "an empty lane has a box";
      continue;
    }
    if (node.level == 0) {
      ++items;
      if (slots_[node.child[lane]] != index * kWidth + std::uint32_t(lane)) return "an item's slot is wrong";
      continue;
    }
    const Node& child = nodes_[node.child[lane]];
    if (child.level + 1 != node.level) return "leaves lie at different depths";
    if (child.parent != index || child.lane != lane) return "a node does not know its parent";
    if (!gyre::contains(lane_box(node, lane), bounds_of(child)))
      return "a node's box does not contain a child's";
    if (const char* const fault = find_fault(node.child[lane], items)) return fault;
  }
  return nullptr;
}

}  // namespace gyre
