// Eigenvectors reproduce their matrix; factorisations solve singular and badly scaled systems, too.
#include "math/dense.h"

#include "random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace gyre::dense_test {
namespace {

struct Random : testing_random::Mixed {
  Random() : Mixed{0x853c49e6748fea9bu} {}
};

// The properties of an eigen decomposition: ascending, orthonormal, right-handed, and A diag A^T is the matrix.
void expect_eigen(const double (&m)[6]) {
  double moments[3], a[9];
  symmetric_eigen(m, moments, a);
  EXPECT_LE(moments[0], moments[1]);
  EXPECT_LE(moments[1], moments[2]);
  double size = 0.0;
  for (const double value : m) size = std::fmax(size, std::fabs(value));
  constexpr int kPlace[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double product = 0.0, inner = 0.0;
      for (int k = 0; k < 3; ++k) {
        product += a[3 * k + i] * moments[k] * a[3 * k + j];
        inner += a[3 * i + k] * a[3 * j + k];
      }
      EXPECT_NEAR(product / size, m[kPlace[i][j]] / size, 1.0e-14);
      EXPECT_NEAR(inner, i == j ? 1.0 : 0.0, 1.0e-14);
    }
  }
  const double handed = a[0] * (a[4] * a[8] - a[5] * a[7]) + a[1] * (a[5] * a[6] - a[3] * a[8]) +
                        a[2] * (a[3] * a[7] - a[4] * a[6]);
  EXPECT_NEAR(handed, 1.0, 1.0e-14);
}

TEST(Dense, EigenOfRandomMatrices) {
  Random random;
  for (int i = 0; i < 3000; ++i) {
    const double size = std::pow(10.0, random.between(-150, 150));
    double m[6];
    for (double& value : m) value = size * random.between(-1, 1);
    // Some with off-diagonals far below the diagonal.
    if (i % 3 == 0) {
      for (int k = 3; k < 6; ++k) m[k] *= std::pow(10.0, -random.between(0, 30));
    }
    expect_eigen(m);
  }
}

TEST(Dense, EigenOfSpecialMatrices) {
  expect_eigen({1, 1, 1, 0, 0, 0});
  expect_eigen({3, 2, 1, 0, 0, 0});
  expect_eigen({1, 1, 1, 1, 1, 1});
  expect_eigen({1, 1, 1, 1, 0, 0});
  expect_eigen({0, 0, 0, 1, 2, 3});
  expect_eigen({1, 1 + 1e-15, 1, 1e-15, 1e-16, 0});
  expect_eigen({1, 1e-12, 1e-12, 1e-9, 0, 0});

  // A diagonal matrix keeps the coordinate axes, equal moments in their order.
  double moments[3], axes[9];
  symmetric_eigen(std::vector<double>{2, 2, 2, 0, 0, 0}.data(), moments, axes);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(axes[i], i % 4 == 0 ? 1.0 : 0.0);
  symmetric_eigen(std::vector<double>{0, 0, 0, 0, 0, 0}.data(), moments, axes);
  for (const double moment : moments) EXPECT_EQ(moment, 0.0);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(axes[i], i % 4 == 0 ? 1.0 : 0.0);
  for (int index = 0; index < 6; ++index) {
    std::vector<double> m{1, 1, 1, 0, 0, 0};
    m[std::size_t(index)] = index % 2 == 0 ? std::numeric_limits<double>::quiet_NaN() : -INFINITY;
    symmetric_eigen(m.data(), moments, axes);
    EXPECT_TRUE(std::isnan(moments[0]) && std::isnan(moments[1]) && std::isnan(moments[2]));
    EXPECT_EQ(axes[0], 1.0);
  }
}

TEST(Dense, InverseOf3x3) {
  Random random;
  for (int i = 0; i < 500; ++i) {
    double m[9], inverse[9];
    for (double& value : m) value = random.between(-1, 1);
    for (int k = 0; k < 3; ++k) m[4 * k] += 3.0;
    ASSERT_TRUE(invert_3x3(m, inverse));
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        double sum = 0.0;
        for (int k = 0; k < 3; ++k) sum += m[3 * k + row] * inverse[3 * column + k];
        EXPECT_NEAR(sum, row == column ? 1.0 : 0.0, 1.0e-13);
      }
    }
  }
  double inverse[9] = {1, 1, 1, 1, 1, 1, 1, 1, 1};
  const double flat[9] = {1, 2, 3, 2, 4, 6, 0, 0, 1};
  EXPECT_FALSE(invert_3x3(flat, inverse));
  for (const double value : inverse) EXPECT_EQ(value, 0.0);
}

// J M J^T of a random J: symmetric and positive (semi-)definite, like a constraint matrix.
template <int N, class T>
void constraint_matrix(Random& random, int rank, T (&a)[N][N]) {
  double j[N][N] = {};
  for (auto& row : j) {
    for (int k = 0; k < rank; ++k) row[k] = random.between(-1, 1);
  }
  for (int r = 0; r < N; ++r) {
    for (int c = 0; c < N; ++c) {
      double sum = 0.0;
      for (int k = 0; k < N; ++k) sum += j[r][k] * j[c][k] * (1.0 + k);
      a[r][c] = T(sum);
    }
  }
}

