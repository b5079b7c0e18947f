// GridShape: where the numbers of a grid of cells lie in an array. All fields of a grid, those of cell centres and those of faces, have the
// same places: cell (i, j, k), and the face between it and its lower neighbour along each axis. Cells lie in rows along x. A row has room
// for a ghost cell at either end, as have the other axes, and whole rows of 16 numbers, so that every row begins on a cache line.
//
// Cells of the grid: 0 to cells - 1 along each axis; ghosts: -1 and cells. Faces: 0 to cells across their own axis.
#pragma once

#include <cstddef>

namespace gyre {

struct GridShape {
  int cells[3] = {0, 0, 0};
  int pitch = 0;  // from a row to the next along y
  int plane = 0;  // from a row to the next along z
  int first = 0;  // of cell (0, 0, 0)
  int size = 0;   // of the array, margins for wide loads included

  int row(int j, int k) const { return first + pitch * j + plane * k; }
  int at(int i, int j, int k) const { return row(j, k) + i; }
  int stride(int axis) const { return axis == 0 ? 1 : axis == 1 ? pitch : plane; }
  int rows() const { return cells[1] * cells[2]; }
  int count() const { return cells[0] * cells[1] * cells[2]; }
};

inline GridShape make_grid_shape(int nx, int ny, int nz) {
  constexpr int kMargin =
      64;  // wide loads of numbers that no lane uses reach at most 32 numbers beyond the ghosts
  GridShape shape;
  shape.cells[0] = nx, shape.cells[1] = ny, shape.cells[2] = nz;
  shape.pitch = (nx + 2 + 15) / 16 * 16;
  shape.plane = shape.pitch * (ny + 2);
  shape.first = kMargin + shape.plane + shape.pitch;
  shape.size = shape.first + shape.plane * (nz + 1) + kMargin;
  return shape;
}

}  // namespace gyre
