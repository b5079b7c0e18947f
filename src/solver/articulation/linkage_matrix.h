// Factors and solves the matrices of a bundle of linkages: the elimination of math/block_ldlt.cpp with a lane for each linkage. Blocks
// have three rows (a point) or five (a hinge).
//
// In floats, where that of a linkage alone is in doubles: rows give way by a share of their own diagonal (LaneSettings::give), so no
// pivot falls below that share, and the factors are those of a matrix that differs by some 1e-6 of its diagonal, a hundredth of what
// rows are made to give way anyway (N. Higham, "Accuracy and Stability of Numerical Algorithms", 2002, chapter 10). That holds of
// elimination row by row; with the inverses of whole blocks it does not: a block's condition goes into all that comes later, and limbs
// thrown together at random flew apart. Speeds are measured anew for each solution.
#pragma once

#include "math/wide.h"
#include "solver/articulation/linkage_lanes.h"

namespace gyre {
inline namespace GYRE_TARGET_NAMESPACE {

// A pivot below this share of its own diagonal element is only rounding, as in math/dense.h.
constexpr float kMinPivot = 1.0e-6f;

// A diagonal block of which the lower triangle is read, as L P L^T: L below the diagonal, and on it the inverses of the pivots, zero
// where one was dropped.
template <int W, int N>
void factor_diagonal(float* block) {
  using V = Wide<W>;
  V lower[N][N], unscaled[N][N];
  GYRE_UNROLL
  for (int j = 0; j < N; ++j) {
    GYRE_UNROLL
    for (int i = j; i < N; ++i) {
      unscaled[i][j] = V::load(block + (i * N + j) * W);
      GYRE_UNROLL
      for (int k = 0; k < j; ++k) unscaled[i][j] -= unscaled[i][k] * lower[j][k];
    }
    const V pivot = unscaled[j][j];
    const V inverse = keep(pivot > kMinPivot * V::load(block + (j * N + j) * W), 1.0f / pivot);
    inverse.store(block + (j * N + j) * W);
    GYRE_UNROLL
    for (int i = j + 1; i < N; ++i) {
      lower[i][j] = unscaled[i][j] * inverse;
      lower[i][j].store(block + (i * N + j) * W);
    }
  }
}

// b L^-T in place of b, with b of R by N, and that times the inverse pivots in `scaled`.
template <int W, int R, int N>
void scale_block(const float* diagonal, float* b, float* scaled) {
  using V = Wide<W>;
  for (int r = 0; r < R; ++r) {
    V row[N];
    GYRE_UNROLL
    for (int c = 0; c < N; ++c) {
      row[c] = V::load(b + (r * N + c) * W);
      GYRE_UNROLL
      for (int k = 0; k < c; ++k) row[c] -= row[k] * V::load(diagonal + (c * N + k) * W);
      row[c].store(b + (r * N + c) * W);
      (row[c] * V::load(diagonal + (c * N + c) * W)).store(scaled + (r * N + c) * W);
    }
  }
}

// out -= S B^T, with S of R by C and B of Q by C; of a diagonal block only the lower triangle.
template <int W, int R, int Q, int C>
void subtract_product(const float* s, const float* b, float* out, bool lower_only) {
  using V = Wide<W>;
  for (int r = 0; r < R; ++r) {
    V row[C];
    GYRE_UNROLL
    for (int k = 0; k < C; ++k) row[k] = V::load(s + (r * C + k) * W);
    const int last = lower_only ? r + 1 : Q;
    for (int q = 0; q < last; ++q) {
      V sum = row[0] * V::load(b + q * C * W);
      GYRE_UNROLL
      for (int k = 1; k < C; ++k) sum += row[k] * V::load(b + (q * C + k) * W);
      float* const to = out + (r * Q + q) * W;
      (V::load(to) - sum).store(to);
    }
  }
}

template <int W, int R, int C>
void eliminate_entry(const ArticulationBundle& bundle, const BlockColumn& column, std::uint32_t i,
                     const std::uint32_t* targets, float* scaled) {
  scale_block<W, R, C>(bundle.values + std::size_t(column.diagonal) * W,
                       bundle.values + std::size_t(bundle.entries[i].offset) * W, scaled);
  for (std::uint32_t j = column.begin; j <= i; ++j) {
    const BlockEntry& other = bundle.entries[j];
    const float* const b = bundle.values + std::size_t(other.offset) * W;
    float* const out = bundle.values + std::size_t(*targets++) * W;
    if (bundle.columns[other.index].size == 3) {
      subtract_product<W, R, 3, C>(scaled, b, out, j == i);
    } else {
      subtract_product<W, R, 5, C>(scaled, b, out, j == i);
    }
  }
}

template <int W, int C>
void eliminate_column(const ArticulationBundle& bundle, const BlockColumn& column) {
  factor_diagonal<W, C>(bundle.values + std::size_t(column.diagonal) * W);
  const std::uint32_t* targets = bundle.targets + column.targets;
  float* scaled = bundle.room;
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const std::uint32_t rows = bundle.columns[bundle.entries[i].index].size;
    if (rows == 3) {
      eliminate_entry<W, 3, C>(bundle, column, i, targets, scaled);
    } else {
      eliminate_entry<W, 5, C>(bundle, column, i, targets, scaled);
    }
    targets += i + 1 - column.begin;
    scaled += std::size_t(rows) * C * W;
  }
  if (column.begin == column.end) return;
  float* const to = bundle.values + std::size_t(bundle.entries[column.begin].offset) * W;
  const std::ptrdiff_t count = scaled - bundle.room;
  for (std::ptrdiff_t i = 0; i < count; i += W) Wide<W>::load(bundle.room + i).store(to + i);
}

// y -= B x, with B of R by C.
template <int W, int R, int C>
GYRE_INLINE void push_down(const float* b, const Wide<W> (&x)[C], float* y) {
  using V = Wide<W>;
  GYRE_UNROLL
  for (int r = 0; r < R; ++r) {
    V sum = V::load(b + r * C * W) * x[0];
    GYRE_UNROLL
    for (int c = 1; c < C; ++c) sum += V::load(b + (r * C + c) * W) * x[c];
    (V::load(y + r * W) - sum).store(y + r * W);
  }
}
// own -= B^T x.
template <int W, int R, int C>
GYRE_INLINE void pull_up(const float* b, const float* x, Wide<W> (&own)[C]) {
  using V = Wide<W>;
  GYRE_UNROLL
  for (int r = 0; r < R; ++r) {
    const V known = V::load(x + r * W);
    GYRE_UNROLL
    for (int c = 0; c < C; ++c) own[c] -= V::load(b + (r * C + c) * W) * known;
  }
}

template <int W, int C>
void solve_column_down(const ArticulationBundle& bundle, const BlockColumn& column, float* vector) {
  using V = Wide<W>;
  const float* const diagonal = bundle.values + std::size_t(column.diagonal) * W;
  float* const x = vector + std::size_t(column.row) * W;
  V own[C];
  GYRE_UNROLL
  for (int r = 0; r < C; ++r) own[r] = V::load(x + r * W);
  GYRE_UNROLL
  for (int c = 0; c < C; ++c) {
    GYRE_UNROLL
    for (int r = c + 1; r < C; ++r) own[r] -= V::load(diagonal + (r * C + c) * W) * own[c];
  }
  GYRE_UNROLL
  for (int r = 1; r < C; ++r) own[r].store(x + r * W);
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const BlockEntry& entry = bundle.entries[i];
    const BlockColumn& row = bundle.columns[entry.index];
    const float* const b = bundle.values + std::size_t(entry.offset) * W;
    float* const y = vector + std::size_t(row.row) * W;
    if (row.size == 3) {
      push_down<W, 3, C>(b, own, y);
    } else {
      push_down<W, 5, C>(b, own, y);
    }
  }
}

