#include "solver/rows/complementarity.h"

#include "base/check.h"

namespace gyre {

std::span<double> NumberRoom::take(std::size_t count) {
  GYRE_ASSERT(count <= room_.size(), "the room for a problem was counted too small");
  const std::span<double> taken = room_.first(count);
  room_ = room_.subspan(count);
  return taken;
}

void find_speeds(const DenseProblem& problem, std::span<const double> x, std::span<double> w) {
  const std::size_t n = std::size_t(problem.size);
  for (std::size_t i = 0; i < n; ++i) {
    const double* row = &problem.a[i * n];
    double sum = problem.q[i];
    for (std::size_t j = 0; j < n; ++j) sum += row[j] * x[j];
    w[i] = sum;
  }
}

double dense_residual(const DenseProblem& problem, int i, std::span<const double> x,
                      std::span<const double> w) {
  return row_residual(
      i, problem.limits[std::size_t(i)], *problem.friction, [&](int j) { return x[std::size_t(j)]; },
      [&](int j) { return w[std::size_t(j)]; }, [&](int j) { return problem.at(j, j); });
}

double find_residual(const DenseProblem& problem, std::span<const double> x, std::span<const double> w) {
  double largest = 0.0;
  for (int i = 0; i < problem.size; ++i) largest = max(largest, dense_residual(problem, i, x, w));
  return largest;
}

double impulse_scale(const DenseProblem& problem) {
  double largest = 0.0;
  for (int i = 0; i < problem.size; ++i) {
    const double d = problem.at(i, i), q = problem.q[std::size_t(i)];
    if (d > 0.0) largest = max(largest, (q < 0.0 ? -q : q) / d);
  }
  return largest;
}

}  // namespace gyre
