#include "solver/solve_newton.h"

#include <cmath>
#include <iterator>

namespace gyre {

namespace {

// Share of A_ii by which a step is kept small where rows are redundant: at most, far from the solution, and at least.
constexpr double kMostNear = 1.0e-4, kLeastNear = 1.0e-10;
// Shares of a step that are tried until one makes the residuals' sum of squares less.
constexpr double kShares[] = {1.0, 0.5, 0.25, 0.1, 0.03};
// Steps without progress after which it is given up.
constexpr int kPatience = 6;

// The linear equations of one step: J step = -F, J by rows.
struct Equations {
  const DenseProblem& problem;
  std::span<const double> x, w;
  std::span<double> matrix, right;
  std::size_t n;
  double near;

  double* row(int i) const { return &matrix[std::size_t(i) * n]; }
  // Adds `share` times the derivative of w_i, per A_ii like `rate`.
  void add_speed(double* to, int i, double share) const {
    const double* from = &problem.a[std::size_t(i) * n];
    for (std::size_t j = 0; j < n; ++j) to[j] += share * from[j];
  }
  void add_load(double* to, const RowLimits& limits, double share) const {
    for (std::int32_t k = 0; k < limits.load_count; ++k) to[limits.load_first + k] += share;
  }
  // w_i = 0.
  void rest(int i, double rate) const {
    add_speed(row(i), i, 1.0 / rate);
    row(i)[i] += near;
    right[std::size_t(i)] = -w[std::size_t(i)] / rate;
  }
  // x_i = value, which grows by `per_load` with the load.
  void hold(int i, double value, const RowLimits& limits, double per_load) const {
    row(i)[i] = 1.0;
    if (per_load != 0.0) add_load(row(i), limits, -per_load);
    right[std::size_t(i)] = value - x[std::size_t(i)];
  }
  double load(const RowLimits& limits) const {
    return load_of(limits, [&](int j) { return x[std::size_t(j)]; });
  }

  void write_scalar(int i) const {
    const RowLimits& limits = problem.limits[std::size_t(i)];
    const double d = problem.at(i, i);
    if (!(d > 0.0)) return hold(i, 0.0, limits, 0.0);
    double low = limits.low, high = limits.high, share = 0.0;
    if (limits.kind == RowKind::load) {
      const double load_now = load(limits);
      if (!(load_now > 0.0)) return hold(i, 0.0, limits, 0.0);
      share = limits.friction;
      high = share * load_now;
      low = -high;
    }
    const double p = x[std::size_t(i)] - w[std::size_t(i)] / d;
    if (p <= low) return hold(i, low, limits, -share);
    if (p >= high) return hold(i, high, limits, share);
    rest(i, d);
  }

  // x . direction = value, growing by `per_load` with the load, in row i of a cone.
  void hold_along(int into, int i, const double (&direction)[2], double value, const RowLimits& limits,
                  double per_load) const {
    double* const to = row(into);
    to[i] += direction[0];
    to[i + 1] += direction[1];
    add_load(to, limits, -per_load);
    right[std::size_t(into)] =
        value - direction[0] * x[std::size_t(i)] - direction[1] * x[std::size_t(i) + 1];
  }
  void rest_along(int into, int i, const double (&direction)[2], double rate, double share) const {
    double* const to = row(into);
    for (int k = 0; k < 2; ++k) {
      add_speed(to, i + k, share * direction[k] / rate);
      to[i + k] += near * direction[k];
    }
    right[std::size_t(into)] -=
        share * (direction[0] * w[std::size_t(i)] + direction[1] * w[std::size_t(i) + 1]) / rate;
  }

  void write_cone(int i) const {
    const RowLimits& limits = problem.limits[std::size_t(i)];
    const double rate = max(problem.at(i, i), problem.at(i + 1, i + 1));
    const double radius = limits.friction * load(limits);
    if (!(radius > 0.0) || !(rate > 0.0)) {
      hold(i, 0.0, limits, 0.0);
      return hold(i + 1, 0.0, limits, 0.0);
    }
    const double px = x[std::size_t(i)] - w[std::size_t(i)] / rate;
    const double py = x[std::size_t(i) + 1] - w[std::size_t(i) + 1] / rate;
    const FrictionSet& set = *problem.friction;
    const FrictionPoint nearest = nearest_friction(set, radius, px, py);
    switch (nearest.place) {
      case FrictionPlace::inside:
        rest(i, rate);
        return rest(i + 1, rate);
      case FrictionPlace::corner:
        hold(i, nearest.x, limits, limits.friction * set.corner[nearest.index][0]);
        return hold(i + 1, nearest.y, limits, limits.friction * set.corner[nearest.index][1]);
      case FrictionPlace::side: {
        const double out[2] = {set.side[nearest.index][0], set.side[nearest.index][1]};
        const double along[2] = {-out[1], out[0]};
        hold_along(i, i, out, set.inner * radius, limits, set.inner * limits.friction);
        return rest_along(i + 1, i, along, rate, 1.0);
      }
      case FrictionPlace::rim: {
        const double size = std::sqrt(px * px + py * py), share = radius / size;
        const double out[2] = {px / size, py / size}, along[2] = {-out[1], out[0]};
        hold_along(i, i, out, radius, limits, limits.friction);
        // Across: the direction of p turns with it.
        double* const to = row(i + 1);
        for (int k = 0; k < 2; ++k) {
          to[i + k] += (1.0 - share) * along[k];
          add_speed(to, i + k, share * along[k] / rate);
          to[i + k] += near * along[k];
        }
        right[std::size_t(i) + 1] = -(along[0] * x[std::size_t(i)] + along[1] * x[std::size_t(i) + 1]);
        return;
      }
    }
  }

