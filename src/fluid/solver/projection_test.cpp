// The pressure equation: divergence on random fields, solids that move, and what pressure does to them.
#include "fluid/solver/projection.h"

#include "fluid/gas/gas_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::projection_test {
namespace {

using namespace gas_test;

void fill_randomly(GasGrid& grid) {
  Random random;
  for (int axis = 0; axis < 3; ++axis) {
    for_places(grid, axis, [&](int c, double, double, double) { grid.velocity[axis][c] = random.next(); });
    wrap_faces(grid.box, grid.shape, axis, grid.velocity[axis].data());
  }
}

TEST(Projection, random_fields_lose_their_divergence_with_every_kind_of_boundary) {
  const GasBoundary kinds[4] = {GasBoundary::periodic, GasBoundary::open, GasBoundary::closed,
                                GasBoundary::no_slip};
  const int sizes[3][3] = {{16, 16, 16}, {13, 22, 9}, {20, 30, 1}};
  for (const auto& size : sizes) {
    for (int mix = 0; mix < 64; mix += 5) {
      GasBox box = box_of(size[0], size[1], size[2], 1.0f, GasBoundary::closed);
      box.cell = {0.1f, 0.12f, 0.15f};
      for (int axis = 0; axis < 3; ++axis) {
        const GasBoundary kind = kinds[mix >> (2 * axis) & 3];
        box.side[2 * axis] = kind;
        box.side[2 * axis + 1] = kind == GasBoundary::open && axis == 0 ? GasBoundary::closed : kind;
      }
      GasGrid grid = make_gas_grid(box, 293.15f);
      fill_randomly(grid);
      Bench bench;
      bench.settings.projection.divergence = 1.0e-3f;
      const GasReport report = bench.settle(grid);
      EXPECT_LT(report.divergence, 1.5e-3f) << mix;
      EXPECT_GT(report.iterations, 0);
      EXPECT_LT(report.iterations, 40) << mix;
    }
  }
}

TEST(Projection, iterations_hardly_grow_with_the_number_of_cells) {
  int iterations[2];
  for (int level = 0; level < 2; ++level) {
    const int n = level == 0 ? 12 : 48;
    GasGrid grid = make_gas_grid(box_of(n, n, n, 0.1f, GasBoundary::closed), 293.15f);
    fill_randomly(grid);
    Bench bench;
    bench.settings.projection.divergence = 1.0f;
    bench.settings.projection.reduction = 1.0e-4f;
    iterations[level] = bench.settle(grid).iterations;
  }
  EXPECT_LE(iterations[1], iterations[0] + 2);
  EXPECT_LE(iterations[1], 8);
}

TEST(Projection, a_field_without_divergence_is_left_alone) {
  GasGrid grid =
      make_gas_grid(box_of(16, 16, 1, float(2.0 * 3.14159265358979 / 16), GasBoundary::closed), 293.15f);
  set_taylor_green(grid, 1.0, 1.0);
  GasGrid before = grid;
  Bench bench;
  bench.settle(grid);
  for_places(grid, 0, [&](int c, double x, double, double) {
    if (x > 0.1 && x < 6.2) {
      ASSERT_NEAR(grid.velocity[0][c], before.velocity[0][c], 1.0e-5f);
    }
  });
}

TEST(GasSolid, a_ball_that_moves_through_a_closed_box_leaves_no_divergence) {
  GasGrid grid = make_gas_grid(box_of(24, 16, 16, 0.1f, GasBoundary::closed), 293.15f);
  Bench bench;
  for (int i = 0; i < 10; ++i) {
    place_sphere(grid, {0.8f + 0.02f * float(i), 0.8f, 0.81f}, 0.33f, {1.2f, 0.0f, 0.0f}, bench.solids);
    const GasReport report = bench.step(grid, 1.0f / 60.0f);
    // The remainder of the fractions of faces is spread over all cells: 1e-3 of what the ball pushes.
    EXPECT_LT(report.divergence / 60.0f, 1.0e-3f);
    EXPECT_LT(report.iterations, 20);
  }
  // Gas gives way before the ball and comes back along its sides.
  EXPECT_GT(probe_gas(grid, {1.45, 0.8, 0.8}, 1.2f, {}).velocity.x, 0.3f);
  EXPECT_LT(probe_gas(grid, {1.0, 1.35, 0.8}, 1.2f, {}).velocity.x, -0.1f);
}

TEST(GasSolid, pressure_gives_an_accelerated_ball_its_added_mass) {
  // Impulse - m_added v with m_added = 2/3 pi r^3 density, in a wide box (H. Lamb, "Hydrodynamics", 1932, 92).
  GasGrid grid = make_gas_grid(box_of(40, 40, 40, 0.05f, GasBoundary::open), 293.15f);
  Bench bench;
  bench.settings.projection.reduction = 1.0e-4f;
  const float radius = 0.3f, speed = 0.2f;
  place_sphere(grid, {1.01f, 0.99f, 1.0f}, radius, {0.0f, speed, 0.0f}, bench.solids);
  GasImpulse impulse;
  bench.step(grid, 1.0f / 60.0f, {}, std::span(&impulse, 1));
  const double added = 2.0 / 3.0 * 3.14159265358979 * double(radius) * double(radius) * double(radius) * 1.2;
  EXPECT_NEAR(impulse.linear.y / (-added * double(speed)), 1.0, 0.1);
  EXPECT_NEAR(impulse.linear.x / (added * double(speed)), 0.0, 0.02);
  // Through the middle of the ball: no moment about it.
  const DVec3 about = impulse.angular - cross(DVec3{1.01, 0.99, 1.0}, impulse.linear);
  EXPECT_NEAR(length(about) / (added * double(speed) * double(radius)), 0.0, 0.02);
}

TEST(GasSolid, gas_enclosed_by_walls_that_close_in_does_not_disturb_the_rest) {
  // Cells 4 to 7 along each axis are behind closed faces, one of which moves inward.
  GasGrid grid = make_gas_grid(box_of(16, 16, 16, 0.1f, GasBoundary::open), 293.15f);
  Bench bench;
  clear_solids(grid.shape, 1, bench.solids);
  for (int axis = 0; axis < 3; ++axis) {
    for_places(grid, axis, [&](int c, double x, double y, double z) {
      const double point[3] = {x, y, z};
      bool beside = true, on = false;
      for (int other = 0; other < 3; ++other) {
        if (other != axis) beside = beside && point[other] > 0.4 && point[other] < 0.8;
      }
      on = std::fabs(point[axis] - 0.4) < 1.0e-6 || std::fabs(point[axis] - 0.8) < 1.0e-6;
      if (!beside || !on) return;
      bench.solids.open[axis][c] = 0.0f;
      bench.solids.label[axis][c] = 0;
      if (axis == 0 && x > 0.6) bench.solids.velocity[axis][c] = -0.5f;
    });
  }
  grid.velocity[1][grid.shape.at(12, 12, 12)] = 1.0f;
  for (int i = 0; i < 3; ++i) {
    const GasReport report = bench.step(grid, 1.0f / 60.0f);
    EXPECT_LT(report.iterations, 30);
  }
  ASSERT_TRUE(bench.memory.matrix.has_pockets);
  // The inflow, 0.5 m/s over four cells, remains, the same in every cell of the pocket; outside there is nothing.
  EXPECT_NEAR(double(largest_divergence(
                  {grid, bench.solids, bench.memory, *bench.kernels, bench.tasks, 1.0f / 60.0f})),
              0.5 / 0.4, 0.02);
  const float before = grid.velocity[0][grid.shape.at(9, 6, 6)];
  EXPECT_LT(before, -0.05f);  // gas follows behind the wall
  EXPECT_GT(before, -0.5f);
}

TEST(GasSolid, a_ball_at_rest_in_gas_at_rest_changes_nothing) {
  GasGrid grid = make_gas_grid(box_of(16, 16, 16, 0.1f, GasBoundary::open), 293.15f);
  Bench bench;
  place_sphere(grid, {0.8f, 0.75f, 0.83f}, 0.3f, {}, bench.solids);
  GasImpulse impulse;
  for (int i = 0; i < 3; ++i) bench.step(grid, 1.0f / 60.0f, {}, std::span(&impulse, 1));
  for (int axis = 0; axis < 3; ++axis) {
    for_places(grid, axis, [&](int c, double, double, double) { ASSERT_EQ(grid.velocity[axis][c], 0.0f); });
  }
  EXPECT_EQ(impulse.linear, DVec3{});
}

}  // namespace
}  // namespace gyre::projection_test
