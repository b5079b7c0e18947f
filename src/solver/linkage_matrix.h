// Factors and solves the matrices of a bundle of linkages: the elimination of math/block_ldlt.cpp with a lane for each linkage,
// half a register of floats at a time. Blocks have three rows (a point) or five (a hinge).
#pragma once

#include "math/wide_double.h"
#include "solver/linkage_lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// A pivot below this share of its own diagonal element is only rounding, as in math/dense.h.
constexpr double kLeastPivot = 1.0e-13;

// The values of one half.
template <int H>
struct HalfMatrix {
  const LinkageBundle& bundle;
  double* values;
  double* vector;

  GYRE_INLINE WideDouble<H> at(std::uint32_t i) const { return WideDouble<H>::load(values + i * H); }
  GYRE_INLINE void set(std::uint32_t i, WideDouble<H> v) const { v.store(values + i * H); }
  GYRE_INLINE WideDouble<H> x(std::uint32_t row) const { return WideDouble<H>::load(vector + row * H); }
  GYRE_INLINE void set_x(std::uint32_t row, WideDouble<H> v) const { v.store(vector + row * H); }
};

// In which halves of the lanes there are some of these: bit 0 and bit 1.
template <int W>
GYRE_INLINE std::uint32_t halves_of(std::uint32_t bits) {
  constexpr int kHalf = kHalfLanes<W>;
  constexpr std::uint32_t kLow = (1u << kHalf) - 1u;
  return ((bits & kLow) != 0 ? 1u : 0u) | (bits > kLow ? 2u : 0u);
}

// With a vector of the bundle's rows, one half after the other.
template <int H>
GYRE_INLINE HalfMatrix<H> half_matrix(const LinkageBundle& bundle, int half, double* vector) {
  return {bundle, bundle.values + std::size_t(half) * bundle.value_count * H,
          vector + std::size_t(half) * bundle.row_count * H};
}
template <int H>
GYRE_INLINE HalfMatrix<H> half_matrix(const LinkageBundle& bundle, int half) {
  return half_matrix<H>(bundle, half, bundle.vector);
}

// The inverse of a diagonal block of which the lower triangle is read, zero in the rows whose pivots were dropped.
template <int H, int N>
void invert_diagonal(double* block) {
  using D = WideDouble<H>;
  D lower[N][N], pivots[N], inverse[N][N];
  GYRE_UNROLL
  for (int j = 0; j < N; ++j) {
    D scaled[N];
    const D own = D::load(block + (j * N + j) * H);
    D pivot = own;
    GYRE_UNROLL
    for (int k = 0; k < j; ++k) {
      scaled[k] = lower[j][k];
      lower[j][k] = scaled[k] * pivots[k];
      pivot -= lower[j][k] * scaled[k];
    }
    const D least = D(kLeastPivot) * own;
    pivots[j] = keep_where_above(pivot, least, D(1.0) / pivot);
    GYRE_UNROLL
    for (int i = j + 1; i < N; ++i) {
      D sum = D::load(block + (i * N + j) * H);
      GYRE_UNROLL
      for (int k = 0; k < j; ++k) sum -= lower[i][k] * lower[j][k];
      lower[i][j] = keep_where_above(pivot, least, sum);
    }
  }
  GYRE_UNROLL
  for (int c = 0; c < N; ++c) {
    inverse[c][c] = D(1.0);
    GYRE_UNROLL
    for (int r = c + 1; r < N; ++r) {
      D sum = lower[r][c];
      GYRE_UNROLL
      for (int k = c + 1; k < r; ++k) sum += lower[r][k] * inverse[k][c];
      inverse[r][c] = D(0.0) - sum;
    }
  }
  GYRE_UNROLL
  for (int r = 0; r < N; ++r) {
    GYRE_UNROLL
    for (int c = 0; c <= r; ++c) {
      D sum = pivots[r] * inverse[r][c];
      GYRE_UNROLL
      for (int k = r + 1; k < N; ++k) sum += inverse[k][r] * pivots[k] * inverse[k][c];
      sum.store(block + (r * N + c) * H);
      sum.store(block + (c * N + r) * H);
    }
  }
}

