// Fills the hashed grid. See broadphase_grid.h.
#include "collision/broadphase/broadphase_grid.h"

#include "base/container/sort.h"

#include <limits>

namespace gyre {
namespace {

// Size of a cell over the size that three quarters of all boxes do not exceed. Larger cells hold too many boxes,
// smaller ones put boxes into too many cells.
constexpr float kCellsPerBox = 2.5f;
constexpr std::size_t kSideSample = 512;
// The grid is rebuilt when its number of items has changed by this factor since the last build.
constexpr std::size_t kRebuildRatio = 4;
constexpr std::size_t kSmall = 64;

}  // namespace

Aabb HashedGrid::box_of_cell(const Cell& cell) const {
  constexpr float kEnd = std::numeric_limits<float>::max();
  float low[3], high[3];
  for (int axis = 0; axis < 3; ++axis) {
    const int at = cell.at[axis];
    const float a = float(at) * cell_size_, b = float(at + 1) * cell_size_;
    // The cell of a position is rounded.
    low[axis] = at <= -kMaxCoordinate ? -kEnd : a - 1.0e-6f * (absolute(a) + cell_size_);
    high[axis] = at >= kMaxCoordinate ? kEnd : b + 1.0e-6f * (absolute(b) + cell_size_);
  }
  return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
}

void HashedGrid::clear() {
  occupied_.clear();
  buckets_.clear();
  for (Where& where : where_) where = kAbsent;
  large_ = kNone;
  occupied_range_ = {{{0, 0, 0}}, {{-1, -1, -1}}};
  size_ = 0;
  size_when_built_ = 0;
}

// Uses a sample of the entries.
void HashedGrid::choose_cell_size() {
  float sides[kSideSample], scratch[kSideSample];
  const std::size_t stride = (entries_.size() + kSideSample - 1) / kSideSample;
  std::size_t count = 0;
  for (std::size_t i = 0; i < entries_.size(); i += stride) {
    sides[count++] = largest(entries_[i].box.high - entries_[i].box.low);
  }
  merge_sort(std::span(sides, count), std::span(scratch, count), [](float a, float b) { return a < b; });
  // Boxes without size still need cells with one.
  cell_size_ = max(kCellsPerBox * sides[count * 3 / 4], 1.0e-6f);
  inverse_size_ = 1.0f / cell_size_;
}

void HashedGrid::finish_build() {
  clear();
  if (entries_.empty()) return;
  choose_cell_size();
  for (const BoxEntry& entry : entries_) insert(entry.item, entry.box);
  size_when_built_ = size_;
}

void HashedGrid::put(std::uint32_t item, const Aabb& box) {
  boxes_[item] = box;
  const Cells cells = cells_of(box);
  if (cells.count() > kMaxCells) {
    slots_[item] = buckets_.add(large_, item, box);
    where_[item] = kInLarge;
    return;
  }
  where_[item] = kInCells;
  const bool first = occupied_range_.low.at[0] > occupied_range_.high.at[0];
  for (int axis = 0; axis < 3; ++axis) {
    occupied_range_.low.at[axis] =
        first ? cells.low.at[axis] : min(occupied_range_.low.at[axis], cells.low.at[axis]);
    occupied_range_.high.at[axis] =
        first ? cells.high.at[axis] : max(occupied_range_.high.at[axis], cells.high.at[axis]);
  }
  for_each_cell(cells, [&](const Cell& cell) {
    buckets_.add(occupied_.find_or_insert(key_of(cell), kNone), item, box);
  });
}

void HashedGrid::take(std::uint32_t item) {
  if (where_[item] == kInLarge) {
    const std::uint32_t moved = buckets_.remove(large_, slots_[item]);
    if (moved != kNone) slots_[moved] = slots_[item];
  } else {
    for_each_cell(cells_of(boxes_[item]), [&](const Cell& cell) {
      std::uint32_t& head = *occupied_.find(key_of(cell));
      buckets_.remove(head, buckets_.find(head, item));
      if (head == kNone) occupied_.erase(key_of(cell));
    });
  }
  where_[item] = kAbsent;
}

void HashedGrid::insert(std::uint32_t item, const Aabb& box) {
  if (where_.size() <= item) {
    where_.resize(std::size_t(item) + 1, kAbsent);
    boxes_.resize(std::size_t(item) + 1);
    slots_.resize(std::size_t(item) + 1, kNone);
  }
  GYRE_ASSERT(where_[item] == kAbsent, "the item is not in the grid yet");
  put(item, box);
  ++size_;
}

void HashedGrid::remove(std::uint32_t item) {
  GYRE_ASSERT(contains(item), "the item is in the grid");
  take(item);
  --size_;
}

void HashedGrid::move(std::uint32_t item, const Aabb& box) {
  GYRE_ASSERT(contains(item), "the item is in the grid");
  const Cells cells = cells_of(box);
  if (where_[item] == kInLarge && cells.count() > kMaxCells) {
    boxes_[item] = box;
    buckets_.set_box(slots_[item], box);
  } else if (where_[item] == kInCells && cells == cells_of(boxes_[item])) {
    boxes_[item] = box;
    for_each_cell(cells, [&](const Cell& cell) {
      buckets_.set_box(buckets_.find(*occupied_.find(key_of(cell)), item), box);
    });
  } else {
    take(item);
    put(item, box);
  }
}

void HashedGrid::improve(std::size_t) {
  const std::size_t more = max(size_, size_when_built_), less = min(size_, size_when_built_);
  if (more <= kSmall || more <= kRebuildRatio * less) return;
  entries_.clear();
  for (std::uint32_t item = 0; item < where_.size(); ++item) {
    if (where_[item] != kAbsent) entries_.push_back({boxes_[item], item});
  }
  finish_build();
}

void HashedGrid::trim() {
  clock_.trim(entries_, entries_.size());
  entries_.clear();
}

const char* HashedGrid::find_fault() const {
  std::size_t items = 0, in_cells = 0, expected = 0;
  for (std::uint32_t item = 0; item < where_.size(); ++item) {
    if (where_[item] == kAbsent) continue;
    ++items;
    const Cells cells = cells_of(boxes_[item]);
    if ((cells.count() > kMaxCells) != (where_[item] == kInLarge))
      return "a large box is not where large ones are";
    if (where_[item] == kInLarge) {
      if (buckets_.item_at(slots_[item]) != item) return "an item's slot is wrong";
      continue;
    }
    expected += std::size_t(cells.count());
  }
  if (items != size_) return "the number of items is wrong";
  const char* fault = nullptr;
  occupied_.for_each([&](std::uint64_t key, std::uint32_t head) {
    if (head == kNone) fault = "an empty cell exists";
    const Cell cell = cell_of_key(key);
    buckets_.for_each(head, [&](std::uint32_t item, const Aabb& box, std::uint32_t) {
      ++in_cells;
      const Cells cells = cells_of(box);
      if (!(boxes_[item] == box)) fault = "a cell knows an item by another box";
      if (!(corner(cells, {cell, cell}) == cell)) fault = "an item lies in a cell that it does not touch";
    });
  });
  if (fault != nullptr) return fault;
  return in_cells == expected ? nullptr : "an item is missing in a cell";
}

}  // namespace gyre
