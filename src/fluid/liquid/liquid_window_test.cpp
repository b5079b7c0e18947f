// Windows of liquids: the size of the box, a memory from step to step and the places of windows do not show.
#include "fluid/liquid/liquid_fields.h"
#include "fluid/liquid/liquid_test_kit.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::liquid_window_test {
namespace {

using namespace liquid_test;

bool same_bits(const Array<float>& a, const Array<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}
bool same_particles(const LiquidGrid& a, const LiquidGrid& b) {
  bool same = true;
  for (int axis = 0; axis < 3; ++axis)
    same = same && same_bits(a.position[axis], b.position[axis]) && same_bits(a.motion[axis], b.motion[axis]);
  for (int i = 0; i < 9; ++i) same = same && same_bits(a.affine[i], b.affine[i]);
  return same;
}

// A ball of liquid in the air.
LiquidGrid ball(int cells, Vec3 velocity) {
  LiquidGrid grid = make_liquid_grid(box_of(cells, cells, cells, 0.1f, GasBoundary::closed));
  fill_liquid_ball(grid, {2.0, 2.0, 2.0}, 0.35f, velocity, {});
  return grid;
}

TEST(LiquidWindow, has_the_tiles_around_the_particles) {
  const GasBox box = box_of(64, 32, 5, 0.1f, GasBoundary::closed);
  CellBox cells{{20, 3, 1}, {22, 10, 2}};
  const FluidWindow window = window_around(box, with_margin(box, cells));
  const int first[3] = {8, 0, 0}, count[3] = {24, 24, 5};
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_EQ(window.first[axis], first[axis]);
    EXPECT_EQ(window.box.cells[axis], count[axis]);
  }
  EXPECT_TRUE(window.box.open(0) && window.box.open(1) && window.box.open(3));
  EXPECT_FALSE(window.box.open(2) || window.box.open(4) || window.box.open(5));
  EXPECT_TRUE(window.cells().contains(cells));
}

TEST(LiquidWindow, the_size_of_the_box_does_not_show) {
  LiquidGrid small = ball(40, {0.5f, 1.0f, -0.3f}), large = ball(72, {0.5f, 1.0f, -0.3f});
  Bench of_small, of_large;
  for (int i = 0; i < 12; ++i) {
    of_small.step(small);
    of_large.step(large);
    ASSERT_TRUE(same_particles(small, large)) << i;
  }
  EXPECT_LE(of_large.memory.window.box.cells[0], 32);
  EXPECT_NEAR(liquid_volume(large, {}), liquid_volume(small, {}), 1e-12);
}

TEST(LiquidWindow, a_new_memory_in_each_step_does_not_show) {
  // Ten cells a step: windows move within steps too, and the ball breaks at a wall.
  LiquidGrid kept = ball(64, {60.0f, -20.0f, 0.0f}), renewed = kept;
  Bench bench;
  int first = -1, moves = 0;
  for (int i = 0; i < 12; ++i) {
    bench.step(kept);
    Bench fresh;
    fresh.time = bench.time;
    fresh.step(renewed);
    ASSERT_TRUE(same_particles(kept, renewed)) << i;
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_TRUE(same_bits(kept.velocity[axis], renewed.velocity[axis])) << i;
    ASSERT_TRUE(same_bits(kept.surface, renewed.surface) && same_bits(kept.pressure, renewed.pressure)) << i;
    moves += bench.memory.window.first[0] != first ? 1 : 0;
    first = bench.memory.window.first[0];
  }
  EXPECT_GE(moves, 4);
}

TEST(LiquidWindow, fields_beyond_it_are_those_of_air) {
  LiquidGrid grid = ball(64, {40.0f, 0.0f, 0.0f});
  Bench bench;
  for (int i = 0; i < 6; ++i) bench.step(grid);
  const CellBox window = bench.memory.window.cells();
  for (int k = 0; k < 64; ++k) {
    for (int j = 0; j < 64; ++j) {
      for (int i = 0; i < 64; ++i) {
        if (window.contains({{i, j, k}, {i + 1, j + 1, k + 1}})) continue;
        const int c = grid.shape.at(i, j, k);
        ASSERT_EQ(grid.surface[c], 0.1f);
        ASSERT_EQ(grid.pressure[c], 0.0f);
        for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(grid.velocity[axis][c], 0.0f);
      }
    }
  }
}

TEST(LiquidWindow, a_box_without_liquid_has_one) {
  LiquidGrid grid = make_liquid_grid(box_of(64, 64, 64, 0.1f, GasBoundary::closed));
  Bench bench;
  bench.step(grid);
  EXPECT_EQ(bench.memory.window.shape.count(), 512);
  EXPECT_EQ(liquid_volume(grid, {}), 0.0);
  // A source in the middle fills it.
  const LiquidEmitter source{.position = grid.box.corner + DVec3{3.2, 3.2, 3.2}, .radius = 0.25f};
  bench.step(grid, 1.0f / 60.0f, std::span(&source, 1));
  EXPECT_GT(grid.particles(), 400);
}

}  // namespace
}  // namespace gyre::liquid_window_test
