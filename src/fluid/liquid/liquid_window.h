// The window of a liquid (fluid/grid/fluid_window.h): a box of tiles around all particles. Outside it there is only air. A window depends on
// the state alone, and a step begins with a new one.
#pragma once

#include "fluid/grid/fluid_window.h"
#include "fluid/liquid/liquid_grid.h"

#include <span>

namespace gyre {

// Particles lie at least so many cells from the sides of the window at the beginning of a sub-step, but for sides of the liquid's box: they
// move by two, make liquid of the cells beside them, and give four layers of faces beyond these their velocity.
inline constexpr int kWindowMargin = 7;

inline CellBox with_margin(const GasBox& box, const CellBox& range) {
  return grow(box, range, kWindowMargin);
}

}  // namespace gyre
