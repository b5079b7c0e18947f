// Bodies in liquids: floats, sinking bodies, walls that move.
#include "fluid/liquid/liquid_test_kit.h"

#include <gtest/gtest.h>

namespace gyre::liquid_body_test {
namespace {

using namespace liquid_test;

// A box in the plane that moves by the impulses of the liquid and by gravity.
struct Float {
  Vec3 center, half;
  float density = 500.0f, depth = 1.0f;  // depth: along z
  Vec3 velocity{};
  float angle = 0.0f, spin = 0.0f, gravity = -9.81f;

  float mass() const { return density * 4.0f * half.x * half.y * depth; }
  float inertia() const { return mass() / 3.0f * (half.x * half.x + half.y * half.y); }
  FluidBody body() const {
    FluidBody body;
    body.inverse_mass = 1.0f / mass();
    body.volume = mass() / density;
    body.inverse_inertia = {0, 0, 1.0f / inertia(), 0, 0, 0};
    body.center = {double(center.x), double(center.y), double(center.z)};
    body.velocity = velocity;
    body.angular_velocity = {0, 0, spin};
    body.acceleration = {0, gravity, 0};
    return body;
  }
  void advance(const GasImpulse& impulse, float step) {
    const DVec3 at{double(center.x), double(center.y), double(center.z)};
    velocity += to_float((1.0 / double(mass())) * impulse.linear) + step * Vec3{0, gravity, 0};
    velocity.z = 0.0f;
    spin += float((impulse.angular - cross(at, impulse.linear)).z) / inertia();
    center += step * velocity;
    angle += step * spin;
  }
};

LiquidReport step_with(Float& block, LiquidGrid& grid, Bench& bench, float step = 1.0f / 60.0f) {
  clear_solids(grid.shape, 1, bench.solids);
  place_solid(
      grid, 0, bench.solids, [&](Vec3 p) { return box_distance(p, block.center, block.half, block.angle); },
      [&](Vec3 p) {
        return block.velocity + cross(Vec3{0, 0, block.spin}, p - block.center);
      });
  const FluidBody body = block.body();
  bench.bodies = std::span(&body, 1);
  GasImpulse impulse;
  const LiquidReport report = bench.step(grid, step, {}, std::span(&impulse, 1));
  block.advance(impulse, step);
  bench.bodies = {};
  return report;
}

// A block in a tank of this size in cells, eight cells wide, its lower side `draft` of its height below the level.
Float place_block(LiquidGrid& grid, Bench& bench, float ratio, float height, float level, float draft) {
  const float h = grid.box.cell.x;
  Float block;
  block.half = {4.0f * h, 0.5f * height, 1.0f};
  block.density = 1000.0f * ratio;
  block.depth = h;
  block.center = {0.5f * float(grid.box.cells[0]) * h + 0.1f * h, level + block.half.y - draft * height,
                  0.5f * h};
  clear_solids(grid.shape, 1, bench.solids);
  place_solid(
      grid, 0, bench.solids, [&](Vec3 p) { return box_distance(p, block.center, block.half); },
      [](Vec3) { return Vec3{}; });
  fill_liquid_box(grid, {0, 0, 0}, {10, double(level), 1}, {}, bench.solids);
  return block;
}

TEST(LiquidBody, a_float_has_the_draft_of_archimedes) {
  const float h = 1.0f / 32.0f;
  const float cases[][2] = {
      {0.05f, 8.0f}, {0.2f, 4.0f}, {0.5f, 4.0f}, {0.8f, 8.0f}};  // density ratio, height in cells
  for (const auto& one : cases) {
    const float ratio = one[0], height = one[1] * h;
    LiquidGrid grid = make_liquid_grid(box_of(32, 26, 1, h, GasBoundary::closed));
    Bench bench;
    // A fifth of a cell too high.
    Float block = place_block(grid, bench, ratio, height, 0.4f, ratio - 0.2f * h / height);
    double draft = 0.0;
    for (int i = 0; i < 150; ++i) {
      step_with(block, grid, bench);
      if (i < 30) continue;
      const double surface = 0.5 * (probe_liquid(grid, {0.1, 0, 0}, 1000.0f).surface +
                                    probe_liquid(grid, {0.9, 0, 0}, 1000.0f).surface);
      draft += (surface - double(block.center.y - block.half.y)) / double(height) / 120.0;
    }
    EXPECT_NEAR(draft, double(ratio), 0.05) << ratio;
  }
}

TEST(LiquidBody, a_body_as_heavy_as_the_liquid_stays_where_it_is) {
  const float h = 1.0f / 32.0f;
  LiquidGrid grid = make_liquid_grid(box_of(24, 32, 1, h, GasBoundary::closed));
  Bench bench;
  Float block = place_block(grid, bench, 1.0f, 8.0f * h, 0.8f, 1.63f);
  const Vec3 before = block.center;
  for (int i = 0; i < 60; ++i) step_with(block, grid, bench);
  EXPECT_LT(distance(block.center, before), 0.2f * h);
  EXPECT_LT(length(block.velocity), 0.02f);
  EXPECT_NEAR(block.angle, 0.0f, 0.05f);
}

TEST(LiquidBody, a_heavy_body_sinks_with_its_added_mass) {
  // (M - m) g = (M + added) a with the added mass of a square, 1.51 pi/4 of its area (W. Newman, "Marine Hydrodynamics", 1977), more between
  // walls.
  const float h = 1.0f / 32.0f;
  LiquidGrid grid = make_liquid_grid(box_of(64, 48, 1, h, GasBoundary::closed));
  Bench bench;
  Float block = place_block(grid, bench, 3.0f, 8.0f * h, 1.2f, 2.5f);
  for (int i = 0; i < 4; ++i) step_with(block, grid, bench);
  EXPECT_NEAR(block.velocity.y, -9.81f * 4.0f / 60.0f * 2.0f / (3.0f + 1.19f), 0.12f * 0.31f);
}

TEST(LiquidBody, body_and_liquid_together_keep_their_momentum) {
  // Without gravity a block runs into a ball of liquid that rests in the air.
  const float h = 1.0f / 32.0f;
  LiquidGrid grid = make_liquid_grid(box_of(64, 40, 1, h, GasBoundary::closed));
  Bench bench;
  bench.settings.gravity = {};
  Float block;
  block.half = {3.0f * h, 6.0f * h, 1.0f};
  block.density = 700.0f;
  block.depth = h;
  block.center = {12.0f * h, 20.3f * h, 0.5f * h};
  block.velocity = {1.0f, 0, 0};
  block.gravity = 0.0f;
  fill_liquid_ball(grid, {26.0 * double(h), 20.0 * double(h), 0}, 10.0f * h, {}, bench.solids);
  const double before = double(block.mass() * block.velocity.x);
  for (int i = 0; i < 30; ++i) step_with(block, grid, bench);
  const double exchanged = before - double(block.mass() * block.velocity.x);
  EXPECT_GT(exchanged, 0.3 * before);
  EXPECT_NEAR(liquid_totals(grid, 1000.0f, {}).momentum.x, exchanged, 0.09 * exchanged);
}

TEST(LiquidBody, a_wall_one_cell_thick_that_moves_lets_nothing_through) {
  for (const float speed : {0.5f, 1.0f, 2.0f}) {  // cells a step
    const float h = 1.0f / 32.0f;
    LiquidGrid grid = make_liquid_grid(box_of(48, 24, 1, h, GasBoundary::closed));
    Bench bench;
    fill_liquid_box(grid, {8.0 * double(h), 0, 0}, {24.0 * double(h), 0.4, 1}, {}, bench.solids);
    float x = 7.4f * h;
    const float velocity = speed * h * 60.0f;
    int most = 0;
    for (int i = 0; i < int(20.0f / speed); ++i) {
      clear_solids(grid.shape, 1, bench.solids);
      place_solid(
          grid, 0, bench.solids,
          [&](Vec3 p) {
            return box_distance(p, {x, 0.3f, 0.5f * h}, {0.5f * h, 2.0f, 1.0f});
          },
          [&](Vec3) {
            return Vec3{velocity, 0, 0};
          });
      FluidBody body;
      body.center = {double(x), 0.3, 0.0};
      body.velocity = {velocity, 0, 0};
      bench.bodies = std::span(&body, 1);
      bench.step(grid);
      bench.bodies = {};
      x += velocity / 60.0f;
      int behind = 0;
      for (int p = 0; p < grid.particles(); ++p) behind += grid.position[0][p] < x ? 1 : 0;
      most = behind > most ? behind : most;
    }
    EXPECT_EQ(most, 0) << speed << " of " << grid.particles();
  }
}

}  // namespace
}  // namespace gyre::liquid_body_test
