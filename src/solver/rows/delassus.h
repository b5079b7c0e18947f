// The Delassus matrix of an island's rows: A = J M^-1 J^T + give, how the impulse of one row changes the speed that another
// sees. Dense: it is for the direct solvers, which need all of it; the others go from row to row through the bodies.
//
// In: rows with their gains (finish_row). Out: A, row after row.
#pragma once

#include "solver/rows/row.h"

#include <span>

namespace gyre {

// `matrix` has rows.size() squared elements; `first` and `next` are room for bodies.size() and 2 rows.size() numbers.
void fill_delassus(std::span<const Row> rows, std::size_t bodies, std::span<double> matrix,
                   std::span<std::int32_t> first, std::span<std::int32_t> next);

}  // namespace gyre