  void write() const {
    for (double& value : matrix) value = 0.0;
    for (double& value : right) value = 0.0;
    for (int i = 0; i < problem.size; ++i) {
      const RowKind kind = problem.limits[std::size_t(i)].kind;
      if (kind == RowKind::cone) write_cone(i);
      if (kind == RowKind::box || kind == RowKind::load) write_scalar(i);
    }
  }

  // Gauss's elimination with partial pivoting; false if singular.
  bool solve() const {
    for (std::size_t k = 0; k < n; ++k) {
      std::size_t best = k;
      double most = 0.0;
      for (std::size_t i = k; i < n; ++i) {
        const double v = matrix[i * n + k], size = v < 0.0 ? -v : v;
        if (size > most) most = size, best = i;
      }
      if (!(most > 1.0e-14)) return false;
      if (best != k) {
        for (std::size_t j = k; j < n; ++j) {
          const double v = matrix[k * n + j];
          matrix[k * n + j] = matrix[best * n + j];
          matrix[best * n + j] = v;
        }
        const double v = right[k];
        right[k] = right[best];
        right[best] = v;
      }
      const double* const own = &matrix[k * n];
      for (std::size_t i = k + 1; i < n; ++i) {
        double* const other = &matrix[i * n];
        if (other[k] == 0.0) continue;
        const double by = other[k] / own[k];
        for (std::size_t j = k + 1; j < n; ++j) other[j] -= by * own[j];
        right[i] -= by * right[k];
      }
    }
    for (std::size_t k = n; k-- > 0;) {
      double sum = right[k];
      for (std::size_t j = k + 1; j < n; ++j) sum -= matrix[k * n + j] * right[j];
      right[k] = sum / matrix[k * n + k];
    }
    return true;
  }
};

double sum_of_squares(const DenseProblem& problem, std::span<const double> x, std::span<const double> w) {
  double sum = 0.0;
  for (int i = 0; i < problem.size; ++i) {
    sum += square(row_residual(
        i, problem.limits[std::size_t(i)], *problem.friction, [&](int j) { return x[std::size_t(j)]; },
        [&](int j) { return w[std::size_t(j)]; }, [&](int j) { return problem.at(j, j); }));
  }
  return sum;
}

}  // namespace

NewtonResult solve_newton(const DenseProblem& problem, double tolerance, int most_steps, std::span<double> x,
                          NumberRoom room) {
  const std::size_t n = std::size_t(problem.size);
  const std::span<double> matrix = room.take(n * n), right = room.take(n), w = room.take(n),
                          now = room.take(n), next = room.take(n);
  for (std::size_t i = 0; i < n; ++i) now[i] = x[i];
  find_speeds(problem, now, w);
  double residual = find_residual(problem, now, w), squares = sum_of_squares(problem, now, w);
  NewtonResult result{residual, 0};
  const double scale = max(impulse_scale(problem), 1.0e-300);
  int idle = 0;
  while (result.residual > tolerance && result.steps < most_steps && idle < kPatience) {
    const double near = clamp(residual / scale, kLeastNear, kMostNear);
    const Equations equations{problem, now, w, matrix, right, n, near};
    equations.write();
    if (!equations.solve()) break;
    ++result.steps;
    // The whole step if no share of it is better: now and then the way leads over a hill.
    for (int k = 0;; ++k) {
      const bool is_last = k == int(std::size(kShares));
      const double share = is_last ? 1.0 : kShares[k];
      for (std::size_t i = 0; i < n; ++i) next[i] = now[i] + share * right[i];
      find_speeds(problem, next, w);
      const double now_squares = sum_of_squares(problem, next, w);
      if (!is_last && !(now_squares < (1.0 - 1.0e-3 * share) * squares)) continue;
      squares = now_squares;
      break;
    }
    for (std::size_t i = 0; i < n; ++i) now[i] = next[i];
    residual = find_residual(problem, now, w);
    if (!(residual < 1.0e300)) break;
    if (residual < result.residual) {
      result.residual = residual;
      for (std::size_t i = 0; i < n; ++i) x[i] = now[i];
      idle = 0;
    } else {
      ++idle;
    }
  }
  return result;
}

}  // namespace gyre
