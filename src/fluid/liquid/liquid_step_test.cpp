// Laws of liquids: rest, waves, falling columns, volume, viscosity, surface tension, threads and widths.
#include "fluid/liquid/liquid_step.h"

#include "fluid/liquid/liquid_test_kit.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::liquid_step_test {
namespace {

using namespace liquid_test;

constexpr double kTurn = 2.0 * 3.14159265358979;

TEST(LiquidRest, a_tank_stays_still_with_the_pressure_of_its_depth) {
  for (const float height : {0.5f, 0.53f}) {  // at and between the places of particles
    LiquidGrid grid = make_liquid_grid(box_of(10, 14, 8, 0.0625f, GasBoundary::closed));
    Bench bench;
    fill_liquid_box(grid, {0, 0, 0}, {0.625, double(height), 0.5}, {}, bench.solids);
    for (int i = 0; i < 60; ++i) bench.step(grid);
    EXPECT_LT(fastest_particle(grid), 1.0e-3f * std::sqrt(9.81f * height));
    for (const double y : {0.05, 0.2, 0.4}) {
      const LiquidProbe probe = probe_liquid(grid, {0.37, y, 0.26}, 1000.0f);
      EXPECT_TRUE(probe.inside);
      EXPECT_NEAR(probe.pressure, 9810.0 * (double(height) - y), 0.01 * 9810.0 * double(height))
          << height << " " << y;
      EXPECT_NEAR(probe.surface, double(height), 0.03 * 0.0625);
    }
    EXPECT_FALSE(probe_liquid(grid, {0.37, 0.6, 0.26}, 1000.0f).inside);
    const double volume = 0.625 * 0.5 * double(height);
    EXPECT_NEAR(liquid_volume(grid, bench.solids), volume, 1.0e-3 * volume);
    EXPECT_NEAR(liquid_totals(grid, 1000.0f, {}).mass, 1000.0 * volume, 1.0e-5 * 1000.0 * volume);
  }
}

TEST(LiquidRest, a_full_box_rests_on_its_walls) {
  LiquidGrid grid = make_liquid_grid(box_of(8, 8, 8, 0.1f, GasBoundary::closed));
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {1, 1, 1}, {}, bench.solids);
  for (int i = 0; i < 20; ++i) bench.step(grid);
  EXPECT_LT(fastest_particle(grid), 1.0e-3f);
}

TEST(LiquidWaves, a_falling_column_runs_as_measured) {
  // J. Martin, W. Moyce, "An Experimental Study of the Collapse of Liquid Columns on a Rigid Horizontal Plane", 1952: width a, height 2 a. The
  // experiment is late by the time its gate takes: 0.2 of the unit of time.
  const float a = 0.05715f, h = a / 16.0f;
  LiquidGrid grid = make_liquid_grid(box_of(80, 40, 1, h, GasBoundary::closed));
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {double(a), 2.0 * double(a), 1.0}, {}, bench.solids);
  const double front[][2] = {{1.19, 1.44}, {1.63, 1.89}, {1.98, 2.33}, {2.20, 2.56}, {2.51, 3.00}};
  const double height[][2] = {{0.56, 0.94}, {0.93, 0.83}, {1.28, 0.72}, {1.66, 0.61}, {2.00, 0.50}};
  std::size_t next_front = 0, next_height = 0;
  const double scale = std::sqrt(9.81 / double(a));
  for (int i = 0; i < 300 && (next_front < std::size(front) || next_height < std::size(height)); ++i) {
    bench.step(grid, 1.0f / 400.0f);
    const double tau = bench.time * scale, t = tau * std::sqrt(2.0) + 0.2;
    float tip = 0.0f;
    for (int p = 0; p < grid.particles(); ++p) tip = std::fmax(tip, grid.position[0][p]);
    if (next_front < std::size(front) && t >= front[next_front][0]) {
      EXPECT_NEAR(double(tip / a), front[next_front][1], 0.1 * front[next_front][1]) << t;
      ++next_front;
    }
    if (next_height < std::size(height) && tau >= height[next_height][0]) {
      const double level =
          probe_liquid(grid, {0.5 * double(h), 0.0, 0.0}, 1000.0f).surface / (2.0 * double(a));
      EXPECT_NEAR(level, height[next_height][1], 0.08 * height[next_height][1]) << tau;
      ++next_height;
    }
  }
  EXPECT_EQ(next_front, std::size(front));
  EXPECT_EQ(next_height, std::size(height));
}

