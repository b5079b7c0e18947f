// Dantzig's principal pivoting for complementarity problems with bounds on both sides: find x within [low,
// high] with w = A x + q >= 0 where x is at its low bound, <= 0 where it is at its high one, and 0 between; A
// symmetric, positive definite.
//
// The method drives one violated row after the other to a solution and keeps all satisfied rows satisfied. A
// row whose impulse reaches a bound leaves the basis; a row whose speed reaches zero enters it. Each change
// is one principal pivot of the tableau, n^2 operations. Satisfied rows stay so, so the number of pivots is
// finite. A solve may continue from the last solution after bounds have changed.
//
// Sources: R. W. Cottle, G. B. Dantzig, "Complementary pivot theory of mathematical programming", 1968; D.
// Baraff, "Fast contact force computation for nonpenetrating rigid bodies", SIGGRAPH 1994 (contacts, one row
// after the other).
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

class Dantzig {
 public:
  static std::size_t room_for(std::size_t size) { return size * size + 8 * size; }

  // `compliance`: share by which the diagonal is raised.
  Dantzig(std::span<const double> a, std::span<const double> q, double compliance, NumberRoom& room);

  // No bound is 1e300. Every x starts at 0, or at the bound nearest to it.
  void set_limits(int i, double low, double high);
  // Solves within the present bounds. False after more than `max_pivots`, or if no finite solution exists.
  bool solve(double tolerance, int max_pivots);

  double x(int i) const { return x_[std::size_t(i)]; }
  double w(int i) const { return w_[std::size_t(i)]; }
  int pivots() const { return pivots_; }

 private:
  double& at(int i, int j) { return t_[std::size_t(i) * std::size_t(n_) + std::size_t(j)]; }
  double at(int i, int j) const { return t_[std::size_t(i) * std::size_t(n_) + std::size_t(j)]; }
  bool is_basic(int i) const { return basic_[std::size_t(i)] != 0.0; }
  void pivot(int k);
  void refresh();
  bool is_satisfied(int i) const;
  bool drive(int i, int max_pivots);

  int n_ = 0;
  std::span<double> t_, qt_, x_, w_, low_, high_, basic_, satisfied_, diagonal_;
  double tolerance_ = 0.0;
  int pivots_ = 0;
};

}  // namespace gyre
