// The block factorisation with exchanges of rows within a block. See block_lu.h.
#include "math/block_lu.h"

#include "math/wide_double.h"

namespace gyre {

namespace {

constexpr int N = kLuBlock;

// C numbers of a row, as pairs.
template <int C>
struct RowPairs {
  static constexpr int kWidth = C == 1 ? 1 : 2, kCount = C / kWidth;
  using D = WideDouble<kWidth>;
  D v[kCount];

  explicit RowPairs(const double* from) {
    GYRE_UNROLL
    for (int i = 0; i < kCount; ++i) v[i] = D::load_loose(from + kWidth * i);
  }
  void store(double* to) const {
    GYRE_UNROLL
    for (int i = 0; i < kCount; ++i) v[i].store_loose(to + kWidth * i);
  }
  void subtract(double by, const double* row) {
    const D wide(by);
    GYRE_UNROLL
    for (int i = 0; i < kCount; ++i) v[i] -= wide * D::load_loose(row + kWidth * i);
  }
  void divide(double by) {
    const D wide(by);
    GYRE_UNROLL
    for (int i = 0; i < kCount; ++i) v[i] = v[i] / wide;
  }
};

void exchange(double& a, double& b) {
  const double t = a;
  a = b;
  b = t;
}

// Factors a block in place; `pivots` holds the row exchanged with each row.
bool factor_block(double* block, double* pivots) {
  for (int k = 0; k < N; ++k) {
    int best = k;
    double largest = 0.0;
    for (int r = k; r < N; ++r) {
      const double v = block[r * N + k], size = v < 0.0 ? -v : v;
      if (size > largest) largest = size, best = r;
    }
    pivots[k] = double(best);
    if (!(largest > 0.0 && largest < 1.0e300)) return false;
    if (best != k) {
      for (int c = 0; c < N; ++c) exchange(block[k * N + c], block[best * N + c]);
    }
    for (int r = k + 1; r < N; ++r) {
      const double by = block[r * N + k] /= block[k * N + k];
      for (int c = k + 1; c < N; ++c) block[r * N + c] -= by * block[k * N + c];
    }
  }
  return true;
}

// X = block^-1 X, for rows of C numbers.
template <int C>
void solve_block(const double* block, const double* pivots, double* x) {
  for (int k = 0; k < N; ++k) {
    const int other = int(pivots[k]);
    if (other == k) continue;
    for (int c = 0; c < C; ++c) exchange(x[k * C + c], x[other * C + c]);
  }
  for (int r = 1; r < N; ++r) {
    RowPairs<C> row(x + r * C);
    for (int k = 0; k < r; ++k) row.subtract(block[r * N + k], x + k * C);
    row.store(x + r * C);
  }
  for (int r = N; r-- > 0;) {
    RowPairs<C> row(x + r * C);
    for (int k = r + 1; k < N; ++k) row.subtract(block[r * N + k], x + k * C);
    row.divide(block[r * N + r]);
    row.store(x + r * C);
  }
}

// out -= a b.
void subtract_product(const double* a, const double* b, double* out) {
  for (int r = 0; r < N; ++r) {
    RowPairs<N> row(out + r * N);
    GYRE_UNROLL
    for (int k = 0; k < N; ++k) row.subtract(a[r * N + k], b + k * N);
    row.store(out + r * N);
  }
}

// y -= a x.
void subtract_times(const double* a, const double* x, double* y) {
  for (int r = 0; r < N; ++r) {
    double sum = y[r];
    for (int c = 0; c < N; ++c) sum -= a[r * N + c] * x[c];
    y[r] = sum;
  }
}

}  // namespace

bool factor_lu(const BlockLu& lu) {
  const BlockPlan& plan = *lu.plan;
  double* const lower = lu.lower.data();
  double* const upper = lu.upper.data();
  for (const BlockColumn& column : plan.columns) {
    double* const pivots = &lu.pivots[column.row];
    if (!factor_block(lower + column.diagonal, pivots)) return false;
    for (std::uint32_t j = column.begin; j < column.end; ++j)
      solve_block<N>(lower + column.diagonal, pivots, upper + plan.entries[j].offset);
    const std::uint32_t* target = plan.targets.data() + column.targets;
    for (std::uint32_t i = column.begin; i < column.end; ++i) {
      const std::uint32_t own = plan.entries[i].offset;
      for (std::uint32_t j = column.begin; j < i; ++j) {
        const std::uint32_t other = plan.entries[j].offset, to = *target++;
        subtract_product(lower + own, upper + other, lower + to);
        subtract_product(lower + other, upper + own, upper + to);
      }
      subtract_product(lower + own, upper + own, lower + *target++);
    }
  }
  return true;
}

void solve_lu(const BlockLu& lu, std::span<double> x) {
  const BlockPlan& plan = *lu.plan;
  for (const BlockColumn& column : plan.columns) {
    double* const own = &x[column.row];
    solve_block<1>(&lu.lower[column.diagonal], &lu.pivots[column.row], own);
    for (std::uint32_t i = column.begin; i < column.end; ++i)
      subtract_times(&lu.lower[plan.entries[i].offset], own, &x[plan.columns[plan.entries[i].index].row]);
  }
  for (std::size_t index = plan.columns.size(); index-- > 0;) {
    const BlockColumn& column = plan.columns[index];
    for (std::uint32_t i = column.begin; i < column.end; ++i)
      subtract_times(&lu.upper[plan.entries[i].offset], &x[plan.columns[plan.entries[i].index].row],
                     &x[column.row]);
  }
}

}  // namespace gyre
