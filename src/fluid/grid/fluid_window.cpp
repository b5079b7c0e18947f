#include "fluid/grid/fluid_window.h"

namespace gyre {

bool CellBox::contains(const CellBox& other) const {
  bool within = true;
  for (int axis = 0; axis < 3; ++axis)
    within = within && low[axis] <= other.low[axis] && other.high[axis] <= high[axis];
  return within;
}

bool CellBox::overlaps(const CellBox& other) const {
  bool meet = true;
  for (int axis = 0; axis < 3; ++axis)
    meet = meet && low[axis] < other.high[axis] && other.low[axis] < high[axis];
  return meet;
}

void CellBox::include(const CellBox& other) {
  for (int axis = 0; axis < 3; ++axis) {
    low[axis] = other.low[axis] < low[axis] ? other.low[axis] : low[axis];
    high[axis] = other.high[axis] > high[axis] ? other.high[axis] : high[axis];
  }
}

CellBox FluidWindow::cells() const {
  CellBox range;
  for (int axis = 0; axis < 3; ++axis)
    range.low[axis] = first[axis], range.high[axis] = first[axis] + box.cells[axis];
  return range;
}

FluidWindow whole_window(const GasBox& box) {
  FluidWindow window;
  window.box = box;
  window.shape = make_grid_shape(box.cells[0], box.cells[1], box.cells[2]);
  return window;
}

FluidWindow window_around(const GasBox& box, const CellBox& range) {
  FluidWindow window;
  window.box = box;
  const float edges[3] = {box.cell.x, box.cell.y, box.cell.z};
  double shift[3] = {};
  for (int axis = 0; axis < 3; ++axis) {
    const int cells = box.cells[axis];
    int low = range.low[axis] / kWindowTile * kWindowTile;
    int high = (range.high[axis] + kWindowTile - 1) / kWindowTile * kWindowTile;
    if (high <= low) high = low + kWindowTile;
    if (high > cells) high = cells;
    if (box.flat(axis) || box.periodic(axis) || low >= high) low = 0, high = cells;
    window.first[axis] = low;
    window.box.cells[axis] = high - low;
    shift[axis] = double(low) * double(edges[axis]);
    for (int side = 0; side < 2; ++side) {
      if (side == 0 ? low == 0 : high == cells) continue;
      window.box.side[2 * axis + side] = GasBoundary::open;
      window.box.wall_velocity[2 * axis + side] = {};
    }
  }
  window.box.corner += DVec3{shift[0], shift[1], shift[2]};
  const int* const n = window.box.cells;
  window.shape = make_grid_shape(n[0], n[1], n[2]);
  return window;
}

CellBox cells_of(const GasBox& box, Vec3 lower, Vec3 upper) {
  CellBox range;
  const float low[3] = {lower.x / box.cell.x, lower.y / box.cell.y, lower.z / box.cell.z};
  const float high[3] = {upper.x / box.cell.x, upper.y / box.cell.y, upper.z / box.cell.z};
  for (int axis = 0; axis < 3; ++axis) {
    // A place that is no number counts as the lower corner.
    const int last = box.cells[axis] - 1;
    const auto cell = [last](float at) { return at >= float(last) ? last : at > 0.0f ? int(at) : 0; };
    range.low[axis] = cell(low[axis]), range.high[axis] = cell(high[axis]) + 1;
  }
  return range;
}

CellBox grow(const GasBox& box, CellBox range, int cells) {
  for (int axis = 0; axis < 3; ++axis) {
    const int low = range.low[axis] - cells, high = range.high[axis] + cells;
    range.low[axis] = low > 0 ? low : 0;
    range.high[axis] = high < box.cells[axis] ? high : box.cells[axis];
  }
  return range;
}

}  // namespace gyre
