// Lemke's complementary pivoting for the linear complementarity problem: find z >= 0 with w = M z + q >= 0
// and z w = 0. M need not be symmetric. If M is copositive plus, as matrices of contacts with friction
// pyramids are, the method ends with a solution or reports a ray.
//
// An artificial variable z0 is added to all rows until w >= 0. Then the complement of the variable that left
// the basis enters it, until z0 leaves. Redundant contacts cause many ties in the ratio test; raising each q
// by its own tiny amount breaks them (an explicit form of the lexicographic rule).
//
// Sources: C. E. Lemke, "Bimatrix equilibrium points and mathematical programming", 1965; R. W. Cottle, J.-S.
// Pang, R. E. Stone, "The Linear Complementarity Problem", 1992, section 4.4.
#pragma once

#include "solver/rows/complementarity.h"

namespace gyre {

enum class LemkeEnd : unsigned char { solved, ray, gave_up };

struct LemkeResult {
  LemkeEnd end = LemkeEnd::gave_up;
  int pivots = 0;
};

constexpr std::size_t lemke_room(std::size_t size) { return size * (size + 1) + 4 * size + 1; }

// `m`: q.size() squared numbers, row after row. `tie_break`: largest change of q, as a share of the largest
// q.
LemkeResult solve_lemke(std::span<const double> m, std::span<const double> q, double tie_break,
                        int max_pivots, std::span<double> z, NumberRoom& room);

}  // namespace gyre