// out = P^-1 x, of the column's rows.
template <int W, int C>
GYRE_INLINE void scale_column(const ArticulationBundle& bundle, const BlockColumn& column,
                              const float* vector, float* out) {
  using V = Wide<W>;
  const float* const diagonal = bundle.values + std::size_t(column.diagonal) * W;
  const std::size_t first = std::size_t(column.row) * W;
  GYRE_UNROLL
  for (int r = 0; r < C; ++r)
    (V::load(diagonal + (r * C + r) * W) * V::load(vector + first + r * W)).store(out + first + r * W);
}

template <int W, int C>
void solve_column_up(const ArticulationBundle& bundle, const BlockColumn& column, float* vector) {
  using V = Wide<W>;
  const float* const diagonal = bundle.values + std::size_t(column.diagonal) * W;
  float* const x = vector + std::size_t(column.row) * W;
  V own[C];
  GYRE_UNROLL
  for (int r = 0; r < C; ++r) own[r] = V::load(diagonal + (r * C + r) * W) * V::load(x + r * W);
  for (std::uint32_t i = column.begin; i < column.end; ++i) {
    const BlockEntry& entry = bundle.entries[i];
    const BlockColumn& row = bundle.columns[entry.index];
    const float* const b = bundle.values + std::size_t(entry.offset) * W;
    const float* const known = vector + std::size_t(row.row) * W;
    if (row.size == 3) {
      pull_up<W, 3, C>(b, known, own);
    } else {
      pull_up<W, 5, C>(b, known, own);
    }
  }
  GYRE_UNROLL
  for (int c = C - 1; c > 0; --c) {
    GYRE_UNROLL
    for (int r = 0; r < c; ++r) own[r] -= V::load(diagonal + (c * C + r) * W) * own[c];
  }
  GYRE_UNROLL
  for (int r = 0; r < C; ++r) own[r].store(x + r * W);
}