TEST(LiquidWaves, a_standing_wave_has_the_period_of_theory) {
  // w^2 = g k tanh(k d), k = pi/L: 1.18182 s at L = 1, d = 0.5 (H. Lamb, "Hydrodynamics", 1932).
  const int n = 64;
  const float h = 1.0f / float(n);
  LiquidGrid grid = make_liquid_grid(box_of(n, 40, 1, h, GasBoundary::closed));
  Bench bench;
  for (int i = 0; i < 2 * n; ++i) {
    const double x = (i + 0.5) * 0.5 * double(h), level = 0.5 + 0.03 * std::cos(0.5 * kTurn * x);
    fill_liquid_box(grid, {i * 0.5 * double(h), 0, 0}, {(i + 1) * 0.5 * double(h), level, 1}, {},
                    bench.solids);
  }
  double last = 0.0, crossing[3] = {};
  int crossings = 0;
  for (int i = 0; i < 120 && crossings < 3; ++i) {
    bench.step(grid);
    const double now = probe_liquid(grid, {0.5 * double(h), 0, 0}, 1000.0f).surface - 0.5;
    if (i > 0 && (now > 0.0) != (last > 0.0)) crossing[crossings++] = bench.time - now / (now - last) / 60.0;
    last = now;
  }
  EXPECT_NEAR(crossing[2] - crossing[0], 1.18182, 0.03 * 1.18182);
}

TEST(LiquidVolume, sloshing_and_splashing_keep_the_volume) {
  LiquidGrid grid = make_liquid_grid(box_of(24, 24, 1, 0.04f, GasBoundary::closed));
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {0.48, 0.8, 1}, {}, bench.solids);
  LiquidReport report;
  for (int i = 0; i < 600; ++i) {
    bench.settings.gravity = {i < 300 ? 4.0f * std::sin(3.0f * float(bench.time)) : 0.0f, -9.81f, 0.0f};
    report = bench.step(grid);
    EXPECT_LT(report.divergence / 60.0f, 1.0e-3f);
  }
  EXPECT_NEAR(liquid_volume(grid, bench.solids), 0.48 * 0.8 * 0.04, 0.01 * 0.48 * 0.8 * 0.04);
  EXPECT_EQ(grid.particles(), 24 * 40);
}

TEST(LiquidFlight, a_ball_in_the_air_falls_as_a_stone) {
  LiquidGrid grid = make_liquid_grid(box_of(16, 24, 16, 0.05f, GasBoundary::closed));
  Bench bench;
  fill_liquid_ball(grid, {0.4, 0.8, 0.4}, 0.2f, {0.3f, 0, 0}, bench.solids);
  for (int i = 0; i < 15; ++i) bench.step(grid);
  const LiquidTotals totals = liquid_totals(grid, 1000.0f, {});
  EXPECT_NEAR(totals.mass, 1000.0 * 4.18879 * 0.008, 0.02 * 33.5);
  EXPECT_NEAR(totals.momentum.y / totals.mass, -9.81 * 0.25, 1.0e-3 * 9.81 * 0.25);
  EXPECT_NEAR(totals.momentum.x / totals.mass, 0.3, 1.0e-3);
  EXPECT_NEAR(totals.momentum.z / totals.mass, 0.0, 1.0e-3);
}

