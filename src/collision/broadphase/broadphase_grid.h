// A uniform hashed grid: space is divided into cubes of one size, and only occupied cubes exist. A box lies in every
// cell that it touches; two boxes find each other in the cell of the lower corner of their intersection. Boxes over too
// many cells lie in one list that every query tests: a grid has one size, and that is its weakness.
//
// The cell size follows that of the boxes, without the largest quarter, when the grid is built; the grid rebuilds
// itself when its number of items has changed much since then.
//
// Sources: C. Ericson, "Real-Time Collision Detection", 2005, chapter 7.1; M. Teschner et al., "Optimized Spatial
// Hashing for Collision Detection of Deformable Objects", 2003; J. Amanatides, A. Woo, "A Fast Voxel Traversal
// Algorithm for Ray Tracing", 1987 (rays go from layer to layer of cells).
#pragma once

#include "base/container/flat_map.h"
#include "collision/broadphase/box_buckets.h"
#include "collision/broadphase/broadphase_base.h"

namespace gyre {

class HashedGrid {
 public:
  // A box that stays in its cells costs almost nothing, so building pays only if all are new.
  static constexpr std::size_t kRebuildShare = 1;

  std::size_t size() const { return size_; }
  bool contains(std::uint32_t item) const { return item < boxes_.size() && where_[item] != kAbsent; }
  Aabb box_of(std::uint32_t item) const { return boxes_[item]; }
  float cell_size() const { return cell_size_; }

  void clear();
  void begin_build() { entries_.clear(); }
  void add_to_build(std::uint32_t item, const Aabb& box) { entries_.push_back({box, item}); }
  void finish_build();
  void insert(std::uint32_t item, const Aabb& box);
  void remove(std::uint32_t item);
  void move(std::uint32_t item, const Aabb& box);
  void improve(std::size_t changes);
  void trim();
  const char* find_fault() const;
  std::size_t bytes() const {
    return occupied_.bytes() + buckets_.bytes() + boxes_.bytes() + where_.bytes() + slots_.bytes() +
           entries_.bytes();
  }

  template <class Visit>
  void for_each_overlap(const Aabb& box, Visit&& visit) const {
    if (size_ == 0) return;
    buckets_.for_each_overlap(large_, box, [&](std::uint32_t item, std::uint32_t) { visit(item); });
    const Cells cells = clipped(cells_of(box));
    if (!for_each_if_few(cells, [&](std::uint32_t head, Cell cell) {
          buckets_.for_each_overlap(head, box, [&](std::uint32_t item, std::uint32_t slot) {
            if (corner(cells_of(buckets_.box_at(slot)), cells) == cell) visit(item);
          });
        })) {
      for_each_in_cells([&](std::uint32_t item, const Aabb& other) {
        if (overlap(box, other)) visit(item);
      });
    }
  }

  template <class Visit>
  float for_each_along(const CastTest& cast_test, float max_fraction, Visit&& visit) const {
    if (size_ == 0) return max_fraction;
    const auto visit_large = [&](std::uint32_t item, float so_far, std::uint32_t) {
      return visit(item, so_far);
    };
    max_fraction = buckets_.for_each_along(large_, cast_test, max_fraction, visit_large);
    if (max_fraction < 0.0f || occupied_.empty()) return max_fraction;
    return visit_layers(cast_test, max_fraction, visit);
  }

  // The occupied cells.
  template <class Visit>
  void for_each_node(Visit&& visit) const {
    for (std::size_t i = 0; i < occupied_.size(); ++i)
      visit(box_of_cell(cell_of_key(occupied_.entries()[i].key)), 0);
  }

 private:
  static constexpr std::uint32_t kNone = BoxBuckets::kNone;
  static constexpr std::int64_t kMaxCells = 64;                  // of one box
  static constexpr std::int32_t kMaxCoordinate = (1 << 20) - 1;  // cells beyond are clamped to this one

