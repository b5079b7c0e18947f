// Builds the static tree. The binned surface area heuristic splits ranges of items in two until a node has eight
// children or nothing is left to split. Partitions are stable, so the result depends on the input alone.
#include "geometry/tree/static_tree.h"

namespace gyre {
namespace {

constexpr int kBins = 16;
constexpr float kInfinity = __builtin_huge_valf();
constexpr Aabb kEmptyBox{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
// Overlaps nothing, not even an infinite box.
constexpr float kNotANumber = __builtin_nanf("");
constexpr Aabb kNoBox{{kNotANumber, kNotANumber, kNotANumber}, {kNotANumber, kNotANumber, kNotANumber}};

struct Range {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  Aabb box = kEmptyBox;
};

struct Split {
  int axis = -1;  // -1: no plane separates the centres
  int bin = 0;    // items in bins up to this one go left
  float low = 0.0f, scale = 0.0f;
};

struct TreeBuilder {
  std::span<const Aabb> boxes;
  std::vector<std::uint32_t>& items;
  std::vector<std::uint32_t> scratch;

  Aabb bounds(std::uint32_t first, std::uint32_t count) const {
    Aabb box = kEmptyBox;
    for (std::uint32_t i = first; i < first + count; ++i) box = merge(box, boxes[items[i]]);
    return box;
  }

  // Twice the middle of an item's box: the factor does not matter here.
  Vec3 middle(std::uint32_t item) const { return boxes[item].low + boxes[item].high; }

  static int bin_of(float value, float low, float scale) {
    const int bin = int((value - low) * scale);
    return bin < 0 ? 0 : (bin >= kBins ? kBins - 1 : bin);
  }

  Split best_split(const Range& range) const;
  std::uint32_t partition(const Range& range, const Split& split);
  void divide(const Range& range, bool by_halves, Range& left, Range& right);
};

struct Bins {
  Aabb box[kBins];
  std::uint32_t count[kBins];
};

// Tries the planes between the bins. The cheapest goes to `best`.
void try_planes(const Bins& bins, Split candidate, float& best_cost, Split& best) {
  float right_cost[kBins];
  Aabb box = kEmptyBox;
  std::uint32_t count = 0;
  for (int i = kBins - 1; i > 0; --i) {
    box = merge(box, bins.box[i]);
    count += bins.count[i];
    right_cost[i] = count == 0 ? kInfinity : half_area(box) * float(count);
  }
  box = kEmptyBox;
  count = 0;
  for (int i = 0; i + 1 < kBins; ++i) {
    box = merge(box, bins.box[i]);
    count += bins.count[i];
    if (count == 0 || right_cost[i + 1] == kInfinity) continue;
    const float cost = half_area(box) * float(count) + right_cost[i + 1];
    if (cost < best_cost) {
      best_cost = cost;
      candidate.bin = i;
      best = candidate;
    }
  }
}

Split TreeBuilder::best_split(const Range& range) const {
  Aabb middles = kEmptyBox;
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
    const Vec3 m = middle(items[i]);
    middles = merge(middles, {m, m});
  }
  Split best;
  float best_cost = kInfinity;
  for (int axis = 0; axis < 3; ++axis) {
    const float low = middles.low[axis], width = middles.high[axis] - low;
    if (!(width > 0.0f)) continue;
    const float scale = float(kBins) / width;
    if (!is_finite(scale)) continue;
    Bins bins;
    for (int i = 0; i < kBins; ++i) {
      bins.box[i] = kEmptyBox;
      bins.count[i] = 0;
    }
    for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
      const int bin = bin_of(middle(items[i])[axis], low, scale);
      bins.box[bin] = merge(bins.box[bin], boxes[items[i]]);
      ++bins.count[bin];
    }
    try_planes(bins, {axis, 0, low, scale}, best_cost, best);
  }
  return best;
}

// Moves the left items to the front; both sides stay in order. Returns the number of left items.
std::uint32_t TreeBuilder::partition(const Range& range, const Split& split) {
  std::uint32_t left_total = 0, right = 0;
  for (std::uint32_t i = range.first; i < range.first + range.count; ++i) {
    const std::uint32_t item = items[i];
    if (bin_of(middle(item)[split.axis], split.low, split.scale) <= split.bin) {
      items[range.first + left_total++] = item;
    } else {
      scratch[right++] = item;
    }
  }
  for (std::uint32_t i = 0; i < right; ++i) items[range.first + left_total + i] = scratch[i];
  return left_total;
}

void TreeBuilder::divide(const Range& range, bool by_halves, Range& left, Range& right) {
  const Split split = by_halves ? Split{} : best_split(range);
  std::uint32_t left_count = split.axis < 0 ? range.count / 2 : partition(range, split);
  left = {range.first, left_count, bounds(range.first, left_count)};
  const std::uint32_t middle_position = range.first + left_count;
  right = {middle_position, range.count - left_count, bounds(middle_position, range.count - left_count)};
}

// Splits the run of a node into at most eight ranges. The next range to split is the one with the largest surface among
// those too long for a leaf.
int split_children(TreeBuilder& builder, const Range& range_of_node, bool by_halves, Range* children) {
  children[0] = range_of_node;
  int count = 1;
  while (count < StaticTree::kWidth) {
    int pick = -1;
    float best = -1.0f;
    for (int i = 0; i < count; ++i) {
      if (children[i].count <= StaticTree::kMaxLeaf) continue;
      // Below the depth of the heuristic the longest run is split, so that the depth is bounded.
      const float size = by_halves ? float(children[i].count) : half_area(children[i].box);
      if (size > best) {
        best = size;
        pick = i;
      }
    }
    if (pick < 0) break;
    for (int i = count; i > pick + 1; --i) children[i] = children[i - 1];
    const Range range = children[pick];
    builder.divide(range, by_halves, children[pick], children[pick + 1]);
    ++count;
  }
  return count;
}

void set_lane(StaticTree::Node& node, int lane, const Aabb& box, std::uint32_t child) {
  for (int axis = 0; axis < 3; ++axis) {
    node.low[axis][lane] = box.low[axis];
    node.high[axis][lane] = box.high[axis];
  }
  node.child[lane] = child;
}

}  // namespace