// out = B D, with B of R by C.
template <int H, int R, int C>
void scale_block(const double* b, const double* d, double* out) {
  using D = WideDouble<H>;
  for (int r = 0; r < R; ++r) {
    D row[C];
    GYRE_UNROLL
    for (int k = 0; k < C; ++k) row[k] = D::load(b + (r * C + k) * H);
    GYRE_UNROLL
    for (int c = 0; c < C; ++c) {
      D sum = row[0] * D::load(d + c * H);
      GYRE_UNROLL
      for (int k = 1; k < C; ++k) sum += row[k] * D::load(d + (k * C + c) * H);
      sum.store(out + (r * C + c) * H);
    }
  }
}

// out -= S B^T, with S of R by C and B of Q by C; of a diagonal block only the lower triangle.
template <int H, int R, int Q, int C>
void subtract_product(const double* s, const double* b, double* out, bool lower_only) {
  using D = WideDouble<H>;
  for (int r = 0; r < R; ++r) {
    D row[C];
    GYRE_UNROLL
    for (int k = 0; k < C; ++k) row[k] = D::load(s + (r * C + k) * H);
    const int last = lower_only ? r + 1 : Q;
    for (int q = 0; q < last; ++q) {
      D sum = row[0] * D::load(b + q * C * H);
      GYRE_UNROLL
      for (int k = 1; k < C; ++k) sum += row[k] * D::load(b + (q * C + k) * H);
      double* const to = out + (r * Q + q) * H;
      (D::load(to) - sum).store(to);
    }
  }
}

template <int H, int R, int C>
void eliminate_entry(const HalfMatrix<H>& m, const BlockColumn& column, std::uint32_t i,
                     const std::uint32_t* targets, double* scaled) {
  const LinkageBundle& bundle = m.bundle;
  scale_block<H, R, C>(m.values + std::size_t(bundle.entries[i].offset) * H,
                       m.values + std::size_t(column.diagonal) * H, scaled);
  for (std::uint32_t j = column.begin; j <= i; ++j) {
    const BlockEntry& other = bundle.entries[j];
    const double* const b = m.values + std::size_t(other.offset) * H;
    double* const out = m.values + std::size_t(*targets++) * H;
    if (bundle.columns[other.place].size == 3) {
      subtract_product<H, R, 3, C>(scaled, b, out, j == i);
    } else {
      subtract_product<H, R, 5, C>(scaled, b, out, j == i);
    }
  }
}

template <int H, int C>
void eliminate_column(const HalfMatrix<H>& m, const BlockColumn& column) {
  const LinkageBundle& bundle = m.bundle;
  invert_diagonal<H, C>(m.values + std::size_t(column.diagonal) * H);
  const std::uint32_t* targets = bundle.targets + column.targets;
  double* scaled = bundle.room;
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const std::uint32_t rows = bundle.columns[bundle.entries[i].place].size;
    if (rows == 3) {
      eliminate_entry<H, 3, C>(m, column, i, targets, scaled);
    } else {
      eliminate_entry<H, 5, C>(m, column, i, targets, scaled);
    }
    targets += i + 1 - column.begin;
    scaled += std::size_t(rows) * C * H;
  }
  if (column.begin == column.end) return;
  double* const to = m.values + std::size_t(bundle.entries[column.begin].offset) * H;
  const std::ptrdiff_t count = scaled - bundle.room;
  for (std::ptrdiff_t i = 0; i < count; i += H) WideDouble<H>::load(bundle.room + i).store(to + i);
}

// y -= B x, with B of R by C.
template <int H, int R, int C>
void push_down(const double* b, const double* x, double* y) {
  using D = WideDouble<H>;
  D known[C];
  GYRE_UNROLL
  for (int c = 0; c < C; ++c) known[c] = D::load(x + c * H);
  GYRE_UNROLL
  for (int r = 0; r < R; ++r) {
    D sum = D::load(b + r * C * H) * known[0];
    GYRE_UNROLL
    for (int c = 1; c < C; ++c) sum += D::load(b + (r * C + c) * H) * known[c];
    (D::load(y + r * H) - sum).store(y + r * H);
  }
}
// own -= B^T x.
template <int H, int R, int C>
GYRE_INLINE void pull_up(const double* b, const double* x, WideDouble<H> (&own)[C]) {
  using D = WideDouble<H>;
  GYRE_UNROLL
  for (int r = 0; r < R; ++r) {
    const D known = D::load(x + r * H);
    GYRE_UNROLL
    for (int c = 0; c < C; ++c) own[c] -= D::load(b + (r * C + c) * H) * known;
  }
}

