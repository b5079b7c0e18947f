// Laws of liquids: rest, waves, falling columns, volume, momentum, threads and widths.
#include "fluid/liquid/liquid_step.h"

#include "fluid/liquid/liquid_test_kit.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>

namespace gyre {
namespace {

using namespace liquid_test;

TEST(LiquidRest, a_tank_stays_still_with_the_pressure_of_its_depth) {
  for (const float height : {0.5f, 0.53f, 0.5625f}) {
    LiquidGrid grid = make_liquid_grid(box_of(12, 16, 8, 0.0625f, GasBoundary::closed));
    Bench bench;
    fill_liquid_box(grid, {0, 0, 0}, {0.75, double(height), 0.5}, {}, bench.solids);
    LiquidReport report;
    double iterations = 0.0;
    for (int i = 0; i < 120; ++i) {
      report = bench.step(grid);
      iterations += report.iterations;
      if (i % 30 == 0)
        std::printf("%d: fastest %g its %d res %g div %g vol %g\n", i, fastest_particle(grid),
                    report.iterations, report.residual, report.divergence, report.volume);
    }
    EXPECT_LT(fastest_particle(grid), 1.0e-3f * std::sqrt(9.81f * height));
    for (const double y : {0.05, 0.2, 0.4}) {
      const LiquidProbe probe = probe_liquid(grid, {0.37, y, 0.26}, 1000.0f);
      EXPECT_TRUE(probe.inside);
      EXPECT_NEAR(probe.pressure, 9810.0 * (double(height) - y), 0.01 * 9810.0 * double(height))
          << height << " " << y;
      EXPECT_NEAR(probe.surface, double(height), 0.03 * 0.0625);
    }
    EXPECT_NEAR(report.volume, 0.75 * 0.5 * double(height), 1.0e-3 * 0.75 * 0.5 * double(height));
  }
}

GasBox plane_box(int nx, int ny, float edge) {
  GasBox box = box_of(nx, ny, 1, edge, GasBoundary::closed);
  return box;
}

TEST(LiquidWaves, a_falling_column_runs_as_measured) {
  // J. Martin, W. Moyce, "An Experimental Study of the Collapse of Liquid Columns on a Rigid Horizontal Plane", 1952: width a, height 2 a.
  const float a = 0.05715f, h = a / 16.0f;
  LiquidGrid grid = make_liquid_grid(plane_box(96, 40, h));
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {double(a), 2.0 * double(a), 1.0}, {}, bench.solids);
  const double front[][2] = {{0.41, 1.11}, {0.84, 1.22}, {1.19, 1.44}, {1.43, 1.67},
                             {1.63, 1.89}, {1.83, 2.11}, {1.98, 2.33}, {2.20, 2.56},
                             {2.32, 2.78}, {2.51, 3.00}, {2.65, 3.22}, {2.83, 3.44}};
  const double height[][2] = {{0.56, 0.94}, {0.77, 0.89}, {0.93, 0.83}, {1.08, 0.78}, {1.28, 0.72},
                              {1.46, 0.67}, {1.66, 0.61}, {1.84, 0.56}, {2.00, 0.50}};
  std::size_t next_front = 0, next_height = 0;
  const double scale = std::sqrt(9.81 / double(a));
  for (int i = 0; i < 400 && (next_front < std::size(front) || next_height < std::size(height)); ++i) {
    const LiquidReport r = bench.step(grid, 1.0f / 400.0f);
    const double tau = bench.time * scale, t = tau * std::sqrt(2.0);
    float tip = 0.0f;
    for (int p = 0; p < grid.particles(); ++p) tip = std::fmax(tip, grid.position[0][p]);
    if (next_front < std::size(front) && t >= front[next_front][0]) {
      std::printf("T %.3f Z %.3f (%.2f) sub %d it %d vol %g\n", t, double(tip / a), front[next_front][1],
                  r.substeps, r.iterations, r.volume / double(2 * a * a * h));
      ++next_front;
    }
    if (next_height < std::size(height) && tau >= height[next_height][0]) {
      std::printf("   tau %.3f H %.3f (%.2f)\n", tau,
                  probe_liquid(grid, {0.5 * double(h), 0.0, 0.0}, 1000.0f).surface / (2.0 * double(a)),
                  height[next_height][1]);
      ++next_height;
    }
  }
}

TEST(LiquidWaves, a_standing_wave_has_the_period_of_theory) {
  // w^2 = g k tanh(k d), k = pi/L: 1.18182 s at L = 1, d = 0.5.
  const int n = 64;
  const float h = 1.0f / float(n);
  LiquidGrid grid = make_liquid_grid(plane_box(n, 48, h));
  Bench bench;
  // Columns of half a cell, each filled to its height.
  for (int i = 0; i < 2 * n; ++i) {
    const double x = (i + 0.5) * 0.5 * double(h);
    const double level = 0.5 + 0.03 * std::cos(3.14159265358979 * x);
    fill_liquid_box(grid, {i * 0.5 * double(h), 0, 0}, {(i + 1) * 0.5 * double(h), level, 1}, {},
                    bench.solids);
  }
  double last = 0.0, crossing[8] = {};
  int crossings = 0;
  for (int i = 0; i < 240 && crossings < 5; ++i) {
    bench.step(grid, 1.0f / 60.0f);
    const double now = probe_liquid(grid, {0.5 * double(h), 0, 0}, 1000.0f).surface - 0.5;
    if (i % 10 == 0) {
      const LiquidTotals totals = liquid_totals(grid, 1000.0f, {0, -9.81f, 0});
      std::printf("%.3f %.5f E %.6f\n", bench.time, now,
                  totals.kinetic_energy + totals.potential_energy - totals.mass * 9.81 * 0.25);
    }
    if (i > 0 && (now > 0.0) != (last > 0.0)) crossing[crossings++] = bench.time - now / (now - last) / 60.0;
    last = now;
  }
  std::printf("crossings %g %g %g %g %g period %g\n", crossing[0], crossing[1], crossing[2], crossing[3],
              crossing[4], (crossing[4] - crossing[0]) / 2);
}

TEST(LiquidVolume, sloshing_keeps_the_volume) {
  LiquidGrid grid = make_liquid_grid(plane_box(40, 40, 0.025f));
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {0.5, 0.8, 1}, {}, bench.solids);
  for (int i = 0; i < 1200; ++i) {
    bench.settings.gravity = {i < 900 ? 4.0f * std::sin(3.0f * float(bench.time)) : 0.0f, -9.81f, 0.0f};
    const LiquidReport r = bench.step(grid, 1.0f / 60.0f);
    if (i % 60 == 0) {
      const LiquidTotals totals = liquid_totals(grid, 1000.0f, {0, -9.81f, 0});
      std::printf("%d vol %.4f sub %d its %d div %g fastest %g E %g n %d\n", i, r.volume / (0.4 * 0.025),
                  r.substeps, r.iterations, r.divergence, fastest_particle(grid),
                  totals.kinetic_energy + totals.potential_energy, grid.particles());
    }
  }
}

TEST(LiquidCubes, speed) {
  LiquidGrid grid = make_liquid_grid(box_of(64, 32, 32, 1.0f / 32.0f, GasBoundary::closed));
  Bench bench;
  fill_liquid_box(grid, {0, 0, 0}, {0.6, 0.7, 1}, {}, bench.solids);
  for (int i = 0; i < 60; ++i) {
    const LiquidReport r = bench.step(grid, 1.0f / 60.0f);
    if (i % 10 == 0)
      std::printf("%d n %d vol %.4f sub %d its %d div %g fastest %g\n", i, grid.particles(), r.volume / 0.42,
                  r.substeps, r.iterations, r.divergence, fastest_particle(grid));
  }
}

}  // namespace
}  // namespace gyre
