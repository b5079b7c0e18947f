// Lemke's complementary pivoting for the linear complementarity problem: find z >= 0 with w = M z + q >= 0 and z w = 0. M need
// not be symmetric; the method ends with a solution if M is copositive plus, which the matrices of contacts with friction
// pyramids are, unless the path leads along a ray, which it tells.
//
// An artificial variable z0 is added to all rows until w >= 0; then one variable after the other enters the basis, always the
// complement of the one that left, until z0 leaves. Ties of the ratio test, which redundant contacts are full of, are parted by
// moving each q up by its own tiny amount (an explicit form of the lexicographic rule).
//
// Sources: C. E. Lemke, "Bimatrix equilibrium points and mathematical programming", 1965; R. W. Cottle, J.-S. Pang, R. E. Stone,
// "The Linear Complementarity Problem", 1992, section 4.4.
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

enum class LemkeEnd : unsigned char { solved, ray, gave_up };

struct LemkeResult {
  LemkeEnd end = LemkeEnd::gave_up;
  int pivots = 0;
};

constexpr std::size_t lemke_room(std::size_t size) { return size * (size + 1) + 4 * size + 1; }

// `m`: q.size() squared numbers, row after row. `parting`: of ties, as a share of the largest q.
LemkeResult solve_lemke(std::span<const double> m, std::span<const double> q, double tie_break, int max_pivots,
                        std::span<double> z, NumberRoom& room);

}  // namespace gyre
