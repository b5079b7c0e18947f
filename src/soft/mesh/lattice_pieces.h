// The pieces into which the inner points of a cut lattice fall: points whose tetrahedra share a face are in one piece.
//
// In: a cut lattice. Out: the number of pieces; small ones, such as the tip of a spike that is thinner than a cell further down, are taken
// out of the lattice, so that nothing lies loose.
#pragma once

#include "soft/mesh/cut_lattice.h"

namespace gyre {

// Pieces of `max_points` points or less become outside, except the largest. Returns how many pieces are left.
int drop_small_pieces(CutLattice& lattice, double max_points);

}  // namespace gyre