template <int N, class T>
void expect_solves(double tolerance) {
  Random random;
  for (int i = 0; i < 200; ++i) {
    T a[N][N], x[N], b[N];
    constraint_matrix(random, N, a);
    for (int k = 0; k < N; ++k) a[k][k] += T(0.5);
    for (int k = 0; k < N; ++k) x[k] = b[k] = T(random.between(-1, 1));
    EXPECT_EQ(solve_ldlt(a, x), N);
    for (int r = 0; r < N; ++r) {
      double sum = 0.0;
      for (int c = 0; c < N; ++c) sum += double(a[r][c]) * double(x[c]);
      EXPECT_NEAR(sum, double(b[r]), tolerance);
    }
  }
}

TEST(Dense, FixedSizesSolve) {
  expect_solves<1, float>(1.0e-5);
  expect_solves<2, float>(1.0e-5);
  expect_solves<3, float>(1.0e-5);
  expect_solves<4, float>(2.0e-5);
  expect_solves<5, float>(2.0e-5);
  expect_solves<6, float>(3.0e-5);
  expect_solves<1, double>(1.0e-13);
  expect_solves<3, double>(1.0e-13);
  expect_solves<6, double>(1.0e-13);
}

TEST(Dense, RedundantRowsAreDropped) {
  Random random;
  for (int rank = 0; rank <= 6; ++rank) {
    double a[6][6];
    constraint_matrix(random, rank, a);
    // A right side that the matrix can reach.
    double known[6], b[6], x[6];
    for (double& value : known) value = random.between(-1, 1);
    for (int r = 0; r < 6; ++r) {
      b[r] = 0.0;
      for (int c = 0; c < 6; ++c) b[r] += a[r][c] * known[c];
      x[r] = b[r];
    }
    EXPECT_EQ(solve_ldlt(a, x), rank);
    for (int r = 0; r < 6; ++r) {
      double sum = 0.0;
      for (int c = 0; c < 6; ++c) sum += a[r][c] * x[c];
      EXPECT_NEAR(sum, b[r], 1.0e-9);
    }
  }
}

std::vector<double> random_spd(Random& random, int n, int rank, double diagonal) {
  std::vector<double> j(std::size_t(n * rank)), a(std::size_t(n * n));
  for (double& value : j) value = random.between(-1, 1);
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) {
      double sum = r == c ? diagonal : 0.0;
      for (int k = 0; k < rank; ++k) sum += j[std::size_t(r * rank + k)] * j[std::size_t(c * rank + k)];
      a[std::size_t(r * n + c)] = sum;
    }
  }
  return a;
}

TEST(Dense, RunTimeSizesSolve) {
  Random random;
  for (const int n : {0, 1, 2, 3, 7, 40, 150}) {
    const std::vector<double> a = random_spd(random, n, n, 0.1);
    std::vector<double> factors = a, b(std::size_t(n), 0.0);
    for (double& value : b) value = random.between(-1, 1);
    std::vector<double> x = b;
    EXPECT_EQ(factor_ldlt(factors, n), n);
    solve_ldlt(factors, n, x);
    for (int r = 0; r < n; ++r) {
      double sum = 0.0;
      for (int c = 0; c < n; ++c) sum += a[std::size_t(r * n + c)] * x[std::size_t(c)];
      EXPECT_NEAR(sum, b[std::size_t(r)], 1.0e-9);
    }
  }
}

TEST(Dense, RunTimeSizesDropRedundantRows) {
  Random random;
  const int n = 60, rank = 37;
  const std::vector<double> a = random_spd(random, n, rank, 0.0);
  std::vector<double> factors = a, known(n), x(n, 0.0);
  for (double& value : known) value = random.between(-1, 1);
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) x[std::size_t(r)] += a[std::size_t(r * n + c)] * known[std::size_t(c)];
  }
  const std::vector<double> b = x;
  EXPECT_EQ(factor_ldlt(factors, n), rank);
  solve_ldlt(factors, n, x);
  for (int r = 0; r < n; ++r) {
    double sum = 0.0;
    for (int c = 0; c < n; ++c) sum += a[std::size_t(r * n + c)] * x[std::size_t(c)];
    EXPECT_NEAR(sum, b[std::size_t(r)], 1.0e-7);
  }
}

TEST(Dense, FixedAndRunTimeSizesAgree) {
  Random random;
  double a[6][6];
  constraint_matrix(random, 6, a);
  std::vector<double> flat;
  for (const auto& row : a) flat.insert(flat.end(), row, row + 6);
  double x[6] = {1, 2, 3, 4, 5, 6};
  std::vector<double> y(x, x + 6);
  solve_ldlt(a, x);
  factor_ldlt(flat, 6);
  solve_ldlt(flat, 6, y);
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(x[i], y[std::size_t(i)], 1.0e-9 * (1.0 + std::fabs(x[i])));
}

TEST(Dense, NegativeOrNotANumberPivotsAreDropped) {
  const double a[2][2] = {{-1.0, 0.0}, {0.0, 2.0}};
  double x[2] = {1.0, 4.0};
  EXPECT_EQ(solve_ldlt(a, x), 1);
  EXPECT_EQ(x[0], 0.0);
  EXPECT_EQ(x[1], 2.0);
}

}  // namespace
}  // namespace gyre::dense_test