template <int W>
void factor_lanes(const ArticulationBundle& bundle) {
  for (std::uint32_t place = 0; place < bundle.column_count; ++place) {
    const BlockColumn& column = bundle.columns[place];
    if (column.size == 3) {
      eliminate_column<W, 3>(bundle, column);
    } else {
      eliminate_column<W, 5>(bundle, column);
    }
  }
}

template <int W>
void solve_lanes(const ArticulationBundle& bundle) {
  for (std::uint32_t place = 0; place < bundle.column_count; ++place) {
    const BlockColumn& column = bundle.columns[place];
    if (column.size == 3) {
      solve_column_down<W, 3>(bundle, column, bundle.vector);
    } else {
      solve_column_down<W, 5>(bundle, column, bundle.vector);
    }
  }
  for (std::uint32_t place = bundle.column_count; place-- > 0;) {
    const BlockColumn& column = bundle.columns[place];
    if (column.size == 3) {
      solve_column_up<W, 3>(bundle, column, bundle.vector);
    } else {
      solve_column_up<W, 5>(bundle, column, bundle.vector);
    }
  }
}

// ---------------------------------------------------------------------------------------------- right sides of few rows

// The columns that elimination reaches from such a right side: a bit for each, by its place.
using ReachedColumns = std::uint64_t*;
constexpr std::uint32_t reach_words(std::uint32_t columns) { return (columns + 63) / 64; }

// Calls run(column) for those of the bundle's columns whose bits are set, in their order; word(i) tells the bits from 64 i on.
template <class Word, class Run>
GYRE_INLINE void for_columns(const ArticulationBundle& bundle, const Word& word, const Run& run) {
  const std::uint32_t words = reach_words(bundle.column_count);
  for (std::uint32_t i = 0; i < words; ++i)
    for (std::uint64_t left = word(i); left != 0; left &= left - 1)
      run(bundle.columns[64 * i + std::uint32_t(__builtin_ctzll(left))]);
}

// Marks, beside the columns that are marked, those that elimination reaches from them: all come later.
inline void reach_columns(const ArticulationBundle& bundle, ReachedColumns reached) {
  for (std::uint32_t place = 0; place < bundle.column_count; ++place) {
    if ((reached[place / 64] >> place % 64 & 1u) == 0) continue;
    const BlockColumn& column = bundle.columns[place];
    for (std::uint32_t i = column.begin; i < column.end; ++i) {
      const std::uint32_t other = bundle.entries[i].index;
      reached[other / 64] |= std::uint64_t{1} << other % 64;
    }
  }
}

// Clears their rows in x.
template <int W>
void clear_reached(const ArticulationBundle& bundle, const ReachedColumns reached, float* x) {
  const auto own = [&](std::uint32_t i) { return reached[i]; };
  for_columns(bundle, own, [&](const BlockColumn& column) {
    for (std::uint32_t r = 0; r < column.size; ++r) Wide<W>(0.0f).store(x + (column.row + r) * W);
  });
}

// Replaces the right side x, of the columns that are reached, by y of L y = x, and finds P^-1 y.
template <int W>
void solve_reached_down(const ArticulationBundle& bundle, const ReachedColumns reached, float* x,
                        float* scaled) {
  const auto own = [&](std::uint32_t i) { return reached[i]; };
  for_columns(bundle, own, [&](const BlockColumn& column) {
    if (column.size == 3) {
      solve_column_down<W, 3>(bundle, column, x);
      scale_column<W, 3>(bundle, column, x, scaled);
    } else {
      solve_column_down<W, 5>(bundle, column, x);
      scale_column<W, 5>(bundle, column, x, scaled);
    }
  });
}

template <int W, int N>
GYRE_INLINE void add_products(const float* a, const float* b, Wide<W>& sum) {
  using V = Wide<W>;
  GYRE_UNROLL
  for (int i = 0; i < N; ++i) sum += V::load(a + i * W) * V::load(b + i * W);
}

// The product of two vectors over the columns that both reach.
template <int W>
Wide<W> dot_reached(const ArticulationBundle& bundle, const ReachedColumns reached_a, const float* a,
                    const ReachedColumns reached_b, const float* b) {
  const auto common = [&](std::uint32_t i) { return reached_a[i] & reached_b[i]; };
  Wide<W> sum(0.0f);
  for_columns(bundle, common, [&](const BlockColumn& column) {
    const std::size_t first = std::size_t(column.row) * W;
    if (column.size == 3) {
      add_products<W, 3>(a + first, b + first, sum);
    } else {
      add_products<W, 5>(a + first, b + first, sum);
    }
  });
  return sum;
}

}  // namespace GYRE_TARGET_NAMESPACE
}  // namespace gyre
