// PressureMatrix: the pressure equation of a gas on a hierarchy of grids. Nothing is stored for a pair of cells but the coefficient of their
// face; coarser levels have half the cells along each axis, and the sums of the faces that they cover.
//
// In: the box and what solids leave open of its faces. Out: levels for the kernels.
// Source: the operator is that of C. Batty, F. Bertails, R. Bridson, 2007; the hierarchy follows A. McAdams, E. Sifakis, J. Teran, "A Parallel
// Multigrid Poisson Solver for Fluids Simulation on Large Grids", 2010.
#pragma once

#include "fluid/grid/gas_grid.h"
#include "fluid/grid/gas_solids.h"
#include "fluid/kernels/gas_kernels.h"
#include "task/task_system.h"

namespace gyre {

struct PressureGrid {
  GridShape shape;
  Array<float> face[3], inverse_diagonal, transfer;
  Array<float> ground;         // of liquids; empty: 0
  Array<std::uint8_t> is_air;  // of liquids: cells in which the pressure is zero
  float full_face = 0.0f;      // of liquids, 1/m^2: the coefficient of a face that is open
  Array<PressureRow> rows;
  Array<float> b, x, other;  // of a cycle over the levels; those of the finest belong to the caller
  bool halved[3] = {};
  bool periodic[3] = {};
  Array<std::uint8_t> stale;   // rows of cells, with those of the last faces, that are to be built
  Array<std::int32_t> active;  // cells of each row that have an equation
};

struct PressureMatrix {
  static constexpr int kMaxLevels = 16;
  PressureGrid levels[kMaxLevels];
  int count = 0;
  bool singular = false;              // no side is open: the pressure is known but for a constant
  int active_cells = 0;               // that have an equation
  std::uint64_t solids_revision = 0;  // from which it was made; 0: from none
  Array<std::uint8_t> cut_row;        // rows of cells: 1 where a solid cuts a face; empty without solids
  Array<std::uint8_t> near;           // those of the solids from which it was made; empty: not known
  // Pockets (fluid/solver/pressure_pockets.h), if solids may divide the cells.
  bool has_pockets = false;
  Array<std::int32_t> pocket;            // of each cell, -1: none
  Array<std::uint8_t> pocket_is_closed;  // of each pocket: 0: an open side can be reached

  PressureLevel level(int index) const;
};

// Faces whose open fraction is below this count as closed: their cells would otherwise get coefficients too far apart.
inline constexpr float kMinOpen = 0.01f;

// Builds the rows that solids cut or did when `matrix` was built last, and all rows if that is not known.
void build_pressure_matrix(const GasBox& box, const GridShape& shape, const GasSolids& solids,
                           const GasKernels& kernels, TaskSystem& tasks, PressureMatrix& matrix);

// All but the faces, the ground and the air of the finest level, whose shape, periodic axes and stale rows are set.
void build_pressure_levels(const GasKernels& kernels, TaskSystem& tasks, PressureMatrix& matrix);
void mark_all_stale(PressureGrid& grid);
// Returns true if the level was made anew.
bool resize_pressure_level(PressureGrid& grid, const GridShape& shape, bool finest, bool has_ground);

// Rows of a grid that a worker takes at a time.
inline constexpr int kGridRows = 32;

}  // namespace gyre
