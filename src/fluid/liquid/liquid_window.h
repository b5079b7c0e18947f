// LiquidWindow: the cells that a step of a liquid works on: a box of tiles around all particles. Outside it there is only air, so its arrays and its
// loops follow the liquid, however large the box of the liquid is. A window depends on the state alone, and a step begins with a new one.
#pragma once

#include "fluid/liquid/liquid_grid.h"

#include <span>

namespace gyre {

// Cells from `low` to `high` along each axis, the latter not among them.
struct CellBox {
  int low[3] = {0, 0, 0}, high[3] = {0, 0, 0};

  bool contains(const CellBox& other) const;
  bool overlaps(const CellBox& other) const;
  void include(const CellBox& other);
};

struct LiquidWindow {
  int first[3] = {0, 0, 0};  // the cell of the liquid's box that is the first one of the window
  GasBox box;                // of these cells; a side within the liquid's box is open: beyond it there is air
  GridShape shape;

  CellBox cells() const;
  // m: of its lower corner from that of the liquid's box.
  Vec3 origin() const {
    return {float(first[0]) * box.cell.x, float(first[1]) * box.cell.y, float(first[2]) * box.cell.z};
  }
};

// Particles lie at least so many cells from the sides of the window at the beginning of a sub-step, but for sides of the liquid's box: they
// move by two, make liquid of the cells beside them, and give four layers of faces beyond these their velocity.
inline constexpr int kWindowMargin = 7;
// Windows begin and end at multiples of this many cells, so that they seldom change.
inline constexpr int kWindowTile = 8;

LiquidWindow whole_window(const GasBox& box);
// The tiles around a range of cells. All of an axis that is flat or periodic.
LiquidWindow window_around(const GasBox& box, const CellBox& range);
// The cells of a region given from the lower corner of the box, as far as they lie in it.
CellBox cells_of(const GasBox& box, Vec3 lower, Vec3 upper);
// Grown by the margin, within the box.
CellBox with_margin(const GasBox& box, CellBox range);

}  // namespace gyre
