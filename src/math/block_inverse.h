// The inverse of one dense block of a sparse matrix (block_ldlt.h), by L D L^T.
#pragma once

#include "math/dense.h"

namespace gyre {

// Inverts a block; rows with dropped pivots become zero.
template <int N>
void invert_block(double* block) {
  double a[N][N];
  for (int r = 0; r < N; ++r) {
    for (int c = 0; c < N; ++c) a[r][c] = block[r * N + c];
  }
  const Ldlt<N, double> f = factor_ldlt(a);
  // The inverse of L, below its diagonal. In the column of a dropped pivot only the pivot's own row would remain, as
  // zero.
  double inverse[N][N] = {};
  for (int c = 0; c < N; ++c) {
    inverse[c][c] = 1.0;
    for (int r = c + 1; r < N; ++r) {
      double sum = 0.0;
      for (int k = c; k < r; ++k) sum += f.lower[r][k] * inverse[k][c];
      inverse[r][c] = -sum;
    }
  }
  for (int r = 0; r < N; ++r) {
    for (int c = 0; c <= r; ++c) {
      double sum = 0.0;
      for (int k = r; k < N; ++k) sum += inverse[k][r] * f.inverse_pivot[k] * inverse[k][c];
      block[r * N + c] = block[c * N + r] = sum;
    }
  }
}

}  // namespace gyre
