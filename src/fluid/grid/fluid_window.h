// FluidWindow: the cells that a step of a fluid works on: a box of tiles within the box of the fluid. Arrays and loops follow the window, however
// large the box is. A side of a window within the box of the fluid is open.
#pragma once

#include "fluid/grid/cell_box.h"
#include "fluid/grid/gas_grid.h"

namespace gyre {

struct FluidWindow {
  int first[3] = {0, 0, 0};  // the cell of the fluid's box that is the first one of the window
  GasBox box;                // of these cells; a side within the fluid's box is open
  GridShape shape;

  CellBox cells() const;
  // m: of its lower corner from that of the fluid's box.
  Vec3 origin() const {
    return {float(first[0]) * box.cell.x, float(first[1]) * box.cell.y, float(first[2]) * box.cell.z};
  }
};

// Windows begin and end at multiples of this many cells, so that they seldom change.
inline constexpr int kWindowTile = 8;

FluidWindow whole_window(const GasBox& box);
// The tiles around a range of cells. All of an axis that is flat or periodic.
FluidWindow window_around(const GasBox& box, const CellBox& range);
// The cells of a region given from the lower corner of the box, as far as they lie in it.
CellBox cells_of(const GasBox& box, Vec3 lower, Vec3 upper);
// Grown by so many cells on each side, within the box.
CellBox grow(const GasBox& box, CellBox range, int cells);

}  // namespace gyre
