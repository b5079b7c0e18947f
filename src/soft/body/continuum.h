// Continuum: the tetrahedra of a solid or the triangles of a membrane, in blocks of 16 that are worked on side by side, and the pattern of
// the matrix they make.
//
// An element adds its stiffness to the blocks of its edges, one for each pair of particles; rows are then filled from these. What elements
// add up they add in a fixed order: chunks of blocks that share no particle have one colour and may be worked on at once, colour
// after colour.
//
// Deformation gradient F = (x1 - x0, x2 - x0, x3 - x0) Dm^-1, energy V W(F), forces -V P grad N with P = dW/dF. With the moduli of Lame
// (mu, lambda):
//
//   linear       W = mu |e|^2 + lambda / 2 tr(e)^2, e = sym(F) - 1: for small displacements, does not know rotations
//   corotated    the same of e = S - 1, F = R S (M. Mueller, M. Gross, 2004)
//   neo_hookean  W = mu / 2 (|F|^2 - 3) + (lambda + mu) / 2 (det F - a)^2, a = 1 + mu / (lambda + mu): at rest when F = 1, and for small
//                strains the linear law of mu and lambda (B. Smith, F. de Goes, T. Kim, "Stable Neo-Hookean Flesh Simulation", 2018, who
//                write lambda for what is lambda + mu here). Below |F|^2 = 1/2 the first term falls off faster, so that an
//                element that was pressed to a point grows again.
//
// Tetrahedra alone are too stiff in bending and torsion, and lock near a Poisson's ratio of 1/2, since each keeps its volume. Where they come in cells,
// such as cubes of five, the cell is the element, of up to eight corners: V W(mean F) + s mu sum V_t |F_t - mean F|^2, with the mean over its tetrahedra.
// The second term is quadratic and does not change in a rotation: springs without length between the corners. Without it a cell would bend for
// nothing (T. Belytschko, J. S.-J. Ong, W. K. Liu, J. M. Kennedy, "Hourglass Control in Linear and Nonlinear Problems", 1984). A tetrahedron that is pressed
// below half of its volume pushes back by itself. Tetrahedra of a cell hang together by whole faces: where a crack divides a cell, each part is a
// cell or a tetrahedron.
//
// Membrane triangles have F of two columns, (x1 - x0, x2 - x0) Dm^-1 in the two directions of the sheet, and the energy per area of St Venant
// and Kirchhoff, 1/2 c (E11^2 + E22^2) + c' E11 E22 + 2 g E12^2 with E = (F^T F - 1) / 2.
//
// Sources: E. Sifakis, J. Barbic, "FEM Simulation of 3D Deformable Solids", 2012; A. McAdams et al., "Efficient Elasticity for Character
// Skinning with Contact and Collisions", 2011.
#pragma once

#include "base/container/array.h"
#include "soft/body/element_blocks.h"
#include "soft/body/sliced_rows.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

constexpr int kLastChunkColor = 63;  // what does not find a free colour below has this one
constexpr int kChunkBlocks = 4;      // blocks of elements that one worker takes at a time

// Chunks of blocks by colour: those of colour c are chunks[begin[c]] to chunks[begin[c + 1] - 1].
struct ColoredChunks {
  Array<std::int32_t> chunks;
  Array<std::int32_t> begin;
};

// s: the share of the shear modulus with which tetrahedra of a cell resist to differ from their mean. Beams of cubic cells bend right within 8 %
// from two cells through the depth on. With half of it one of one cell hangs three times too far, and with twice as much it twists by a fifth too little
// with four (docs/decisions/soft-solver.md).
constexpr double kSpreadShare = 0.15;

struct Continuum {
  ElementMaterial material;
  int edges = 0;
  Array<TetBlock> tetrahedra;
  Array<TriangleBlock> triangles;
  ColoredChunks tetrahedron_chunks, triangle_chunks;
  Array<CellBlock> cells;
  ColoredChunks cell_chunks;
  Array<std::int32_t> cell_of;     // by tetrahedron: its cell, -1 if it is in none; empty: there are none
  Array<std::int32_t> cell_begin;  // by cell, and the end: its tetrahedra in cell_parts
  Array<std::int32_t> cell_parts;
  // By particle: the number of the piece that tetrahedra hold together, ascending by the lowest particle. None: all are one piece.
  Array<std::uint32_t> piece;
  int pieces = 1;
  SlicedRows rows;
  Array<std::int32_t>
      edge_of_place;  // 2 edge, + 1 where the row is the higher particle; -1 where there is no neighbour

  int cell_count() const { return cell_begin.empty() ? 0 : int(cell_begin.size()) - 1; }
  bool is_in_cell(std::size_t tetrahedron) const { return !cell_of.empty() && cell_of[tetrahedron] >= 0; }
  bool empty() const { return tetrahedra.empty() && triangles.empty(); }
};

// A triangle of a membrane: its corners, and where they lie in the two directions of the sheet, m.
struct SheetTriangle {
  std::uint32_t corner[3];
  double place[3][2];
};

// `corners`: four particles a tetrahedron, in any order; `places`: of the particles at rest. Every tetrahedron must have a volume. `group`: by tetrahedron,
// ascending: those of one group make a cell, or several where they do not hang together; none: there are no cells.
Continuum make_continuum(std::span<const std::uint32_t> corners, std::span<const DVec3> places,
                         std::span<const std::uint32_t> group = {});
// Finds the mean of a cell anew, after the rest shapes of its tetrahedra changed.
void renew_cell(Continuum& continuum, int cell);
Continuum make_membrane(std::span<const SheetTriangle> triangles, int particles);

}  // namespace gyre