void build_static_tree(std::span<const Aabb> boxes, StaticTree& tree) {
  const std::uint32_t total = std::uint32_t(boxes.size());
  tree.nodes.clear();
  tree.items.resize(total);
  for (std::uint32_t i = 0; i < total; ++i) tree.items[i] = i;
  tree.box = {};
  if (total == 0) return;
  TreeBuilder builder{boxes, tree.items, std::vector<std::uint32_t>(total)};
  struct Task {
    Range range;
    std::uint32_t node;
    int depth;
  };
  std::vector<Task> tasks;
  tasks.push_back({{0, total, builder.bounds(0, total)}, 0, 0});
  tree.box = tasks[0].range.box;
  tree.nodes.emplace_back();
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    Range children[StaticTree::kWidth];
    const int count =
        split_children(builder, task.range, task.depth >= StaticTree::kHeuristicDepth, children);
    for (int lane = 0; lane < StaticTree::kWidth; ++lane) {
      if (lane >= count) {
        set_lane(tree.nodes[task.node], lane, kNoBox, StaticTree::kNoChild);
        continue;
      }
      const Range& range = children[lane];
      std::uint32_t child = StaticTree::kLeafBit | ((range.count - 1) << 28) | range.first;
      if (range.count > StaticTree::kMaxLeaf) {
        child = std::uint32_t(tree.nodes.size());
        tree.nodes.emplace_back();
        tasks.push_back({range, child, task.depth + 1});
      }
      set_lane(tree.nodes[task.node], lane, range.box, child);
    }
  }
}

std::uint32_t find_overlaps(const StaticTree& tree, const Aabb& box, std::span<std::uint32_t> out) {
  std::uint32_t found = 0;
  walk_overlaps(
      tree, box, [](std::uint32_t, int) { return true; },
      [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = first; i < first + count; ++i, ++found) {
          if (found < out.size()) out[found] = i;
        }
      });
  return found;
}

}  // namespace gyre