template <int H, int C>
void solve_column_down(const HalfMatrix<H>& m, const BlockColumn& column) {
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const BlockEntry& entry = m.bundle.entries[i];
    const BlockColumn& row = m.bundle.columns[entry.place];
    const double* const b = m.values + std::size_t(entry.offset) * H;
    const double* const x = m.vector + std::size_t(column.row) * H;
    double* const y = m.vector + std::size_t(row.row) * H;
    if (row.size == 3) {
      push_down<H, 3, C>(b, x, y);
    } else {
      push_down<H, 5, C>(b, x, y);
    }
  }
}

// out = D^-1 x, of the column's rows.
template <int H, int C>
GYRE_INLINE void scale_column(const HalfMatrix<H>& m, const BlockColumn& column, double* out) {
  using D = WideDouble<H>;
  const double* const diagonal = m.values + std::size_t(column.diagonal) * H;
  const double* const x = m.vector + std::size_t(column.row) * H;
  for (int r = 0; r < C; ++r) {
    D sum = D::load(diagonal + r * C * H) * D::load(x);
    GYRE_UNROLL
    for (int c = 1; c < C; ++c) sum += D::load(diagonal + (r * C + c) * H) * D::load(x + c * H);
    sum.store(out + (std::size_t(column.row) + std::size_t(r)) * H);
  }
}

template <int H, int C>
void solve_column_up(const HalfMatrix<H>& m, const BlockColumn& column) {
  using D = WideDouble<H>;
  const double* const diagonal = m.values + std::size_t(column.diagonal) * H;
  double* const x = m.vector + std::size_t(column.row) * H;
  D own[C];
  GYRE_UNROLL
  for (int r = 0; r < C; ++r) own[r] = D::load(diagonal + r * C * H) * D::load(x);
  GYRE_UNROLL
  for (int c = 1; c < C; ++c) {
    const D known = D::load(x + c * H);
    GYRE_UNROLL
    for (int r = 0; r < C; ++r) own[r] += D::load(diagonal + (r * C + c) * H) * known;
  }
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const BlockEntry& entry = m.bundle.entries[i];
    const BlockColumn& row = m.bundle.columns[entry.place];
    const double* const b = m.values + std::size_t(entry.offset) * H;
    const double* const known = m.vector + std::size_t(row.row) * H;
    if (row.size == 3) {
      pull_up<H, 3, C>(b, known, own);
    } else {
      pull_up<H, 5, C>(b, known, own);
    }
  }
  GYRE_UNROLL
  for (int r = 0; r < C; ++r) own[r].store(x + r * H);
}

template <int W>
void factor_lanes(const LinkageBundle& bundle) {
  constexpr int H = kHalfLanes<W>;
  for (int half = 0; half < kHalves<W>; ++half) {
    const HalfMatrix<H> m = half_matrix<H>(bundle, half);
    for (std::uint32_t place = 0; place < bundle.column_count; ++place) {
      const BlockColumn& column = bundle.columns[place];
      if (column.size == 3) {
        eliminate_column<H, 3>(m, column);
      } else {
        eliminate_column<H, 5>(m, column);
      }
    }
  }
}

// Of the first half of the lanes where bit 0 of `halves` is set, of the second where bit 1 is.
template <int W>
void solve_lanes(const LinkageBundle& bundle, std::uint32_t halves = 3u) {
  constexpr int H = kHalfLanes<W>;
  for (int half = 0; half < kHalves<W>; ++half) {
    if ((halves >> half & 1u) == 0) continue;
    const HalfMatrix<H> m = half_matrix<H>(bundle, half);
    for (std::uint32_t place = 0; place < bundle.column_count; ++place) {
      const BlockColumn& column = bundle.columns[place];
      if (column.size == 3) {
        solve_column_down<H, 3>(m, column);
      } else {
        solve_column_down<H, 5>(m, column);
      }
    }
    for (std::uint32_t place = bundle.column_count; place-- > 0;) {
      const BlockColumn& column = bundle.columns[place];
      if (column.size == 3) {
        solve_column_up<H, 3>(m, column);
      } else {
        solve_column_up<H, 5>(m, column);
      }
    }
  }
}

// ---------------------------------------------------------------------------------------------- right sides of few rows

