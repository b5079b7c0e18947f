// The dense complementarity problem of an island, and the residual of a list of impulses.
//
// Find x with w = A x + q complementary to x within the limits of the rows (solver/rows/row.h). A = J M^-1
// J^T + compliance is symmetric and positive semi-definite; q is the speed along the rows without impulses,
// minus the target speed.
//
// The residual is that of the natural map: step an impulse against its w by w / A_ii, clamp it to its limits,
// and take the distance from the impulse. It is an impulse (N s, or N m s), it is zero only at solutions, and
// it is defined for every method and every friction set.
//
// Source: F. Facchinei, J.-S. Pang, "Finite-Dimensional Variational Inequalities and Complementarity
// Problems", 2003, ch. 1.5.
#pragma once

#include "solver/rows/row.h"

#include <span>

namespace gyre {

struct DenseProblem {
  int size = 0;
  std::span<const double> a;  // row after row
  std::span<const double> q;
  std::span<const RowLimits> limits;
  const FrictionSet* friction = nullptr;

  double at(int i, int j) const { return a[std::size_t(i) * std::size_t(size) + std::size_t(j)]; }
};

// Hands out memory for numbers from one piece.
class NumberRoom {
 public:
  explicit NumberRoom(std::span<double> room) : room_(room) {}
  std::span<double> take(std::size_t count);

 private:
  std::span<double> room_;
};

// The load of a row: never negative.
template <class ImpulseOf>
double load_of(const RowLimits& limits, ImpulseOf&& impulse_of) {
  double load = 0.0;
  for (std::int32_t i = 0; i < limits.load_count; ++i) load += impulse_of(limits.load_first + i);
  return load > 0.0 ? load : 0.0;
}

// The natural residual of row i, from `impulse_of(j)`, `speed_of(j)` = w_j and `diagonal_of(j)`. The second
// row of a cone is covered by the first.
template <class ImpulseOf, class SpeedOf, class DiagonalOf>
double row_residual(int i, const RowLimits& limits, const FrictionSet& friction, ImpulseOf&& impulse_of,
                    SpeedOf&& speed_of, DiagonalOf&& diagonal_of) {
  const auto size = [](double v) { return v < 0.0 ? -v : v; };
  const double d = diagonal_of(i);
  if (limits.kind == RowKind::cone_second || !(d > 0.0)) return 0.0;
  const double x = impulse_of(i);
  if (limits.kind == RowKind::cone) {
    const double rate = max(d, diagonal_of(i + 1));
    const double y = impulse_of(i + 1), radius = limits.friction * load_of(limits, impulse_of);
    const FrictionPoint p =
        nearest_friction(friction, radius, x - speed_of(i) / rate, y - speed_of(i + 1) / rate);
    return max(size(x - p.x), size(y - p.y));
  }
  double low = limits.low, high = limits.high;
  if (limits.kind == RowKind::load) {
    high = limits.friction * load_of(limits, impulse_of);
    low = -high;
  }
  return size(x - clamp(x - speed_of(i) / d, low, high));
}

// w = A x + q.
void find_speeds(const DenseProblem& problem, std::span<const double> x, std::span<double> w);
double dense_residual(const DenseProblem& problem, int i, std::span<const double> x,
                      std::span<const double> w);
// The largest residual of all rows; `w` belongs to `x`.
double find_residual(const DenseProblem& problem, std::span<const double> x, std::span<const double> w);
// The scale of the impulses: the largest that stops a row alone.
double impulse_scale(const DenseProblem& problem);

}  // namespace gyre
