// The window of a gas with an adaptive domain: the cells that a step works on and that the state holds. Beyond a side of the window that lies within
// the box, the air is at rest at the ambient pressure. So the window cuts off the far field of the flow, and the margin decides the error
// (docs/decisions/gas-solver.md).
//
// In: the fields of a gas. Out: the cells that hold something that moves; a gas whose arrays hold other cells.
#pragma once

#include "fluid/gas/gas_reading.h"
#include "fluid/grid/fluid_window.h"

namespace gyre {

// The cells with smoke, heat or fuel, or with a speed above `threshold` times the fastest, grown by how far gas moves in `seconds`, in the cells of
// the whole box. Empty, with `low` above `high`, if there are none.
CellBox find_active_cells(const GasGrid& grid, float threshold, float seconds, TaskSystem& tasks);
// True if a range that was found holds no cell.
bool is_empty(const CellBox& range);

// The tiles of the whole box around a range, or one tile if it is empty.
FluidWindow gas_window(const GasBox& whole, const CellBox& range);
// The cells that the arrays hold now.
FluidWindow gas_window(const GasGrid& grid);
// A gas at rest whose arrays hold a window around a range of cells of its box.
GasGrid make_gas_grid(const GasBox& whole, const CellBox& range, float ambient_temperature);
// Makes the arrays those of a window. Cells that were in none before are at rest.
void set_gas_window(GasGrid& grid, const FluidWindow& window);

}  // namespace gyre
