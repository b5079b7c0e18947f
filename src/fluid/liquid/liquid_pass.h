// LiquidPass: the data of the stages of a step of a liquid. Each stage is a function from these arrays to these arrays.
#pragma once

#include "fluid/grid/fluid_body.h"
#include "fluid/liquid/liquid_grid.h"
#include "fluid/liquid/liquid_memory.h"
#include "fluid/solver/gas_pass.h"
#include "task/parallel.h"

#include <span>

namespace gyre {

inline float part_along(Vec3 v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

// Particles stay this many edges away from solids.
inline constexpr float kParticleSkin = 0.1f;

struct LiquidPass {
  LiquidGrid& grid;
  const GasSolids& solids;
  std::span<const FluidBody> bodies;
  LiquidMemory& memory;
  const GasKernels& kernels;
  TaskSystem& tasks;
  float step = 0.0f;     // s
  float elapsed = 0.0f;  // s, from the beginning of the step, where solids stand as given

  // Of the window.
  const GasBox& box() const { return memory.window.box; }
  const GridShape& shape() const { return memory.window.shape; }
  float* scratch(int index) const { return memory.field[index].data(); }
  float edge(int axis) const { return part_along(box().cell, axis); }
  bool flat(int axis) const { return box().flat(axis); }
  bool wraps(int axis) const { return box().periodic(axis) && !box().flat(axis); }
};

// Calls fn(c, j, k) for every row of points, c the index of its first; `faces`: the axis across whose faces they lie, -1: cells.
template <class Fn>
void each_row(const LiquidPass& pass, int faces, Fn&& fn) {
  const GridShape& shape = pass.shape();
  const int rows_y = shape.cells[1] + (faces == 1 ? 1 : 0), rows_z = shape.cells[2] + (faces == 2 ? 1 : 0);
  for_blocks(pass.tasks, rows_y * rows_z, kGridRows, [&](int begin, int end, int) {
    for (int row = begin; row < end; ++row) {
      const int k = row / rows_y, j = row - k * rows_y;
      fn(shape.row(j, k), j, k);
    }
  });
}

// Ghosts of periodic axes: of cells the cells of the opposite side, of faces across the axis likewise, and its upper faces are its lower ones.
template <class T>
void wrap_points(const LiquidPass& pass, T* field) {
  const GridShape& shape = pass.shape();
  for (int axis = 0; axis < 3; ++axis) {
    if (!pass.wraps(axis)) continue;
    const int a = (axis + 1) % 3, b = (axis + 2) % 3, n = shape.cells[axis], stride = shape.stride(axis);
    for (int j = -1; j <= shape.cells[b]; ++j) {
      for (int i = -1; i <= shape.cells[a]; ++i) {
        T* const line = field + shape.first + i * shape.stride(a) + j * shape.stride(b);
        line[-stride] = line[(n - 1) * stride];
        line[n * stride] = line[0];
      }
    }
  }
}

// Where particles lie along an axis of the box, on a grid of `cells` cells from the cell `first` on. A wall keeps them a thousandth of an edge away.
inline ParticleAxis particle_axis(const GasBox& box, int axis, int first, int cells) {
  ParticleAxis result;
  const int n = box.cells[axis], end = first + cells;
  const bool flat = n == 1;
  result.wraps = box.periodic(axis) && !flat;
  result.edge = part_along(box.cell, axis);
  result.inverse_edge = 1.0f / result.edge;
  result.first_face = first;
  result.last_face = end - 1;
  result.low = result.wraps ? -1 : first;
  result.last_center = result.wraps ? n - 1 : flat ? 0 : end - 2;
  result.highest_center = result.wraps ? float(n) : float(end - 1);
  result.length = float(n) * result.edge;
  const float margin = 1.0e-3f * result.edge, far = 1.0e30f;
  const bool open_low = box.open(2 * axis), open_high = box.open(2 * axis + 1);
  const bool held_low = !open_low && !result.wraps, held_high = !open_high && !result.wraps;
  result.lower_wall = held_low ? margin : 0.0f;
  result.upper_wall = held_high ? result.length - margin : result.length;
  result.lower_limit = held_low ? margin : open_low ? -far : 0.0f;
  result.upper_limit = held_high ? result.length - margin : open_high ? far : result.length;
  result.lower_speed = held_low ? 0.0f : -far;
  result.upper_speed = held_high ? 0.0f : far;
  return result;
}
inline ParticleAxis particle_axis(const GasBox& box, int axis) {
  return particle_axis(box, axis, 0, box.cells[axis]);
}

}  // namespace gyre