TEST(LiquidSides, an_open_floor_drains_and_a_source_fills) {
  GasBox box = box_of(16, 16, 1, 0.05f, GasBoundary::closed);
  box.side[2] = GasBoundary::open;
  LiquidGrid grid = make_liquid_grid(box);
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {0.8, 0.4, 1}, {}, bench.solids);
  for (int i = 0; i < 60; ++i) bench.step(grid);
  EXPECT_EQ(grid.particles(), 0);
  // A source of width 0.2 m that runs at 1 m/s for 0.2 s.
  LiquidEmitter source;
  source.position = {0.4, 0.6, 0.025};
  source.radius = 0.1f;
  source.velocity = {0, -1.0f, 0};
  for (int i = 0; i < 12; ++i) bench.step(grid, 1.0f / 60.0f, std::span(&source, 1));
  const double volume = liquid_totals(grid, 1.0f, {}).mass;
  EXPECT_NEAR(volume, (0.0314 + 0.2 * 11.0 / 60.0) * 0.05, 0.1 * 0.07 * 0.05);
}

TEST(LiquidSides, a_stream_goes_round_a_periodic_axis) {
  GasBox box = box_of(12, 10, 1, 0.1f, GasBoundary::closed);
  box.side[0] = box.side[1] = GasBoundary::periodic;
  LiquidGrid grid = make_liquid_grid(box);
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {1.2, 0.5, 1}, {1.5f, 0, 0}, bench.solids);
  for (int i = 0; i < 60; ++i) bench.step(grid);
  for (int p = 0; p < grid.particles(); ++p) ASSERT_NEAR(grid.motion[0][p], 1.5f, 1.0e-3f);
  EXPECT_NEAR(probe_liquid(grid, {0.05, 0.25, 0.05}, 1000.0f).pressure, 9810.0 * 0.25, 40.0);
}

TEST(LiquidViscosity, walls_that_hold_the_liquid_make_a_parabola) {
  GasBox box = box_of(4, 16, 1, 1.0f / 16.0f, GasBoundary::no_slip);
  box.side[0] = box.side[1] = GasBoundary::periodic;
  LiquidGrid grid = make_liquid_grid(box);
  Bench bench;
  bench.settings.density = 1.0f;
  bench.settings.viscosity = 1.0f;
  bench.settings.gravity = {2.0f, 0.0f, 0.0f};
  fill_liquid_box(grid, {0, 0, 0}, {1, 1, 1}, {}, bench.solids);
  for (int i = 0; i < 60; ++i) bench.step(grid);
  for (int j = 0; j < 16; ++j) {  // u = g y (h - y) / (2 nu)
    const double y = (j + 0.5) / 16.0;
    EXPECT_NEAR(grid.velocity[0][grid.shape.at(1, j, 0)], y * (1.0 - y), 0.01 * 0.25);
  }
}

TEST(LiquidViscosity, thick_liquid_that_turns_goes_on_turning) {
  for (const float viscosity : {0.0f, 100.0f}) {
    LiquidGrid grid = make_liquid_grid(box_of(32, 32, 1, 0.05f, GasBoundary::closed));
    Bench bench;
    bench.settings.gravity = {};
    bench.settings.viscosity = viscosity;
    fill_liquid_ball(grid, {0.8, 0.8, 0}, 0.4f, {}, bench.solids);
    for (int p = 0; p < grid.particles(); ++p) {
      grid.motion[0][p] = -2.0f * (grid.position[1][p] - 0.8f);
      grid.motion[1][p] = 2.0f * (grid.position[0][p] - 0.8f);
      grid.affine[1][p] = -2.0f;
      grid.affine[3][p] = 2.0f;
    }
    const auto spin = [&] {
      const LiquidTotals totals = liquid_totals(grid, 1000.0f, {});
      return (totals.angular_momentum - cross(DVec3{0.8, 0.8, 0.0}, totals.momentum)).z;
    };
    const double before = spin();
    for (int i = 0; i < 30; ++i) bench.step(grid);
    EXPECT_NEAR(spin() / before, 1.0, 0.1) << viscosity;
  }
}