  struct Cell {
    std::int32_t at[3];
    bool operator==(const Cell& o) const { return at[0] == o.at[0] && at[1] == o.at[1] && at[2] == o.at[2]; }
  };
  struct Cells {
    Cell low, high;
    bool operator==(const Cells&) const = default;
    bool is_empty() const {
      return low.at[0] > high.at[0] || low.at[1] > high.at[1] || low.at[2] > high.at[2];
    }
    std::int64_t count() const {
      std::int64_t product = 1;
      for (int axis = 0; axis < 3; ++axis) product *= std::int64_t(high.at[axis]) - low.at[axis] + 1;
      return product;
    }
  };
  enum Where : std::uint8_t { kAbsent, kInCells, kInLarge };

  // Never decreases as `x` grows, whatever the rounding; queries rely on nothing else.
  std::int32_t coordinate(float x) const {
    const float scaled = x * inverse_size_;
    if (!(scaled > -float(kMaxCoordinate))) return -kMaxCoordinate;
    if (scaled >= float(kMaxCoordinate)) return kMaxCoordinate;
    const auto cut = std::int32_t(scaled);
    return float(cut) > scaled ? cut - 1 : cut;
  }
  Cell cell_at(Vec3 p) const { return {{coordinate(p.x), coordinate(p.y), coordinate(p.z)}}; }
  Cells cells_of(const Aabb& box) const { return {cell_at(box.low), cell_at(box.high)}; }
  // The first cell that two ranges of cells share.
  static Cell corner(const Cells& a, const Cells& b) {
    Cell cell{};
    for (int axis = 0; axis < 3; ++axis) cell.at[axis] = max(a.low.at[axis], b.low.at[axis]);
    return cell;
  }
  static std::uint64_t key_of(const Cell& cell) {
    const auto coordinate_bits = [&](int axis) { return std::uint64_t(cell.at[axis] + (1 << 20)); };
    return coordinate_bits(0) << 42 | coordinate_bits(1) << 21 | coordinate_bits(2);
  }
  static Cell cell_of_key(std::uint64_t key) {
    const auto coordinate_bits = [&](int shift) {
      return std::int32_t(key >> shift & 0x1fffffu) - (1 << 20);
    };
    return {{coordinate_bits(42), coordinate_bits(21), coordinate_bits(0)}};
  }
  // A box around everything in the cell.
  Aabb box_of_cell(const Cell& cell) const;
  Cells clipped(Cells cells) const {
    for (int axis = 0; axis < 3; ++axis) {
      cells.low.at[axis] = max(cells.low.at[axis], occupied_range_.low.at[axis]);
      cells.high.at[axis] = min(cells.high.at[axis], occupied_range_.high.at[axis]);
    }
    return cells;
  }
  template <class Fn>
  static void for_each_cell(const Cells& cells, Fn&& fn) {
    Cell cell{};
    for (cell.at[0] = cells.low.at[0]; cell.at[0] <= cells.high.at[0]; ++cell.at[0]) {
      for (cell.at[1] = cells.low.at[1]; cell.at[1] <= cells.high.at[1]; ++cell.at[1]) {
        for (cell.at[2] = cells.low.at[2]; cell.at[2] <= cells.high.at[2]; ++cell.at[2]) fn(cell);
      }
    }
  }
  // Calls fn(list, cell) for the occupied ones of the cells. False, without calls, if there are more cells than
  // occupied ones.
  template <class Fn>
  bool for_each_if_few(const Cells& cells, Fn&& fn) const {
    if (cells.is_empty()) return true;
    if (cells.count() > std::int64_t(occupied_.size())) return false;
    for_each_cell(cells, [&](const Cell& cell) {
      if (const std::uint32_t* const head = occupied_.find(key_of(cell))) fn(*head, cell);
    });
    return true;
  }
  // Calls visit(item, box) once for each item in cells.
  template <class Visit>
  void for_each_in_cells(Visit&& visit) const {
    for (const auto& entry : occupied_.entries()) {
      const Cell cell = cell_of_key(entry.key);
      buckets_.for_each(entry.value, [&](std::uint32_t item, const Aabb& box, std::uint32_t) {
        if (cell_at(box.low) == cell) visit(item, box);
      });
    }
  }

