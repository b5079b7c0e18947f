// Rows of a grid, W points at a time, and sums over rows whose bits do not depend on W.
#pragma once

#include "fluid/kernels/gas_kernels.h"
#include "math/wide.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

constexpr int kGridLanes = 16;  // the widest W: sums over rows have one term for each index modulo 16

// All W points exist.
template <int W>
struct FullLanes {
  GYRE_INLINE Wide<W> keep_real(Wide<W> value) const { return value; }
};
// Only the first few exist; the others are beyond the end of the row and become zero.
template <int W>
struct PartLanes {
  Mask<W> real;
  GYRE_INLINE explicit PartLanes(int count) {
    alignas(64) float lane[W];
    GYRE_UNROLL
    for (int i = 0; i < W; ++i) lane[i] = float(i);
    real = Wide<W>::load(lane) < Wide<W>(float(count));
  }
  GYRE_INLINE Wide<W> keep_real(Wide<W> value) const { return keep(real, value); }
};

// Calls fn(i, lanes) for i = 0, W, 2 W, ... of a row of `count` places.
template <int W, class Fn>
GYRE_INLINE void for_lanes(int count, Fn&& fn) {
  int i = 0;
  for (; i + W <= count; i += W) fn(i, FullLanes<W>{});
  if constexpr (W > 1) {
    if (i < count) fn(i, PartLanes<W>(count - i));
  }
}

// A sum for each index modulo 16, in float, and these together in double.
template <int W>
struct LaneSums {
  Wide<W> sums[kGridLanes / W];

  GYRE_INLINE LaneSums() {
    GYRE_UNROLL
    for (int part = 0; part < kGridLanes / W; ++part) sums[part] = 0.0f;
  }
  // `part`: which W of 16 these are.
  GYRE_INLINE void add(int part, Wide<W> value) { sums[part] += value; }
  GYRE_INLINE double total() const {
    double all = 0.0;
    for (int i = 0; i < kGridLanes; ++i) all += double(sums[i / W][i % W]);
    return all;
  }
};

// Calls fn(c) for each row from row_begin on, c being the index of its cell 0. `rows` along y.
template <class Fn>
GYRE_INLINE void for_rows(const GridShape& shape, int rows, int row_begin, int row_end, Fn&& fn) {
  int k = row_begin / rows, j = row_begin - k * rows;
  for (int row = row_begin; row < row_end; ++row) {
    fn(shape.first + shape.pitch * j + shape.plane * k, j, k, row);
    if (++j == rows) j = 0, ++k;
  }
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
