// GasPass: the data of the stages of a step of a gas. Each stage is a function from these arrays to these arrays.
#pragma once

#include "fluid/grid/frame_motion.h"
#include "fluid/solver/body_coupling.h"
#include "fluid/solver/pressure_matrix.h"
#include "task/parallel.h"

#include <span>

namespace gyre {

// Memory that the stages of a step share, one after the other, and the pressure equation, which lasts until solids move.
struct GasMemory {
  static constexpr int kFields = 9;
  Array<float> field[kFields];
  Array<float> before[3];  // the velocity at the beginning of the step, with viscosity
  CellBox cells;           // of the gas, that the fields and the matrix belong to
  PressureMatrix matrix;
  BodyCoupling coupling;
  // If bodies move by the pressure: the velocity of solids on faces, as it is now, and the open fraction of faces.
  Array<float> solid_velocity[3], open[3];
};

struct GasPass {
  GasGrid& grid;
  const GasSolids& solids;
  GasMemory& memory;
  const GasKernels& kernels;
  TaskSystem& tasks;
  float step = 0.0f;                    // s
  std::span<const FluidBody> bodies{};  // by label; those that are free to move do so by the pressure
  float density = 1.0f;                 // kg/m^3, of the gas
  FrameMotion motion{};

  bool couples() const { return solids.present() && memory.coupling.any_moves; }
  const float* solid_velocity(int axis) const {
    return couples() ? memory.solid_velocity[axis].data() : solids.velocity[axis].data();
  }
  const GasBox& box() const { return grid.box; }
  const GridShape& shape() const { return grid.shape; }
  float* scratch(int index) const { return memory.field[index].data(); }
  float edge(int axis) const {
    return axis == 0 ? grid.box.cell.x : axis == 1 ? grid.box.cell.y : grid.box.cell.z;
  }
  bool flat(int axis) const { return grid.box.flat(axis); }
};

// Calls fn(c, j, k) for every row of cells, c the index of its first; `more`: with the last row of the faces across this axis, -1: none.
template <class Fn>
void each_row(const GasPass& pass, int more, Fn&& fn) {
  const GridShape& shape = pass.shape();
  const int rows_y = shape.cells[1] + (more == 1 ? 1 : 0), rows_z = shape.cells[2] + (more == 2 ? 1 : 0);
  for_blocks(pass.tasks, rows_y * rows_z, kGridRows, [&](int begin, int end, int) {
    for (int row = begin; row < end; ++row) {
      const int k = row / rows_y, j = row - k * rows_y;
      fn(shape.row(j, k), j, k);
    }
  });
}

// The points of cells (faces = -1) or of the faces across an axis.
inline FieldRows rows_of(const GridShape& shape, int faces) {
  FieldRows rows;
  rows.shape = shape;
  for (int axis = 0; axis < 3; ++axis) rows.points[axis] = shape.cells[axis] + (axis == faces ? 1 : 0);
  return rows;
}
// Calls fn(row_begin, row_end) for blocks of rows of points.
template <class Fn>
void for_row_blocks(const FieldRows& rows, TaskSystem& tasks, Fn&& fn) {
  for_blocks(tasks, rows.points[1] * rows.points[2], kGridRows,
             [&](int begin, int end, int) { fn(begin, end); });
}
// The largest magnitude in a field.
inline float largest_of(const FieldRows& rows, const float* field, const GasKernels& kernels,
                        TaskSystem& tasks) {
  return reduce_blocks(
      tasks, rows.points[1] * rows.points[2], kGridRows, 0.0f,
      [&](int begin, int end, int) { return kernels.largest(rows, field, begin, end); },
      [](float a, float b) { return a > b ? a : b; });
}

// fn(c, j, k) of every row of cells, added up in double in the order of rows.
template <class Fn>
double sum_rows(const GridShape& shape, TaskSystem& tasks, Fn&& fn) {
  return reduce_blocks(
      tasks, shape.rows(), kGridRows, 0.0,
      [&](int begin, int end, int) {
        double sum = 0.0;
        for (int row = begin; row < end; ++row) {
          const int k = row / shape.cells[1], j = row - k * shape.cells[1];
          sum += fn(shape.row(j, k), j, k);
        }
        return sum;
      },
      [](double a, double b) { return a + b; });
}

}  // namespace gyre