  template <class Visit>
  float visit_layers(const CastTest& cast_test, float max_fraction, Visit&& visit) const;

  void choose_cell_size();
  void put(std::uint32_t item, const Aabb& box);
  void take(std::uint32_t item);

  FlatMap<std::uint32_t> occupied_;  // by cell: its list
  BoxBuckets buckets_;
  Array<Aabb> boxes_;           // by item
  Array<Where> where_;          // by item
  Array<std::uint32_t> slots_;  // by item, of those in the list of large boxes
  Array<BoxEntry> entries_;     // of the present build
  ShrinkPolicy clock_;
  std::uint32_t large_ = kNone;
  Cells occupied_range_{{{0, 0, 0}}, {{-1, -1, -1}}};  // all cells occupied at any time since the build
  float cell_size_ = 1.0f, inverse_size_ = 1.0f;
  std::size_t size_ = 0;
  std::size_t size_when_built_ = 0;
};

// Follows the cast in layers of cells across its longest axis. Both ends of the range that the cast covers in a layer
// move monotonically, so each item is met in one unbroken run of layers; it is visited in the first.
template <class Visit>
float HashedGrid::visit_layers(const CastTest& cast_test, float max_fraction, Visit&& visit) const {
  const Aabb all{box_of_cell(occupied_range_.low).low, box_of_cell(occupied_range_.high).high};
  const Vec3 extent{absolute(cast_test.translation(0)), absolute(cast_test.translation(1)),
                    absolute(cast_test.translation(2))};
  const int along = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  CastRange whole = cast_test.clip(all, {0.0f, max_fraction});
  if (whole.is_empty()) return max_fraction;
  whole = {max(whole.enter - 1.0e-5f, 0.0f), min(whole.leave + 1.0e-5f, max_fraction)};
  const Cells span = clipped(cells_of(cast_test.box_of(whole)));
  const std::int64_t layers = std::int64_t(span.high.at[along]) - span.low.at[along] + 1;
  if (layers > std::int64_t(occupied_.size()) + 16) {
    for_each_in_cells([&](std::uint32_t item, const Aabb& box) {
      if (max_fraction >= 0.0f && !cast_test.clip(box, {0.0f, max_fraction}).is_empty())
        max_fraction = visit(item, max_fraction);
    });
    return max_fraction;
  }
  const bool up = cast_test.translation(along) >= 0.0f;
  Cells before{};
  bool has_before = false;
  for (std::int64_t i = 0; i < layers && max_fraction >= 0.0f; ++i) {
    const auto layer = std::int32_t(up ? span.low.at[along] + i : span.high.at[along] - i);
    CastRange range = whole;
    const Aabb slab = box_of_cell({{layer, layer, layer}});
    cast_test.clip(along, slab.low[along], slab.high[along], range);
    if (range.is_empty()) continue;
    if (range.enter > max_fraction * 1.00001f) break;
    range = {max(min(range.enter, whole.leave), whole.enter),
             max(min(range.leave, whole.leave), whole.enter)};
    Cells cells = cells_of(cast_test.box_of(range));
    cells.low.at[along] = cells.high.at[along] = layer;
    const Cells here = clipped(cells);
    const auto visit_cell = [&](const Cell& cell) {
      const std::uint32_t* const head = max_fraction < 0.0f ? nullptr : occupied_.find(key_of(cell));
      if (head == nullptr) return;
      max_fraction = buckets_.for_each_along(
          *head, cast_test, max_fraction, [&](std::uint32_t item, float so_far, std::uint32_t slot) {
            const Cells own = cells_of(buckets_.box_at(slot));
            if (!(corner(own, here) == cell)) return so_far;
            bool was_met = has_before;
            for (int axis = 0; axis < 3; ++axis) {
              was_met = was_met && own.low.at[axis] <= before.high.at[axis] &&
                        own.high.at[axis] >= before.low.at[axis];
            }
            return was_met ? so_far : visit(item, so_far);
          });
    };
    for_each_cell(here, visit_cell);
    before = here;
    has_before = !here.is_empty();
  }
  return max_fraction;
}

}  // namespace gyre
