#include "solver/rows/lcp_lemke.h"

namespace gyre {

namespace {

// Variables have numbers: w_i is i, z_i is n + i, z0 is 2 n. In the dictionary each basic variable is its
// constant plus its row of the tableau times the variables outside the basis.
class Dictionary {
 public:
  Dictionary(std::span<const double> m, std::span<const double> q, double tie_break, NumberRoom& room)
      : n_(q.size()),
        t_(room.take(n_ * (n_ + 1))),
        constant_(room.take(n_)),
        basic_(room.take(n_)),
        outside_(room.take(n_ + 1)) {
    double largest = 0.0;
    for (const double v : q) largest = max(largest, v < 0.0 ? -v : v);
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) at(i, j) = m[i * n_ + j];
      at(i, n_) = 1.0;
      // A golden step: no two rows get nearly the same fraction.
      const double fraction = double((i + 1) * 40503u % 65536u) / 65536.0;
      constant_[i] = q[i] + tie_break * largest * (0.5 + fraction);
      basic_[i] = double(i);
      outside_[i] = double(n_ + i);
    }
    outside_[n_] = double(2 * n_);
  }

  double& at(std::size_t i, std::size_t j) { return t_[i * (n_ + 1) + j]; }
  double constant(std::size_t i) const { return constant_[i]; }
  std::size_t basic(std::size_t i) const { return std::size_t(basic_[i]); }

  // The row that the artificial variable replaces so that all constants are positive; n if none is negative.
  std::size_t find_worst_row() const {
    std::size_t row = n_;
    double smallest = 0.0;
    for (std::size_t i = 0; i < n_; ++i) {
      if (constant_[i] < smallest) smallest = constant_[i], row = i;
    }
    return row;
  }
  // The row that reaches zero first as the variable of a column grows; n if none does. The artificial
  // variable wins ties.
  std::size_t blocking(std::size_t column) {
    std::size_t row = n_;
    double smallest = 0.0, slope = 0.0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double t = at(i, column);
      if (!(t < -1.0e-12)) continue;
      const double until = max(constant_[i], 0.0) / -t;
      const bool is_artificial = basic(i) == 2 * n_;
      if (row == n_ || until < smallest || (until == smallest && (is_artificial || -t > slope))) {
        smallest = until, row = i, slope = -t;
      }
    }
    return row;
  }
  // Exchanges the variable of the row with that of the column.
  void pivot(std::size_t row, std::size_t column) {
    double* const own = &t_[row * (n_ + 1)];
    const double inverse = 1.0 / own[column];
    for (std::size_t j = 0; j <= n_; ++j) own[j] *= -inverse;
    own[column] = inverse;
    constant_[row] *= -inverse;
    for (std::size_t i = 0; i < n_; ++i) {
      if (i == row) continue;
      double* const other = &t_[i * (n_ + 1)];
      const double by = other[column];
      if (by == 0.0) continue;
      for (std::size_t j = 0; j <= n_; ++j) other[j] += by * own[j];
      other[column] = by * inverse;
      constant_[i] += by * constant_[row];
    }
    const double variable = basic_[row];
    basic_[row] = outside_[column];
    outside_[column] = variable;
  }
  std::size_t column_of(std::size_t variable) const {
    std::size_t j = 0;
    while (outside_[j] != double(variable)) ++j;
    return j;
  }

 private:
  std::size_t n_;
  std::span<double> t_, constant_, basic_, outside_;
};

}  // namespace

LemkeResult solve_lemke(std::span<const double> m, std::span<const double> q, double tie_break,
                        int max_pivots, std::span<double> z, NumberRoom& room) {
  const std::size_t n = q.size();
  for (double& value : z) value = 0.0;
  LemkeResult result{LemkeEnd::solved, 0};
  Dictionary dictionary(m, q, tie_break, room);
  std::size_t row = dictionary.find_worst_row();
  if (row == n) return result;
  std::size_t column = n;
  for (;;) {
    const std::size_t leaving = dictionary.basic(row);
    dictionary.pivot(row, column);
    ++result.pivots;
    if (leaving == 2 * n) break;
    if (result.pivots > max_pivots) {
      result.end = LemkeEnd::gave_up;
      break;
    }
    column = dictionary.column_of(leaving < n ? leaving + n : leaving - n);
    row = dictionary.blocking(column);
    if (row == n) {
      result.end = LemkeEnd::ray;
      break;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t variable = dictionary.basic(i);
    if (variable >= n && variable < 2 * n) z[variable - n] = max(dictionary.constant(i), 0.0);
  }
  return result;
}

}  // namespace gyre
