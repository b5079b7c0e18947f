// Sparse matrices of 6 x 6 blocks with a symmetric pattern and unsymmetric values, factored as L U in the order of a
// plan (math/block_ldlt.h). Rows are exchanged within a block only, which is enough for matrices near a positive
// definite one, such as those of Newton's method on the bodies of an island.
//
// Values: two arrays of plan.values doubles. `lower` has the diagonal blocks, and below them the block of entry i of a
// column at its offset, rows of i; `upper` has at the same offset the block across the diagonal, rows of the column.
//
// Source: G. Golub, C. Van Loan, "Matrix Computations", 4th ed., 2013, ch. 3.2 (block LU) and 3.4 (partial pivoting).
#pragma once

#include "math/block_ldlt.h"

namespace gyre {

constexpr int kLuBlock = 6;

// A matrix and the factors that replace it. All nodes of the plan have kLuBlock rows.
struct BlockLu {
  const BlockPlan* plan = nullptr;
  std::span<double> lower, upper;
  std::span<double> pivots;  // plan->rows of them: the row of the block with which each row was exchanged
};

// False if a pivot is zero or not a number: the matrix is singular.
bool factor_lu(const BlockLu& lu);
// Solves in place, with rows in the order of the plan.
void solve_lu(const BlockLu& lu, std::span<double> x);

}  // namespace gyre
