// How W rows of a slice read the numbers of their neighbours: as one row of numbers where the slot has an offset, one by one where its
// columns are listed.
#pragma once

#include "math/wide_double.h"
#include "math/wide_vec.h"
#include "soft/kernels/soft_kernels.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// One slot of a slice, as rows `row` to `row + W` of it see it.
template <int W>
struct SlotLanes {
  const std::int32_t* columns;  // null: the columns are first, first + 1, ...
  std::int32_t first;

  GYRE_INLINE SlotLanes(const RowPattern& pattern, int slot, int row) {
    const RowSlot& one = pattern.slots[slot];
    first = row + one.offset;
    columns = one.columns < 0 ? nullptr : pattern.columns + one.columns + row % kSliceRows;
  }
  GYRE_INLINE Wide<W> load(const float* from) const {
    if (columns == nullptr) return Wide<W>::load_unaligned(from + first);
    alignas(64) float lanes[W];
    GYRE_UNROLL
    for (int i = 0; i < W; ++i) lanes[i] = from[columns[i]];
    return Wide<W>::load(lanes);
  }
  GYRE_INLINE Vec3W<W> load(const VectorRows& from) const {
    return {load(from.x), load(from.y), load(from.z)};
  }
};

// W places of a row of doubles.
template <int W>
struct PlaceLanes {
  using Half = WideDouble<kHalfLanes<W>>;
  Half low, high;

  GYRE_INLINE PlaceLanes(const double* from, int row) {
    low = Half::load_loose(from + row);
    high = W == 1 ? low : Half::load_loose(from + row + W / 2);
  }
  GYRE_INLINE PlaceLanes(const double* from, const SlotLanes<W>& slot) {
    if (slot.columns == nullptr) {
      *this = PlaceLanes(from, slot.first);
      return;
    }
    alignas(64) double lanes[W];
    GYRE_UNROLL
    for (int i = 0; i < W; ++i) lanes[i] = from[slot.columns[i]];
    *this = PlaceLanes(lanes, 0);
  }
};
template <int W>
GYRE_INLINE Wide<W> difference(const PlaceLanes<W>& to, const PlaceLanes<W>& from) {
  return join_halves<W>(to.low - from.low, to.high - from.high);
}

template <int W>
GYRE_INLINE Vec3W<W> load_rows(const VectorRows& from, int row) {
  return {Wide<W>::load(from.x + row), Wide<W>::load(from.y + row), Wide<W>::load(from.z + row)};
}
template <int W>
GYRE_INLINE void store_rows(const VectorRows& to, int row, Vec3W<W> v) {
  v.x.store(to.x + row);
  v.y.store(to.y + row);
  v.z.store(to.z + row);
}

// Sums over rows in an order that does not depend on W: the 16 rows of a slice have a sum each, in float, and these are added in double.
template <int W>
struct RowSums {
  Wide<W> sums[kSliceRows / W];

  GYRE_INLINE RowSums() {
    GYRE_UNROLL
    for (int part = 0; part < kSliceRows / W; ++part) sums[part] = 0.0f;
  }
  GYRE_INLINE double total() const {
    double all = 0.0;
    for (int row = 0; row < kSliceRows; ++row) all += double(sums[row / W][row % W]);
    return all;
  }
};

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
