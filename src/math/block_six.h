// Blocks of six rows and six columns, stored by rows, as rigid bodies have. Two columns at a time; each number has the
// bits of the same sum taken term by term.
#pragma once

#include "math/wide_double.h"

namespace gyre {

constexpr int kSix = 6;
constexpr int kSixBlock = kSix * kSix;

// A row as three pairs.
struct SixRow {
  WideDouble<2> pair[3];

  static GYRE_INLINE SixRow load(const double* from) {
    return {{WideDouble<2>::load_loose(from), WideDouble<2>::load_loose(from + 2),
             WideDouble<2>::load_loose(from + 4)}};
  }
  GYRE_INLINE void store(double* to) const {
    for (int i = 0; i < 3; ++i) pair[i].store_loose(to + 2 * i);
  }
};

// sum of weights[k] * rows[k], in ascending order
GYRE_INLINE SixRow combine(const double* weights, const SixRow (&rows)[kSix]) {
  SixRow sum{};
  for (int k = 0; k < kSix; ++k) {
    const WideDouble<2> weight(weights[k]);
    for (int i = 0; i < 3; ++i) sum.pair[i] += weight * rows[k].pair[i];
  }
  return sum;
}

// out = a b
inline void multiply_six(const double* a, const double* b, double* out) {
  SixRow rows[kSix];
  for (int k = 0; k < kSix; ++k) rows[k] = SixRow::load(b + kSix * k);
  for (int r = 0; r < kSix; ++r) combine(a + kSix * r, rows).store(out + kSix * r);
}

// out -= a b
inline void subtract_product_six(const double* a, const double* b, double* out) {
  SixRow rows[kSix];
  for (int k = 0; k < kSix; ++k) rows[k] = SixRow::load(b + kSix * k);
  for (int r = 0; r < kSix; ++r) {
    const SixRow sum = combine(a + kSix * r, rows);
    SixRow row = SixRow::load(out + kSix * r);
    for (int i = 0; i < 3; ++i) row.pair[i] -= sum.pair[i];
    row.store(out + kSix * r);
  }
}

inline void transpose_six(const double* from, double* to) {
  for (int r = 0; r < kSix; ++r) {
    for (int c = 0; c < kSix; ++c) to[kSix * c + r] = from[kSix * r + c];
  }
}

// block += factor rows columns^T
inline void add_outer_six(double* block, const double* rows, const double* columns, double factor) {
  const SixRow across = SixRow::load(columns);
  for (int r = 0; r < kSix; ++r) {
    const WideDouble<2> weight(factor * rows[r]);
    SixRow row = SixRow::load(block + kSix * r);
    for (int i = 0; i < 3; ++i) row.pair[i] += weight * across.pair[i];
    row.store(block + kSix * r);
  }
}

// y -= B x
inline void subtract_times_six(const double* b, const double* x, double* y) {
  for (int r = 0; r < kSix; ++r) {
    double sum = 0.0;
    for (int c = 0; c < kSix; ++c) sum += b[kSix * r + c] * x[c];
    y[r] -= sum;
  }
}

// y -= B^T x
inline void subtract_transposed_six(const double* b, const double* x, double* y) {
  SixRow row = SixRow::load(y);
  for (int r = 0; r < kSix; ++r) {
    const WideDouble<2> weight(x[r]);
    const SixRow own = SixRow::load(b + kSix * r);
    for (int i = 0; i < 3; ++i) row.pair[i] -= own.pair[i] * weight;
  }
  row.store(y);
}

}  // namespace gyre
