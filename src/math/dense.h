// Small dense linear algebra: symmetric 3x3 eigenvectors, 3x3 inverse, and L D L^T factorisations of fixed size (blocks
// of one to six rows, for joints) and of run-time size (up to a few hundred rows, for direct solvers).
//
// Matrices of constraints are symmetric and at least positive semi-definite; redundant constraints make them singular.
// A pivot that is only rounding is therefore dropped: its unknown becomes zero and the others are solved, without
// failure or huge values. All orders of summation are fixed.
//
// Source: G. H. Golub and C. F. Van Loan, "Matrix Computations", sections 4.1 (LDL^T) and 8.5 (Jacobi).
#pragma once

#include <span>

namespace gyre {

// The eigenvalues (ascending) and eigenvectors of the symmetric matrix m = [xx, yy, zz, xy, xz, yz]: matrix = A
// diag(moments) A^T, where `axes` holds the columns of the rotation A one after the other. Equal eigenvalues keep the
// order of the coordinate axes. Each axis points to the side of its largest component, except the last, which makes
// them right-handed; so near-diagonal matrices give near-identical axes. A matrix that is not finite gives NaN moments
// and coordinate axes.
void symmetric_eigen(const double m[6], double moments[3], double axes[9]);

// The inverse of the 3x3 matrix `m` (by columns); false, and zeros, if it is singular.
bool invert_3x3(const double m[9], double inverse[9]);

// ------------------------------------------------------------------------------------------------------- fixed sizes

// A factorisation a = L D L^T of a symmetric N x N matrix; L has ones on its diagonal.
template <int N, class T>
struct Ldlt {
  T lower[N][N];       // strictly below the diagonal
  T inverse_pivot[N];  // 1 / D; 0 where the pivot was dropped
  int rank;            // number of pivots that were not dropped
};

// Factors `a`, whose lower triangle is read. A pivot is dropped if it is below `tolerance` times its diagonal element,
// that is if the rows before explain all but rounding of it.
template <int N, class T>
inline Ldlt<N, T> factor_ldlt(const T (&a)[N][N], T tolerance = sizeof(T) == 4 ? T(1.0e-6) : T(1.0e-13)) {
  Ldlt<N, T> f{};
  for (int j = 0; j < N; ++j) {
    T scaled[N] = {};  // row j of L times D
    T pivot = a[j][j];
    for (int k = 0; k < j; ++k) {
      // lower[j][k] holds L * D until here; now it becomes L.
      scaled[k] = f.lower[j][k];
      f.lower[j][k] = scaled[k] * f.inverse_pivot[k];
      pivot -= f.lower[j][k] * scaled[k];
    }
    const bool is_kept = pivot > tolerance * a[j][j];
    f.inverse_pivot[j] = is_kept ? T(1) / pivot : T(0);
    f.rank += is_kept ? 1 : 0;
    for (int i = j + 1; i < N; ++i) {
      T sum = a[i][j];
      for (int k = 0; k < j; ++k) sum -= f.lower[i][k] * f.lower[j][k];
      f.lower[i][j] = is_kept ? sum : T(0);
    }
  }
  return f;
}

// Solves a x = b in place: `x` is b before and the solution after.
template <int N, class T>
inline void solve_ldlt(const Ldlt<N, T>& f, T (&x)[N]) {
  for (int i = 1; i < N; ++i) {
    for (int k = 0; k < i; ++k) x[i] -= f.lower[i][k] * x[k];
  }
  for (int i = 0; i < N; ++i) x[i] *= f.inverse_pivot[i];
  for (int i = N - 2; i >= 0; --i) {
    for (int k = i + 1; k < N; ++k) x[i] -= f.lower[k][i] * x[k];
  }
}

// Factors and solves; returns the rank.
template <int N, class T>
inline int solve_ldlt(const T (&a)[N][N], T (&x)[N]) {
  const Ldlt<N, T> f = factor_ldlt(a);
  solve_ldlt(f, x);
  return f.rank;
}

// ---------------------------------------------------------------------------------------------------- run-time sizes

// Factors the symmetric matrix of `size` rows in `a` (row after row; the lower triangle is read) in place: the strict
// lower triangle becomes L and the diagonal 1/D, 0 for dropped pivots. The upper triangle is not touched. Returns the
// rank.
int factor_ldlt(std::span<double> a, int size, double tolerance = 1.0e-12);
// Solves with the factors of factor_ldlt; `x` is the right side before and the solution after.
void solve_ldlt(std::span<const double> factors, int size, std::span<double> x);

}  // namespace gyre
