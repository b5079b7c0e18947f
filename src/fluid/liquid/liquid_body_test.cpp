// Bodies in liquids: floats, sinking bodies, walls that move.
#include "fluid/liquid/liquid_test_kit.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace gyre {
namespace {

using namespace liquid_test;

// A box in the plane that moves by the impulses of the liquid and by gravity.
struct Float {
  Vec3 center, half;
  float density = 500.0f, depth = 1.0f;  // depth: along z
  Vec3 velocity{};
  float angle = 0.0f, spin = 0.0f;

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
    body.acceleration = {0, -9.81f, 0};
    return body;
  }
  void advance(const GasImpulse& impulse, float step) {
    const DVec3 at{double(center.x), double(center.y), double(center.z)};
    velocity += to_float((1.0 / double(mass())) * impulse.linear) + step * Vec3{0, -9.81f, 0};
    velocity.z = 0.0f;
    spin += float((impulse.angular - cross(at, impulse.linear)).z) / inertia();
    center += step * velocity;
    angle += step * spin;
  }
};

LiquidReport step_with(Float& block, LiquidGrid& grid, Bench& bench, float step = 1.0f / 60.0f) {
  clear_solids(grid.shape, 1, bench.solids);
  bench.solids.distance.clear();
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

TEST(LiquidBody, a_float_has_the_draft_of_archimedes) {
  for (const float ratio : {0.05f, 0.2f, 0.5f, 0.8f}) {
    const float h = 1.0f / 32.0f;
    LiquidGrid grid = make_liquid_grid(box_of(40, 40, 1, h, GasBoundary::closed));
    Bench bench;
    // Eight cells wide and high; at half its draft, so that it falls and rises.
    Float block;
    block.half = {4.0f * h, (ratio == 0.05f || ratio == 0.8f ? 4.0f : 2.0f) * h, 1.0f};
    block.density = 1000.0f * ratio;
    block.depth = h;
    const float height = 2.0f * block.half.y, level = 0.6f;
    block.center = {20.0f * h + 0.003f, level + block.half.y - ratio * height + 0.3f * h, 0.5f * h};
    clear_solids(grid.shape, 1, bench.solids);
    bench.solids.distance.clear();
    place_solid(
        grid, 0, bench.solids, [&](Vec3 p) { return box_distance(p, block.center, block.half); },
        [&](Vec3) { return Vec3{}; });
    fill_liquid_box(grid, {0, 0, 0}, {2, double(level), 1}, {}, bench.solids);
    LiquidReport report;
    double draft = 0.0;
    for (int i = 0; i < 480; ++i) {
      report = step_with(block, grid, bench);
      if (i >= 240) {
        const double surface = 0.5 * (probe_liquid(grid, {0.1, 0, 0}, 1000.0f).surface +
                                      probe_liquid(grid, {1.15, 0, 0}, 1000.0f).surface);
        draft += (surface - double(block.center.y - block.half.y)) / double(height) / 240.0;
      }
      if (i % 60 == 0) {
        const double surface = probe_liquid(grid, {0.1, 0, 0}, 1000.0f).surface;
        std::printf("%g: %d y %.4f v %.4f draft %.4f surface %.4f angle %.3f its %d vol %.5f\n",
                    double(ratio), i, double(block.center.y), double(block.velocity.y),
                    (surface - double(block.center.y - block.half.y)) / double(height), surface,
                    double(block.angle), report.iterations, report.volume);
      }
    }
    EXPECT_NEAR(draft, double(ratio), 0.03);
  }
}

TEST(LiquidBody, neutral_and_heavy) {
  for (const float ratio : {1.0f, 1.5f, 5.0f}) {
    const float h = 1.0f / 32.0f;
    LiquidGrid grid = make_liquid_grid(box_of(32, 64, 1, h, GasBoundary::closed));
    Bench bench;
    Float block;
    block.half = {4.0f * h, 4.0f * h, 1.0f};
    block.density = 1000.0f * ratio;
    block.depth = h;
    block.center = {16.0f * h + 0.003f, 1.0f + 0.37f * h, 0.5f * h};
    clear_solids(grid.shape, 1, bench.solids);
    bench.solids.distance.clear();
    place_solid(
        grid, 0, bench.solids, [&](Vec3 p) { return box_distance(p, block.center, block.half); },
        [&](Vec3) { return Vec3{}; });
    fill_liquid_box(grid, {0, 0, 0}, {2, 1.75, 1}, {}, bench.solids);
    for (int i = 0; i < (ratio == 1.0f ? 600 : 40); ++i) {
      step_with(block, grid, bench);
      if (i % 60 == 0 || (ratio > 1 && i % 5 == 0))
        std::printf("%g: %d y %.4f v %.4f x %.4f angle %.3f\n", double(ratio), i, double(block.center.y),
                    double(block.velocity.y), double(block.center.x), double(block.angle));
    }
  }
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
      bench.solids.distance.clear();
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
}  // namespace gyre
