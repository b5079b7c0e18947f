// Dantzig's principal pivoting for complementarity problems with limits on both sides: find x within [low, high] with
// w = A x + q >= 0 where x is at its low limit, <= 0 where it is at its high one, and 0 between; A symmetric, positive definite.
//
// One violated row after the other is driven to where it should be, while all that are right already stay right: a row's
// impulse that reaches a limit stays there and its speed is let go (it leaves the basis), a speed that reaches zero is held there
// (it enters). Each change is one principal pivot of the tableau, n^2 operations. What is right never gets wrong again, so the
// method ends after finitely many pivots. It may go on from where it stood after limits have changed.
//
// Sources: R. W. Cottle, G. B. Dantzig, "Complementary pivot theory of mathematical programming", 1968; D. Baraff, "Fast contact
// force computation for nonpenetrating rigid bodies", SIGGRAPH 1994 (contacts, one row after the other).
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

class Dantzig {
 public:
  static std::size_t room_for(std::size_t size) { return size * size + 8 * size; }

  // Of a matrix of `size`, whose diagonal is raised by the share `give` of itself.
  Dantzig(std::span<const double> a, std::span<const double> q, double compliance, NumberRoom& room);

  // Beyond all bounds: 1e300. All x start at 0, or at the limit that is nearest to it.
  void set_limits(int i, double low, double high);
  // Solves within the limits that are set now. False if it gave up: more than `max_pivots`, or no finite solution.
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
