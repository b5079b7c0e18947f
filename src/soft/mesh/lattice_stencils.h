// Stencils of isosurface stuffing: cuts the part inside the surface out of one tetrahedron of a body-centred cubic lattice.
//
// In: for each corner its side of the surface, and its parity. Corners 0 and 1 are neighbours in one cubic lattice, corners 2 and 3 in the
// other, so edges 01 and 23 are long (the lattice's cell size), the other four short (sqrt(3)/2 of it). Out: at most three tetrahedra between
// corners and cut points, wound like corners 0, 1, 2, 3. Two tetrahedra of the lattice that share a face divide it alike.
// Source: F. Labelle, J. R. Shewchuk, "Isosurface Stuffing: Fast Tetrahedral Meshes with Good Dihedral Angles", 2007.
#pragma once

#include <cstdint>

namespace gyre {

constexpr bool is_long_edge(int a, int b) { return (a < 2) == (b < 2); }

// A corner a is 5 a; the cut point of the edge from corner a inside to corner b outside is 4 a + b.
struct StencilTetrahedra {
  int count = 0;
  std::uint8_t node[3][4] = {};
};

// side: 1 inside, 0 on the surface, -1 outside. even: of corners 0 and 1 one is even, of 2 and 3 too.
StencilTetrahedra cut_lattice_tetrahedron(const std::int8_t (&side)[4], const bool (&even)[4]);

}  // namespace gyre
