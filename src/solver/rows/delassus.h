// The Delassus matrix of the rows of an island, A = J M^-1 J^T + compliance: the change of speed along one
// row for an impulse of one along another. It is dense, for the direct solvers; iterative solvers go from row
// to row through the bodies.
//
// In: rows with their gains (finish_row). Out: A, row after row.
#pragma once

#include "solver/rows/row.h"

#include <span>

namespace gyre {

// `matrix` has rows.size() squared elements; `first` and `next` have room for bodies.size() and 2 rows.size()
// numbers.
void fill_delassus(std::span<const Row> rows, std::size_t bodies, std::span<double> matrix,
                   std::span<std::int32_t> first, std::span<std::int32_t> next);

}  // namespace gyre
