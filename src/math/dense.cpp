// Jacobi eigenvectors, the 3x3 inverse and the L D L^T of run-time size; see dense.h.
#include "math/dense.h"

#include <cmath>
#include <cstddef>
#include <limits>

#include "base/check.h"

namespace gyre {
namespace {

// One Jacobi rotation in the plane (p, q): makes a[p][q] zero and rotates the columns of `v` with it.
void jacobi_rotation(double (&a)[3][3], double (&v)[3][3], int p, int q) {
  const double off = a[p][q];
  if (off == 0.0) return;
  const double theta = 0.5 * (a[q][q] - a[p][p]) / off;
  // The smaller root of t^2 + 2 theta t - 1 = 0: a rotation by at most 45 degrees. A huge theta gives t = 0.
  const double magnitude = theta < 0.0 ? -theta : theta;
  const double root = 1.0 / (magnitude + std::sqrt(theta * theta + 1.0));
  const double t = theta < 0.0 ? -root : root;
  const double c = 1.0 / std::sqrt(t * t + 1.0);
  const double s = t * c;
  const int r = 3 - p - q;
  a[p][p] -= t * off;
  a[q][q] += t * off;
  a[p][q] = a[q][p] = 0.0;
  const double rp = a[r][p], rq = a[r][q];
  a[r][p] = a[p][r] = c * rp - s * rq;
  a[r][q] = a[q][r] = s * rp + c * rq;
  for (int i = 0; i < 3; ++i) {
    const double ip = v[i][p], iq = v[i][q];
    v[i][p] = c * ip - s * iq;
    v[i][q] = s * ip + c * iq;
  }
}

// The sign that makes the largest component of a column positive.
double column_sign(const double (&v)[3][3], int column) {
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    if (std::fabs(v[i][column]) > std::fabs(largest)) largest = v[i][column];
  }
  return largest < 0.0 ? -1.0 : 1.0;
}

}  // namespace

void symmetric_eigen(const double m[6], double moments[3], double axes[9]) {
  double scale = 0.0;
  bool finite = true;
  for (int i = 0; i < 6; ++i) {
    scale = std::fabs(m[i]) > scale ? std::fabs(m[i]) : scale;
    finite = finite && m[i] - m[i] == 0.0;
  }
  for (int i = 0; i < 9; ++i) axes[i] = i % 4 == 0 ? 1.0 : 0.0;
  if (!finite || scale == 0.0) {
    const double value = finite ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    for (int i = 0; i < 3; ++i) moments[i] = value;
    return;
  }

  // Scaled to size 1, so that squares neither overflow nor vanish.
  double a[3][3] = {{m[0] / scale, m[3] / scale, m[4] / scale},
                    {m[3] / scale, m[1] / scale, m[5] / scale},
                    {m[4] / scale, m[5] / scale, m[2] / scale}};
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  // Convergence is quadratic: four or five iterations reach the last bit; the bound is only for safety.
  for (int iteration = 0; iteration < 30; ++iteration) {
    const double off = std::fabs(a[0][1]) + std::fabs(a[0][2]) + std::fabs(a[1][2]);
    if (off < 1.0e-40) break;
    jacobi_rotation(a, v, 0, 1);
    jacobi_rotation(a, v, 0, 2);
    jacobi_rotation(a, v, 1, 2);
  }

  int order[3] = {0, 1, 2};  // ascending, ties in the order of the axes
  for (int i = 1; i < 3; ++i) {
    for (int j = i; j > 0 && a[order[j]][order[j]] < a[order[j - 1]][order[j - 1]]; --j) {
      const int swapped = order[j];
      order[j] = order[j - 1];
      order[j - 1] = swapped;
    }
  }
  for (int i = 0; i < 3; ++i) moments[i] = scale * a[order[i]][order[i]];
  for (int i = 0; i < 2; ++i) {
    const double sign = column_sign(v, order[i]);
    for (int row = 0; row < 3; ++row) axes[3 * i + row] = sign * v[row][order[i]];
  }
  for (int row = 0; row < 3; ++row) {
    const int next = (row + 1) % 3, last = (row + 2) % 3;
    axes[6 + row] = axes[next] * axes[3 + last] - axes[last] * axes[3 + next];
  }
}

bool invert_3x3(const double m[9], double inverse[9]) {
  // Row i of the inverse is the cross product of the two other columns over the determinant.
  double rows[3][3];
  for (int i = 0; i < 3; ++i) {
    const double* b = m + 3 * ((i + 1) % 3);
    const double* c = m + 3 * ((i + 2) % 3);
    for (int k = 0; k < 3; ++k)
      rows[i][k] = b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3];
  }
  const double determinant = m[0] * rows[0][0] + m[1] * rows[0][1] + m[2] * rows[0][2];
  const double factor = 1.0 / determinant;
  const bool regular = determinant != 0.0 && factor - factor == 0.0;
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row) inverse[3 * column + row] = regular ? factor * rows[row][column] : 0.0;
  }
  return regular;
}

int factor_ldlt(std::span<double> a, int size, double tolerance) {
  const std::size_t n = std::size_t(size);
  GYRE_ASSERT(size >= 0 && a.size() >= n * n, "the matrix holds size * size numbers");
  int rank = 0;
  // Row by row, so that both rows of each inner product are contiguous. Row i is first L D, then L.
  for (std::size_t i = 0; i < n; ++i) {
    double* row = a.data() + i * n;
    for (std::size_t j = 0; j < i; ++j) {
      const double* other = a.data() + j * n;
      double sum = row[j];
      for (std::size_t k = 0; k < j; ++k) sum -= row[k] * other[k];
      row[j] = other[j] != 0.0 ? sum : 0.0;
    }
    const double whole = row[i];
    double pivot = whole;
    for (std::size_t k = 0; k < i; ++k) {
      const double scaled = row[k];
      row[k] = scaled * a[k * n + k];
      pivot -= row[k] * scaled;
    }
    const bool is_kept = pivot > tolerance * whole;
    row[i] = is_kept ? 1.0 / pivot : 0.0;
    rank += is_kept ? 1 : 0;
  }
  return rank;
}

void solve_ldlt(std::span<const double> factors, int size, std::span<double> x) {
  const std::size_t n = std::size_t(size);
  GYRE_ASSERT(size >= 0 && factors.size() >= n * n && x.size() >= n,
              "factors and vector hold the whole system");
  for (std::size_t i = 1; i < n; ++i) {
    const double* row = factors.data() + i * n;
    double sum = x[i];
    for (std::size_t k = 0; k < i; ++k) sum -= row[k] * x[k];
    x[i] = sum;
  }
  for (std::size_t i = 0; i < n; ++i) x[i] *= factors[i * n + i];
  for (std::size_t i = n; i-- > 1;) {
    const double* row = factors.data() + i * n;
    const double value = x[i];
    for (std::size_t k = 0; k < i; ++k) x[k] -= row[k] * value;
  }
}

}  // namespace gyre
