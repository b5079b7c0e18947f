// Helpers of the tests of gases.
#pragma once

#include "fluid/gas/gas_reading.h"
#include "fluid/gas/gas_step.h"

#include <cmath>
#include <cstdint>

namespace gyre::gas_test {

struct Bench {
  TaskSystem tasks{1};
  const GasKernels* kernels = &select_gas_kernels(0);
  GasMemory memory;
  GasSolids solids;
  std::span<const FluidBody> bodies{};
  GasSettings settings;
  double time = 0.0;

  GasReport step(GasGrid& grid, float step, std::span<const GasEmitter> emitters = {},
                 std::span<GasImpulse> impulses = {}) {
    const GasReport report =
        step_gas(grid, solids, bodies, emitters, settings, time, step, memory, *kernels, tasks, impulses);
    time += double(step);
    return report;
  }
  GasReport settle(GasGrid& grid) { return settle_gas(grid, solids, settings, memory, *kernels, tasks); }
};

// A box with the same boundary on all sides, of cubes with this edge.
inline GasBox box_of(int nx, int ny, int nz, float edge, GasBoundary boundary) {
  GasBox box;
  box.cells[0] = nx, box.cells[1] = ny, box.cells[2] = nz;
  box.cell = {edge, edge, edge};
  for (GasBoundary& side : box.side) side = boundary;
  return box;
}

// Calls set(place in the array, x, y, z) for every cell, or every face across an axis, with the point in the box.
template <class Fn>
void for_places(const GasGrid& grid, int faces, Fn&& set) {
  const GridShape& shape = grid.shape;
  const Vec3 h = grid.box.cell;
  for (int k = 0; k < shape.cells[2] + (faces == 2 ? 1 : 0); ++k) {
    for (int j = 0; j < shape.cells[1] + (faces == 1 ? 1 : 0); ++j) {
      for (int i = 0; i < shape.cells[0] + (faces == 0 ? 1 : 0); ++i) {
        set(shape.at(i, j, k), (double(i) + (faces == 0 ? 0.0 : 0.5)) * double(h.x),
            (double(j) + (faces == 1 ? 0.0 : 0.5)) * double(h.y),
            (double(k) + (faces == 2 ? 0.0 : 0.5)) * double(h.z));
      }
    }
  }
}

// Numbers between -1 and 1.
struct Random {
  std::uint64_t state = 12345;
  float next() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return float(double(state >> 40) / double(1u << 23) - 1.0);
  }
};

// Vortices in the x-y plane: u = a sin(k x) cos(k y), v = -a cos(k x) sin(k y).
inline void set_taylor_green(GasGrid& grid, double amplitude, double k) {
  for_places(grid, 0, [&](int c, double x, double y, double) {
    grid.velocity[0][c] = float(amplitude * std::sin(k * x) * std::cos(k * y));
  });
  for_places(grid, 1, [&](int c, double x, double y, double) {
    grid.velocity[1][c] = float(-amplitude * std::cos(k * x) * std::sin(k * y));
  });
}

// The root of the mean square of what velocity differs from these vortices by, over their own.
inline double taylor_green_error(const GasGrid& grid, double amplitude, double k) {
  double error = 0.0, all = 0.0;
  for_places(grid, 0, [&](int c, double x, double y, double) {
    const double exact = amplitude * std::sin(k * x) * std::cos(k * y);
    error += (double(grid.velocity[0][c]) - exact) * (double(grid.velocity[0][c]) - exact);
    all += exact * exact;
  });
  return std::sqrt(error / all);
}

// The fraction of faces that a sphere leaves open, its cells and its velocity.
inline void place_sphere(const GasGrid& grid, Vec3 center, float radius, Vec3 velocity, GasSolids& solids) {
  const GridShape& shape = grid.shape;
  clear_solids(shape, 1, solids);
  const auto distance = [&](double x, double y, double z) {
    const double dx = x - double(center.x), dy = y - double(center.y), dz = z - double(center.z);
    return std::sqrt(dx * dx + dy * dy + dz * dz) - double(radius);
  };
  const double h = double(grid.box.cell.x);
  for (int axis = 0; axis < 3; ++axis) {
    for_places(grid, axis, [&](int c, double x, double y, double z) {
      if (distance(x, y, z) > 2.0 * h) return;
      int open = 0;
      constexpr int kSamples = 8;
      for (int a = 0; a < kSamples; ++a) {
        for (int b = 0; b < kSamples; ++b) {
          const double s = h * ((a + 0.5) / kSamples - 0.5), t = h * ((b + 0.5) / kSamples - 0.5);
          const double d = axis == 0   ? distance(x, y + s, z + t)
                           : axis == 1 ? distance(x + s, y, z + t)
                                       : distance(x + s, y + t, z);
          open += d > 0.0 ? 1 : 0;
        }
      }
      if (open == kSamples * kSamples) return;
      solids.open[axis][c] = float(open) / float(kSamples * kSamples);
      solids.velocity[axis][c] = axis == 0 ? velocity.x : axis == 1 ? velocity.y : velocity.z;
      solids.label[axis][c] = 0;
    });
  }
  for_places(grid, -1, [&](int c, double x, double y, double z) {
    solids.solid[c] = distance(x, y, z) < -0.5 * h ? 1 : 0;
  });
}

}  // namespace gyre::gas_test
