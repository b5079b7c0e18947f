#include "solver/rows/solve_newton.h"

#include "solver/rows/natural_map.h"

namespace gyre {

namespace {

class DenseNewton {
 public:
  DenseNewton(const DenseProblem& problem, NumberRoom& room)
      : problem_(problem), matrix_(room.take(rows() * rows())) {}

  std::size_t rows() const { return std::size_t(problem_.size); }
  void find_speeds(std::span<const double> x, std::span<double> w) const {
    gyre::find_speeds(problem_, x, w);
  }
  double residual_of(int i, std::span<const double> x, std::span<const double> w) const {
    return dense_residual(problem_, i, x, w);
  }
  void find_change(std::span<const double> dx, std::span<double> dw) const {
    const std::size_t n = rows();
    for (std::size_t i = 0; i < n; ++i) {
      double sum = 0.0;
      for (std::size_t j = 0; j < n; ++j) sum += problem_.a[i * n + j] * dx[j];
      dw[i] = sum;
    }
  }
  bool find_step(std::span<const double> x, std::span<const double> w, double damping, std::span<double> dx) {
    for (double& value : matrix_) value = 0.0;
    for (int i = 0; i < problem_.size; ++i) {
      const RowLimits& limits = problem_.limits[std::size_t(i)];
      if (limits.kind == RowKind::cone_second) continue;
      const bool is_cone = limits.kind == RowKind::cone;
      const std::size_t k = std::size_t(i);
      MapPoint at{{x[k], 0.0}, {w[k], 0.0}, problem_.at(i, i), 0.0, damping};
      if (is_cone) at.x[1] = x[k + 1], at.w[1] = w[k + 1], at.rate = max(at.rate, problem_.at(i + 1, i + 1));
      if (limits.kind != RowKind::box) at.load = load_of(limits, [&](int j) { return x[std::size_t(j)]; });
      const MapEquations e =
          is_cone ? cone_equations(limits, *problem_.friction, at) : scalar_equation(limits, at);
      const int count = is_cone ? 2 : 1;
      for (int row = 0; row < count; ++row) write(e, row, i, count, limits, dx);
    }
    return solve(dx);
  }

 private:
  // Writes equation `row` of those that begin at row i of the problem.
  void write(const MapEquations& e, int row, int i, int count, const RowLimits& limits,
             std::span<double> right) {
    const std::size_t n = rows();
    double* const to = &matrix_[std::size_t(i + row) * n];
    for (int k = 0; k < count; ++k) {
      to[i + k] += e.own[row][k];
      if (e.speed[row][k] == 0.0) continue;
      const double* const from = &problem_.a[std::size_t(i + k) * n];
      for (std::size_t j = 0; j < n; ++j) to[j] += e.speed[row][k] * from[j];
    }
    if (e.load[row] != 0.0) {
      for (std::int32_t k = 0; k < limits.load_count; ++k) to[limits.load_first + k] += e.load[row];
    }
    right[std::size_t(i + row)] = e.right[row];
  }

  // Gaussian elimination with partial pivoting; false if singular.
  bool solve(std::span<double> right) {
    const std::size_t n = rows();
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t best = k;
      double largest = 0.0;
      for (std::size_t i = k; i < n; ++i) {
        const double v = matrix_[i * n + k], size = v < 0.0 ? -v : v;
        if (size > largest) largest = size, best = i;
      }
      if (!(largest > 1.0e-14)) return false;
      if (best != k) {
        for (std::size_t j = k; j < n; ++j) {
          const double v = matrix_[k * n + j];
          matrix_[k * n + j] = matrix_[best * n + j];
          matrix_[best * n + j] = v;
        }
        const double v = right[k];
        right[k] = right[best];
        right[best] = v;
      }
      const double* const own = &matrix_[k * n];
      for (std::size_t i = k + 1; i < n; ++i) {
        double* const other = &matrix_[i * n];
        if (other[k] == 0.0) continue;
        const double by = other[k] / own[k];
        for (std::size_t j = k + 1; j < n; ++j) other[j] -= by * own[j];
        right[i] -= by * right[k];
      }
    }
    for (std::size_t k = n; k-- > 0;) {
      double sum = right[k];
      for (std::size_t j = k + 1; j < n; ++j) sum -= matrix_[k * n + j] * right[j];
      right[k] = sum / matrix_[k * n + k];
    }
    return true;
  }

  const DenseProblem& problem_;
  std::span<double> matrix_;
};

}  // namespace

NewtonResult solve_newton(const DenseProblem& problem, double tolerance, int max_steps, std::span<double> x,
                          NumberRoom room) {
  DenseNewton newton(problem, room);
  return newton_search(newton, tolerance, max_steps, x, room);
}

}  // namespace gyre