TEST(LiquidTension, a_drop_has_the_pressure_of_its_curvature) {
  const float h = 0.02f / 24.0f;
  LiquidGrid grid = make_liquid_grid(box_of(24, 24, 1, h, GasBoundary::closed));
  Bench bench;
  bench.settings.gravity = {};
  bench.settings.surface_tension = 0.072f;
  fill_liquid_ball(grid, {0.01, 0.01, 0.0}, 0.005f, {}, bench.solids);
  double mean = 0.0;
  for (int i = 0; i < 10; ++i) {
    bench.step(grid);
    mean += 0.1 * double(probe_liquid(grid, {0.01, 0.01, 0.0}, 1000.0f).pressure);
  }
  EXPECT_NEAR(mean, 0.072 / 0.005, 0.12 * 0.072 / 0.005);
  EXPECT_LT(fastest_particle(grid), 0.05f);
}

LiquidGrid run_mixed(int threads, int width) {
  GasBox box = box_of(16, 12, 9, 0.1f, GasBoundary::closed);
  box.side[4] = box.side[5] = GasBoundary::periodic;
  LiquidGrid grid = make_liquid_grid(box);
  LiquidMemory memory;
  TaskSystem tasks(threads);
  LiquidSettings settings;
  settings.viscosity = 2.0f;
  settings.surface_tension = 5.0f;
  settings.blend = 0.9f;
  GasSolids solids;
  clear_solids(grid.shape, 1, solids);
  place_solid(
      grid, 0, solids,
      [&](Vec3 p) {
        return length(p - Vec3{1.1f, 0.5f, 0.45f}) - 0.25f;
      },
      [](Vec3) { return Vec3{}; });
  fill_liquid_box(grid, {0, 0, 0}, {0.7, 0.9, 0.9}, {1.0f, 0, 0.5f}, solids);
  FluidBody body;
  body.inverse_mass = 1.0f / 20.0f;
  body.inverse_inertia = {2.0f, 2.0f, 2.0f, 0, 0, 0};
  body.center = {1.1, 0.5, 0.45};
  body.acceleration = {0, -9.81f, 0};
  for (int i = 0; i < 12; ++i) {
    GasImpulse impulse;
    step_in_windows(grid, solids, std::span(&body, 1), {}, settings, i / 30.0, 1.0f / 30.0f, memory,
                    select_gas_kernels(width), tasks, std::span(&impulse, 1));
  }
  return grid;
}

bool same_bits(const Array<float>& a, const Array<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

TEST(LiquidBits, threads_and_widths_do_not_show) {
  const LiquidGrid first = run_mixed(1, 1);
  const int cases[5][2] = {{2, 1}, {8, 4}, {1, 8}, {8, 8}, {2, 16}};
  for (const auto& one : cases) {
    const LiquidGrid other = run_mixed(one[0], one[1]);
    ASSERT_EQ(first.particles(), other.particles());
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(same_bits(first.position[axis], other.position[axis])) << one[0] << " " << one[1];
      EXPECT_TRUE(same_bits(first.motion[axis], other.motion[axis]));
    }
    for (int i = 0; i < 9; ++i) EXPECT_TRUE(same_bits(first.affine[i], other.affine[i]));
  }
}

TEST(LiquidBits, numbers_that_are_none_are_taken_out) {
  LiquidGrid grid = make_liquid_grid(box_of(8, 8, 8, 0.1f, GasBoundary::closed));
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {0.8, 0.4, 0.8}, {}, bench.solids);
  const float bad[3] = {std::nanf(""), 1.0e38f, -INFINITY};
  const int before = grid.particles();
  for (int i = 0; i < 3; ++i) {
    grid.position[i][7 * i] = bad[i];
    grid.motion[i][100 + i] = bad[i];
  }
  for (int i = 0; i < 3; ++i) bench.step(grid);
  EXPECT_GE(grid.particles(), before - 6);
  for (int p = 0; p < grid.particles(); ++p)
    ASSERT_TRUE(is_finite(grid.position[0][p]) && is_finite(grid.motion[1][p]));
}

}  // namespace
}  // namespace gyre::liquid_step_test
