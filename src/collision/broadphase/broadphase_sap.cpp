// Maintains the order of sweep and prune. See broadphase_sap.h.
#include "collision/broadphase/broadphase_sap.h"

#include <limits>

namespace gyre {
namespace {

// After this many moves an item, insertion sort gives way to a full sort.
constexpr std::size_t kMovesPerItem = 16;
// The axis is chosen again after this many changes an item.
constexpr std::size_t kRoundsPerAxis = 16;

// The bits of a float as an unsigned number with the same order.
std::uint32_t bits_in_order(float x) {
  const auto bits = __builtin_bit_cast(std::uint32_t, x + 0.0f);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

}  // namespace

void SortedAxis::clear() {
  for (std::uint8_t& present : present_) present = 0;
  order_.clear();
  blocks_.clear();
  group_high_.clear();
  running_high_.clear();
  size_ = 0;
  gone_ = 0;
  changes_since_axis_ = 0;
}

void SortedAxis::insert(std::uint32_t item, const Aabb& box) {
  if (boxes_.size() <= item) {
    boxes_.resize(std::size_t(item) + 1);
    present_.resize(std::size_t(item) + 1, 0);
  }
  GYRE_ASSERT(present_[item] == 0, "the item is not there yet");
  boxes_[item] = box;
  present_[item] = 1;
  order_.push_back({0.0f, item});
  ++size_;
}

void SortedAxis::remove(std::uint32_t item) {
  GYRE_ASSERT(contains(item), "the item is there");
  present_[item] = 0;
  --size_;
  ++gone_;
}

void SortedAxis::move(std::uint32_t item, const Aabb& box) {
  GYRE_ASSERT(contains(item), "the item is there");
  boxes_[item] = box;
}

void SortedAxis::finish_build() {
  changes_since_axis_ = SIZE_MAX;
  improve(0);
}

// The axis with the largest variance of centres.
int SortedAxis::best_axis() const {
  DVec3 sum, squares;
  for (const Ordered& each : order_) {
    const DVec3 middle(center(boxes_[each.item]));
    sum += middle;
    squares += DVec3(middle.x * middle.x, middle.y * middle.y, middle.z * middle.z);
  }
  const double share = 1.0 / double(order_.size());
  const DVec3 mean = share * sum;
  const DVec3 spread(share * squares.x - mean.x * mean.x, share * squares.y - mean.y * mean.y,
                     share * squares.z - mean.z * mean.z);
  return spread.x >= spread.y && spread.x >= spread.z ? 0 : spread.y >= spread.z ? 1 : 2;
}

// An item that was removed and added again appears twice in the order; one entry is dropped.
void SortedAxis::improve(std::size_t changes) {
  if (gone_ > 0) {
    std::size_t kept_count = 0;
    for (const Ordered& each : order_) {
      if (present_[each.item] != 1) continue;
      present_[each.item] = 2;
      order_[kept_count++] = each;
    }
    order_.resize_uninitialized(kept_count);
    for (const Ordered& each : order_) present_[each.item] = 1;
    gone_ = 0;
  }
  changes_since_axis_ = changes < SIZE_MAX - changes_since_axis_ ? changes_since_axis_ + changes : SIZE_MAX;
  const int before = axis_;
  if (changes_since_axis_ > kRoundsPerAxis * size_ && size_ > 0) {
    axis_ = best_axis();
    changes_since_axis_ = 0;
  }
  for (Ordered& each : order_) each.low = boxes_[each.item].low[axis_];
  std::size_t moves = axis_ == before ? kMovesPerItem * order_.size() : 0;
  for (std::size_t i = 1; i < order_.size(); ++i) {
    const Ordered each = order_[i];
    std::size_t position = i;
    for (; position > 0 && each.low < order_[position - 1].low; --position)
      order_[position] = order_[position - 1];
    order_[position] = each;
    if (i - position > moves) {
      sort_all();
      break;
    }
    moves -= i - position;
  }
  write_blocks();
}

void SortedAxis::sort_all() {
  const std::size_t count = order_.size();
  keys_.resize_uninitialized(count);
  values_.resize_uninitialized(count);
  keys_scratch_.resize_uninitialized(count);
  values_scratch_.resize_uninitialized(count);
  for (std::size_t i = 0; i < count; ++i) {
    keys_[i] = bits_in_order(order_[i].low);
    values_[i] = order_[i].item;
  }
  radix_sort_pairs(keys_, values_, keys_scratch_, values_scratch_);
  for (std::size_t i = 0; i < count; ++i) order_[i] = {boxes_[values_[i]].low[axis_], values_[i]};
}

// Writes the boxes in their order, and the high ends of groups.
void SortedAxis::write_blocks() {
  const std::size_t blocks = (order_.size() + kWidth - 1) / kWidth;
  blocks_.resize(blocks);
  group_high_.assign((blocks + kGroup - 1) / kGroup, -std::numeric_limits<float>::infinity());
  for (std::size_t i = 0; i < blocks * kWidth; ++i) {
    Block& block = blocks_[i / kWidth];
    const int lane = int(i % kWidth);
    if (i >= order_.size()) {
      clear_lane_box(block, lane);
      block.item[lane] = 0;
      continue;
    }
    const std::uint32_t item = order_[i].item;
    const Aabb& box = boxes_[item];
    set_lane_box(block, lane, box);
    block.item[lane] = item;
    float& high = group_high_[i / kWidth / kGroup];
    high = max(high, box.high[axis_]);
  }
  running_high_.assign(group_high_);
  for (std::size_t i = 1; i < running_high_.size(); ++i) {
    running_high_[i] = max(running_high_[i], running_high_[i - 1]);
  }
}

void SortedAxis::trim() {
  clock_.trim(keys_, keys_.size());
  if (!keys_.empty()) return;
  keys_scratch_.clear();
  values_.clear();
  values_scratch_.clear();
}

std::size_t SortedAxis::bytes() const {
  return boxes_.bytes() + present_.bytes() + order_.bytes() + blocks_.bytes() + group_high_.bytes() +
         running_high_.bytes() + keys_.bytes() + keys_scratch_.bytes() + values_.bytes() +
         values_scratch_.bytes();
}

const char* SortedAxis::find_fault() const {
  if (order_.size() != size_) return "the number of items is wrong";
  std::size_t present = 0;
  for (const std::uint8_t each : present_) present += each;
  if (present != size_) return "an item is there twice";
  for (std::size_t i = 0; i < order_.size(); ++i) {
    const std::uint32_t item = item_at(i);
    if (item != order_[i].item || present_[item] != 1) return "the order contains a removed item";
    if (!(lane_box(blocks_[i / kWidth], int(i % kWidth)) == boxes_[item]))
      return "the order knows an item by another box";
    if (i > 0 && order_[i].low < order_[i - 1].low) return "the order is not sorted";
    if (group_high_[i / kWidth / kGroup] < boxes_[item].high[axis_])
      return "an item reaches farther than its group";
  }
  return nullptr;
}

void BroadphaseSap::find_pairs(std::span<const Proxy> proxies, std::span<const std::uint32_t> moved,
                               PairFilter filter, TaskSystem& tasks, Array<std::uint64_t>& pairs) {
  const SortedAxis& order = indices_[kMoving];
  const SortedAxis& fixed = indices_[kFixed];
  // The sweep visits all moving proxies, so it pays only if most have moved.
  bool uses_sweep = moved.size() > order.size() / 2;
  moved_fixed_.clear();
  for (const std::uint32_t index : moved) {
    if (homes_[index] == kUnboundedList) uses_sweep = false;
    if (homes_[index] == kFixed) moved_fixed_.push_back(index);
  }
  if (!uses_sweep) {
    BroadphaseBase::find_pairs(proxies, moved, filter, tasks, pairs);
    return;
  }
  const auto is_moved = [&](std::uint32_t index) { return collector_.is_moved(index); };
  const int count = int(order.size() + moved_fixed_.size());
  collector_.collect_from(proxies, moved, count, filter, tasks, pairs, [&](int i, const auto& emit) {
    const auto position = std::size_t(i);
    if (position >= order.size()) {
      const std::uint32_t self = moved_fixed_[position - order.size()];
      order.for_each_overlap(proxies[self].fat_box, [&](std::uint32_t other) {
        if (!is_moved(other)) emit(self, other);
      });
      for (const std::uint32_t other : unbounded_) emit(self, other);
      return;
    }
    const std::uint32_t self = order.item_at(position);
    const bool self_moved = is_moved(self);
    order.for_each_behind(position, proxies[self].fat_box, [&](std::uint32_t other) {
      if (self_moved || is_moved(other)) emit(self, other);
    });
    if (!self_moved) return;
    fixed.for_each_overlap(proxies[self].fat_box, [&](std::uint32_t other) { emit(self, other); });
    for (const std::uint32_t other : unbounded_) emit(self, other);
  });
}

}  // namespace gyre
