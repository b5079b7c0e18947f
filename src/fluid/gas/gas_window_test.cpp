// Windows of gases with an adaptive domain: which cells count, what a new window keeps, and how far the flow in a window is from that in the whole box.
#include "fluid/gas/gas_window.h"

#include "fluid/gas/gas_test_kit.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::gas_window_test {
namespace {

using namespace gas_test;

constexpr float kAmbient = 293.15f;
constexpr float kStep = 1.0f / 60.0f;

CellBox box_of_cells(int x, int y, int z, int x_end, int y_end, int z_end) {
  return {{x, y, z}, {x_end, y_end, z_end}};
}

TEST(GasWindow, smoke_heat_fuel_and_fast_air_count) {
  TaskSystem tasks{1};
  const GasBox box = box_of(64, 48, 40, 0.1f, GasBoundary::open);
  GasGrid grid = make_gas_grid(box, kAmbient);
  EXPECT_TRUE(is_empty(find_active_cells(grid, 0.1f, kStep, tasks)));
  grid.fuel.resize(std::size_t(grid.shape.size), 0.0f);
  // A field at rest reaches one cell.
  const CellBox one = box_of_cells(19, 9, 4, 22, 12, 7);
  for (Array<float>* const field : {&grid.density, &grid.temperature, &grid.fuel}) {
    const float before = (*field)[grid.shape.at(20, 10, 5)];
    (*field)[grid.shape.at(20, 10, 5)] = before - 1.0f;
    EXPECT_EQ(find_active_cells(grid, 0.1f, kStep, tasks), one);
    (*field)[grid.shape.at(20, 10, 5)] = before;
  }
  // A face belongs to the cells on both sides. 12 m/s pass 2 cells in a step, and one more may have some.
  grid.velocity[0][grid.shape.at(20, 10, 5)] = 12.0f;
  EXPECT_EQ(find_active_cells(grid, 0.1f, kStep, tasks), box_of_cells(16, 9, 4, 24, 12, 7));
  grid.velocity[1][grid.shape.at(40, 10, 5)] = -1.19f;
  EXPECT_EQ(find_active_cells(grid, 0.1f, kStep, tasks), box_of_cells(16, 9, 4, 24, 12, 7));
  grid.velocity[1][grid.shape.at(40, 10, 5)] = -1.21f;
  EXPECT_EQ(find_active_cells(grid, 0.1f, kStep, tasks), box_of_cells(16, 8, 4, 44, 12, 7));
}

TEST(GasWindow, a_trace_of_smoke_below_rounding_does_not_count) {
  TaskSystem tasks{1};
  GasGrid grid = make_gas_grid(box_of(64, 16, 16, 0.1f, GasBoundary::open), kAmbient);
  grid.density[grid.shape.at(10, 8, 8)] = 2.0f;
  grid.density[grid.shape.at(50, 8, 8)] = 1.0e-6f;
  EXPECT_EQ(find_active_cells(grid, 0.1f, kStep, tasks).high[0], 12);
  grid.density[grid.shape.at(50, 8, 8)] = 4.0e-6f;
  EXPECT_EQ(find_active_cells(grid, 0.1f, kStep, tasks).high[0], 52);
}

TEST(GasWindow, a_new_window_keeps_what_both_hold) {
  const GasBox box = box_of(32, 24, 24, 0.1f, GasBoundary::closed);
  GasGrid whole = make_gas_grid(box, kAmbient);
  Random random;
  for (int axis = 0; axis < 3; ++axis)
    for_places(whole, axis, [&](int c, double, double, double) { whole.velocity[axis][c] = random.next(); });
  for (Array<float>* const field : {&whole.density, &whole.temperature, &whole.pressure})
    for_places(whole, -1, [&](int c, double, double, double) { (*field)[c] = random.next(); });
  GasGrid part = make_gas_grid(box, CellBox{}, kAmbient);
  EXPECT_EQ(part.cells(), box_of_cells(0, 0, 0, 8, 8, 8));
  part = whole;
  part.window.push_back(whole.cells());
  set_gas_window(part, gas_window(box, box_of_cells(9, 3, 10, 15, 10, 20)));
  EXPECT_EQ(part.cells(), box_of_cells(8, 0, 8, 16, 16, 24));
  EXPECT_EQ(part.box.side[0], GasBoundary::open);
  EXPECT_EQ(part.box.side[2], GasBoundary::closed);
  EXPECT_EQ(part.box.side[3], GasBoundary::open);
  EXPECT_EQ(part.box.side[5], GasBoundary::closed);
  const DVec3 inside{1.23, 0.71, 1.57}, outside{0.4, 0.71, 1.57};
  const GasProbe a = probe_gas(whole, inside, 1.2f, {}), b = probe_gas(part, inside, 1.2f, {});
  EXPECT_NEAR(a.velocity.x, b.velocity.x, 1.0e-5f);
  EXPECT_NEAR(a.velocity.y, b.velocity.y, 1.0e-5f);
  EXPECT_NEAR(a.velocity.z, b.velocity.z, 1.0e-5f);
  EXPECT_NEAR(a.density, b.density, 1.0e-5f);
  EXPECT_NEAR(a.temperature, b.temperature, 1.0e-5f);
  EXPECT_NEAR(a.pressure, b.pressure, 1.0e-5f);
  const GasProbe rest = probe_gas(part, outside, 1.2f, {});
  EXPECT_EQ(rest.velocity, Vec3{});
  EXPECT_EQ(rest.density, 0.0f);
  EXPECT_EQ(rest.temperature, kAmbient);
  // Larger again: what was outside is at rest.
  set_gas_window(part, whole_window(box));
  EXPECT_EQ(part.density[part.shape.at(3, 5, 12)], 0.0f);
  EXPECT_EQ(part.temperature[part.shape.at(3, 5, 12)], kAmbient);
  EXPECT_EQ(part.density[part.shape.at(12, 5, 12)], whole.density[whole.shape.at(12, 5, 12)]);
  EXPECT_EQ(part.velocity[0][part.shape.at(16, 5, 12)], whole.velocity[0][whole.shape.at(16, 5, 12)]);
  EXPECT_EQ(part.velocity[0][part.shape.at(17, 5, 12)], 0.0f);
}

// A warm ball of smoke.
GasGrid thermal(const GasBox& box) {
  GasGrid grid = make_gas_grid(box, kAmbient);
  for_places(grid, -1, [&](int c, double x, double y, double z) {
    const double r = (x - 0.75) * (x - 0.75) + (y - 0.4) * (y - 0.4) + (z - 0.75) * (z - 0.75);
    if (r < 0.15 * 0.15) grid.density[c] = 1.0f, grid.temperature[c] = 323.15f;
  });
  return grid;
}

struct Rise {
  double mass = 0.0, height = 0.0, speed = 0.0;  // of the smoke
  double cells = 0.0;                            // of a step, in the mean
  float divergence = 0.0f;
};

Rise rise(GasBoundary boundary, int margin, float threshold, bool keeps_memory = true) {
  GasGrid grid = thermal(box_of(48, 48, 48, 1.0f / 32, boundary));
  if (margin > 0) grid.window.push_back(grid.cells());
  Bench bench;
  Rise out;
  constexpr int kSteps = 60;
  for (int i = 0; i < kSteps; ++i) {
    if (margin > 0) {
      const CellBox range = find_active_cells(grid, threshold, kStep, bench.tasks);
      set_gas_window(grid, gas_window(grid.whole, grow(grid.whole, range, margin)));
      if (!keeps_memory) bench.memory = {};
    }
    out.divergence = bench.step(grid, kStep).divergence;
    out.cells += double(grid.shape.count()) / kSteps;
  }
  for_places(grid, -1, [&](int c, double, double y, double) {
    const double smoke = double(grid.density[c]);
    const double v = 0.5 * double(grid.velocity[1][c] + grid.velocity[1][c + grid.shape.pitch]);
    out.mass += smoke;
    out.height += smoke * (y + double(grid.first(1)) / 32 - 0.4), out.speed += smoke * v;
  });
  out.height /= out.mass, out.speed /= out.mass;
  return out;
}

TEST(GasWindow, a_thermal_rises_as_in_the_whole_box) {
  const AdaptiveDomain domain;
  for (const GasBoundary boundary : {GasBoundary::open, GasBoundary::closed}) {
    const Rise whole = rise(boundary, 0, 0.0f), part = rise(boundary, domain.margin, domain.threshold);
    EXPECT_NEAR(part.height, whole.height, 0.015 * whole.height);
    EXPECT_NEAR(part.speed, whole.speed, 0.015 * whole.speed);
    EXPECT_LT(part.divergence * kStep, 1.1e-4f);
    EXPECT_LT(part.cells, 0.9 * whole.cells);
    if (boundary == GasBoundary::closed) {
      EXPECT_NEAR(part.mass, whole.mass, 2.0e-6 * whole.mass);
    } else {
      EXPECT_NEAR(part.mass, whole.mass, 5.0e-3 * whole.mass);
    }
  }
}

// Without a margin and with a threshold of the fastest speed itself the walls of the window are felt.
TEST(GasWindow, the_error_comes_from_the_margin) {
  const double whole = rise(GasBoundary::closed, 0, 0.0f).speed;
  const AdaptiveDomain domain;
  const double narrow = std::fabs(rise(GasBoundary::closed, 1, 1.0f).speed / whole - 1.0);
  const double wide =
      std::fabs(rise(GasBoundary::closed, domain.margin, domain.threshold).speed / whole - 1.0);
  EXPECT_GT(narrow, 2.0 * wide);
}

TEST(GasWindow, a_memory_that_is_kept_gives_the_bits_of_a_new_one) {
  const Rise kept = rise(GasBoundary::closed, 3, 0.2f), renewed = rise(GasBoundary::closed, 3, 0.2f, false);
  EXPECT_EQ(kept.height, renewed.height);
  EXPECT_EQ(kept.speed, renewed.speed);
}

// Two windows of the same size, one at a wall and one away from it: the second has no wall.
TEST(GasWindow, a_window_that_leaves_a_wall_has_another_matrix) {
  const GasBox box = box_of(32, 8, 8, 0.1f, GasBoundary::closed);
  Bench bench;
  GasGrid grid = make_gas_grid(box, box_of_cells(0, 0, 0, 16, 8, 8), kAmbient);
  bench.step(grid, kStep);
  GasGrid moved = make_gas_grid(box, box_of_cells(8, 0, 0, 24, 8, 8), kAmbient);
  for (float& u : moved.velocity[0]) u = 1.0f;
  GasGrid fresh = moved;
  bench.step(moved, kStep);
  Bench other;
  other.step(fresh, kStep);
  EXPECT_GT(fresh.velocity[0][fresh.shape.at(0, 4, 4)], 0.1f);
  EXPECT_EQ(std::memcmp(moved.velocity[0].data(), fresh.velocity[0].data(),
                        moved.velocity[0].size() * sizeof(float)),
            0);
}

}  // namespace
}  // namespace gyre::gas_window_test
