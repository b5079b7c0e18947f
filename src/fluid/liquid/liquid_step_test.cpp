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

}  // namespace
}  // namespace gyre
