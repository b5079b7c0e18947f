// Curvature of the surface and its pressure.
#include "fluid/liquid/surface_tension.h"

#include <cmath>

namespace gyre {

namespace {

// Of the fraction. More of them make curvatures of one cell invisible, which then grow: drops burst.
constexpr int kSmoothings = 1;

// 1/4, 1/2, 1/4 along each axis.
void smooth_fraction(const LiquidPass& pass, float* field, float* spare) {
  const GridShape& shape = pass.shape();
  float* from = field;
  float* to = spare;
  for (int round = 0; round < kSmoothings; ++round) {
    for (int axis = 0; axis < 3; ++axis) {
      if (pass.flat(axis)) continue;
      fill_ghosts(pass.box(), shape, from);
      const int step = shape.stride(axis);
      each_row(pass, -1, [&](int c, int, int) {
        for (int i = c; i < c + shape.cells[0]; ++i)
          to[i] = 0.5f * from[i] + 0.25f * (from[i - step] + from[i + step]);
      });
      float* const swapped = from;
      from = to;
      to = swapped;
    }
  }
  if (from != field) {
    each_row(pass, -1, [&](int c, int, int) {
      for (int i = c; i < c + shape.cells[0]; ++i) field[i] = from[i];
    });
  }
  fill_ghosts(pass.box(), shape, field);
}

}  // namespace

void set_surface_pressure(const LiquidPass& pass, float ratio) {
  const GridShape& shape = pass.shape();
  float* const fraction = pass.scratch(0);
  const float* const filled = pass.memory.filled.data();
  const LiquidCell* const cell = pass.memory.cell.data();
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) {
      const float full = cell[i] == LiquidCell::solid ? 0.5f : filled[i];
      fraction[i] = full < 1.0f ? full : 1.0f;
    }
  });
  smooth_fraction(pass, fraction, pass.scratch(1));
  float* const normal[3] = {pass.scratch(2), pass.scratch(3), pass.scratch(4)};
  float half[3];
  for (int axis = 0; axis < 3; ++axis) half[axis] = pass.flat(axis) ? 0.0f : 0.5f / pass.edge(axis);
  const int py = shape.pitch, pz = shape.plane;
  const float least = 1.0e-3f / pass.edge(0);
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) {
      const float x = half[0] * (fraction[i + 1] - fraction[i - 1]),
                  y = half[1] * (fraction[i + py] - fraction[i - py]),
                  z = half[2] * (fraction[i + pz] - fraction[i - pz]);
      const float size = std::sqrt(x * x + y * y + z * z);
      const float scale = size > least ? 1.0f / size : 0.0f;
      normal[0][i] = scale * x, normal[1][i] = scale * y, normal[2][i] = scale * z;
    }
  });
  for (float* const part : normal) fill_ghosts(pass.box(), shape, part);
  float* const pressure = pass.memory.pressure.data();
  const float most = 2.0f / pass.edge(0);
  each_row(pass, -1, [&](int c, int, int) {
    for (int i = c; i < c + shape.cells[0]; ++i) {
      if (cell[i] != LiquidCell::air) continue;
      const bool beside = cell[i - 1] == LiquidCell::liquid || cell[i + 1] == LiquidCell::liquid ||
                          cell[i - py] == LiquidCell::liquid || cell[i + py] == LiquidCell::liquid ||
                          cell[i - pz] == LiquidCell::liquid || cell[i + pz] == LiquidCell::liquid;
      const float curvature = -(half[0] * (normal[0][i + 1] - normal[0][i - 1]) +
                                half[1] * (normal[1][i + py] - normal[1][i - py]) +
                                half[2] * (normal[2][i + pz] - normal[2][i - pz]));
      pressure[i] = beside ? ratio * clamp(curvature, -most, most) : 0.0f;
    }
  });
}

float capillary_step(const GasBox& box, float ratio) {
  const float edge = smallest(box.cell);
  return ratio > 0.0f ? std::sqrt(edge * edge * edge / (6.2831853f * ratio)) : 1.0e30f;
}

}  // namespace gyre