// The columns that elimination reaches from such a right side: a bit for each, by its place.
using ReachedColumns = std::uint64_t*;
constexpr std::uint32_t reach_words(std::uint32_t columns) { return (columns + 63) / 64; }

// Calls run(column) for those of the bundle's columns whose bits are set, in their order; word(i) tells the bits from 64 i on.
template <class Word, class Run>
GYRE_INLINE void for_columns(const LinkageBundle& bundle, const Word& word, const Run& run) {
  const std::uint32_t words = reach_words(bundle.column_count);
  for (std::uint32_t i = 0; i < words; ++i)
    for (std::uint64_t left = word(i); left != 0; left &= left - 1)
      run(bundle.columns[64 * i + std::uint32_t(__builtin_ctzll(left))]);
}

// Marks, beside the columns that are marked, those that elimination reaches from them: all come later.
inline void reach_columns(const LinkageBundle& bundle, ReachedColumns reached) {
  for (std::uint32_t place = 0; place < bundle.column_count; ++place) {
    if ((reached[place / 64] >> place % 64 & 1u) == 0) continue;
    const BlockColumn& column = bundle.columns[place];
    for (std::uint32_t i = column.begin; i < column.end; ++i) {
      const std::uint32_t other = bundle.entries[i].place;
      reached[other / 64] |= std::uint64_t{1} << other % 64;
    }
  }
}

// Clears their rows in x.
template <int W>
void clear_reached(const LinkageBundle& bundle, const ReachedColumns reached, double* x) {
  constexpr int H = kHalfLanes<W>;
  const auto own = [&](std::uint32_t i) { return reached[i]; };
  for_columns(bundle, own, [&](const BlockColumn& column) {
    for (int half = 0; half < kHalves<W>; ++half) {
      const HalfMatrix<H> m = half_matrix<H>(bundle, half, x);
      for (std::uint32_t r = 0; r < column.size; ++r) m.set_x(column.row + r, WideDouble<H>(0.0));
    }
  });
}

// Replaces the right side x, of the columns that are reached, by y of L y = x, and finds D^-1 y. Of the halves of the lanes as
// solve_lanes().
template <int W>
void solve_reached_down(const LinkageBundle& bundle, std::uint32_t halves, const ReachedColumns reached,
                        double* x, double* scaled) {
  constexpr int H = kHalfLanes<W>;
  const auto own = [&](std::uint32_t i) { return reached[i]; };
  for (int half = 0; half < kHalves<W>; ++half) {
    if ((halves >> half & 1u) == 0) continue;
    const HalfMatrix<H> m = half_matrix<H>(bundle, half, x);
    double* const out = scaled + std::size_t(half) * bundle.row_count * H;
    for_columns(bundle, own, [&](const BlockColumn& column) {
      if (column.size == 3) {
        solve_column_down<H, 3>(m, column);
        scale_column<H, 3>(m, column, out);
      } else {
        solve_column_down<H, 5>(m, column);
        scale_column<H, 5>(m, column, out);
      }
    });
  }
}

template <int H, int N>
GYRE_INLINE void add_products(const double* a, const double* b, WideDouble<H>& sum) {
  using D = WideDouble<H>;
  GYRE_UNROLL
  for (int i = 0; i < N; ++i) sum += D::load(a + i * H) * D::load(b + i * H);
}

// The product of two vectors over the columns that both reach; zero in the other half.
template <int W>
Wide<W> dot_reached(const LinkageBundle& bundle, std::uint32_t halves, const ReachedColumns reached_a,
                    const double* a, const ReachedColumns reached_b, const double* b) {
  using D = WideDouble<kHalfLanes<W>>;
  constexpr int H = kHalfLanes<W>;
  const auto common = [&](std::uint32_t i) { return reached_a[i] & reached_b[i]; };
  D sums[2] = {D(0.0), D(0.0)};
  for (int half = 0; half < kHalves<W>; ++half) {
    if ((halves >> half & 1u) == 0) continue;
    D sum(0.0);
    for_columns(bundle, common, [&](const BlockColumn& column) {
      const std::size_t first = (std::size_t(half) * bundle.row_count + column.row) * H;
      if (column.size == 3) {
        add_products<H, 3>(a + first, b + first, sum);
      } else {
        add_products<H, 5>(a + first, b + first, sum);
      }
    });
    sums[half] = sum;
  }
  return join_halves<W>(sums[0], sums[1]);
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
