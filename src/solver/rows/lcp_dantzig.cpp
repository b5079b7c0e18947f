#include "solver/rows/lcp_dantzig.h"

namespace gyre {

namespace {
constexpr double kNever = 1.0e301;  // a step length that no row reaches; above kNoLimit
}

// The tableau is y = T u + qt: in the basis u is w and y is x, outside it u is x and y is w.
Dantzig::Dantzig(std::span<const double> a, std::span<const double> q, double compliance, NumberRoom& room)
    : n_(int(q.size())),
      t_(room.take(a.size())),
      qt_(room.take(q.size())),
      x_(room.take(q.size())),
      w_(room.take(q.size())),
      low_(room.take(q.size())),
      high_(room.take(q.size())),
      basic_(room.take(q.size())),
      satisfied_(room.take(q.size())),
      diagonal_(room.take(q.size())) {
  for (std::size_t i = 0; i < a.size(); ++i) t_[i] = a[i];
  for (int i = 0; i < n_; ++i) {
    at(i, i) *= 1.0 + compliance;
    diagonal_[std::size_t(i)] = at(i, i);
    qt_[std::size_t(i)] = q[std::size_t(i)];
    x_[std::size_t(i)] = basic_[std::size_t(i)] = 0.0;
    low_[std::size_t(i)] = -kNoLimit, high_[std::size_t(i)] = kNoLimit;
  }
}

void Dantzig::set_limits(int i, double low, double high) {
  low_[std::size_t(i)] = low, high_[std::size_t(i)] = high;
  if (!is_basic(i)) x_[std::size_t(i)] = clamp(x_[std::size_t(i)], low, high);
}

void Dantzig::pivot(int k) {
  ++pivots_;
  const std::size_t n = std::size_t(n_);
  double* const own = &t_[std::size_t(k) * n];
  const double inverse = 1.0 / own[k];
  for (std::size_t j = 0; j < n; ++j) own[j] *= -inverse;
  own[k] = inverse;
  qt_[std::size_t(k)] *= -inverse;
  for (std::size_t i = 0; i < n; ++i) {
    if (i == std::size_t(k)) continue;
    double* const row = &t_[i * n];
    const double by = row[k];
    if (by == 0.0) continue;
    for (std::size_t j = 0; j < n; ++j) row[j] += by * own[j];
    row[k] = by * inverse;
    qt_[i] += by * qt_[std::size_t(k)];
  }
  basic_[std::size_t(k)] = is_basic(k) ? 0.0 : 1.0;
}

// Recomputes the impulses in the basis and the speeds outside it from the impulses at their limits.
void Dantzig::refresh() {
  for (int i = 0; i < n_; ++i) {
    double sum = qt_[std::size_t(i)];
    for (int j = 0; j < n_; ++j) {
      if (!is_basic(j)) sum += at(i, j) * x_[std::size_t(j)];
    }
    (is_basic(i) ? x_ : w_)[std::size_t(i)] = sum;
    if (is_basic(i)) w_[std::size_t(i)] = 0.0;
  }
}

bool Dantzig::is_satisfied(int i) const {
  const std::size_t n = std::size_t(i);
  if (is_basic(i)) return x_[n] >= low_[n] - tolerance_ && x_[n] <= high_[n] + tolerance_;
  if (low_[n] == high_[n]) return true;
  const double slack = tolerance_ * diagonal_[n];  // tolerance of the impulse, as a speed
  if (x_[n] <= low_[n]) return w_[n] >= -slack;
  if (x_[n] >= high_[n]) return w_[n] <= slack;
  return false;
}

// Drives row i, outside the basis, until its speed is zero or its impulse is at a limit.
bool Dantzig::drive(int i, int max_pivots) {
  const std::size_t own = std::size_t(i);
  const double sign = w_[own] > 0.0 ? -1.0 : 1.0;
  for (;;) {
    if (pivots_ > max_pivots) return false;
    const double limit = sign > 0.0 ? high_[own] : low_[own];
    const double gain = at(i, i);
    double distance = limit <= -kNoLimit || limit >= kNoLimit ? kNever : max(sign * (limit - x_[own]), 0.0);
    int first = -1;  // -1: the limit of the row itself
    if (gain > 0.0) {
      const double until = max(-sign * w_[own] / gain, 0.0);
      if (until <= distance) distance = until, first = i;
    }
    for (int j = 0; j < n_; ++j) {
      const std::size_t other = std::size_t(j);
      if (j == i || satisfied_[other] == 0.0 || low_[other] == high_[other]) continue;
      const double change = sign * at(j, i);
      double until = kNever;
      if (is_basic(j)) {
        if (change > 0.0 && high_[other] < kNoLimit) until = (high_[other] - x_[other]) / change;
        if (change < 0.0 && low_[other] > -kNoLimit) until = (low_[other] - x_[other]) / change;
      } else if (x_[other] <= low_[other] ? change < 0.0 : change > 0.0) {
        until = -w_[other] / change;
      }
      if (until < distance) distance = max(until, 0.0), first = j;
    }
    if (distance >= kNever) return false;
    for (int j = 0; j < n_; ++j) {
      if (j != i) (is_basic(j) ? x_ : w_)[std::size_t(j)] += sign * distance * at(j, i);
    }
    x_[own] += sign * distance;
    w_[own] += sign * distance * gain;
    if (first < 0) {
      x_[own] = limit;
      return true;
    }
    if (first != i && is_basic(first)) {
      const std::size_t other = std::size_t(first);
      x_[other] = sign * at(first, i) > 0.0 ? high_[other] : low_[other];
    }
    w_[std::size_t(first)] = 0.0;
    if (!(at(first, first) > 0.0)) return false;
    pivot(first);
    if (first == i) return true;
  }
}

bool Dantzig::solve(double tolerance, int max_pivots) {
  tolerance_ = tolerance;
  const int last_pivot = pivots_ + max_pivots;
  refresh();
  for (int pass = 0; pass < 4; ++pass) {
    bool any = false;
    for (int i = 0; i < n_; ++i) {
      if (is_satisfied(i)) continue;
      any = true;
      for (int j = 0; j < n_; ++j) satisfied_[std::size_t(j)] = is_satisfied(j) ? 1.0 : 0.0;
      if (is_basic(i)) {
        // Beyond a limit: the row leaves the basis and is driven back to the limit.
        const double limit =
            x_[std::size_t(i)] > high_[std::size_t(i)] ? high_[std::size_t(i)] : low_[std::size_t(i)];
        const double back = limit - x_[std::size_t(i)];
        pivot(i);
        const double saved_low = low_[std::size_t(i)], saved_high = high_[std::size_t(i)];
        (back > 0.0 ? high_ : low_)[std::size_t(i)] = limit;
        w_[std::size_t(i)] = back > 0.0 ? -1.0e30 * at(i, i) : 1.0e30 * at(i, i);
        const bool driven = drive(i, last_pivot);
        low_[std::size_t(i)] = saved_low, high_[std::size_t(i)] = saved_high;
        refresh();
        if (!driven) return false;
        continue;
      }
      if (!drive(i, last_pivot)) return false;
    }
    if (!any) return true;
    refresh();
  }
  return true;
}

}  // namespace gyre
