// Liquids in a world: laws that hold for every cell size, and that they are part of the world's state.
#include "determinism/scenes.h"
#include "memory_sink.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gyre::liquid_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

World make_world(int threads = 1, int width = 0) {
  WorldDef def;
  def.threads = threads;
  def.simd_width = width;
  return std::move(*World::create(def));
}

void step(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kStep);
}

LiquidDef tank(DVec3 size, double depth, float cell) {
  LiquidDef def;
  def.lower = {}, def.upper = size;
  def.cell_size = cell;
  def.fill = {{{}, {size.x, depth, size.z}}};
  return def;
}

BodyId add_box(World& world, DVec3 at, Vec3 half, float density, BodyType type = BodyType::dynamic) {
  BodyDef body;
  body.type = type;
  body.pose.position = at;
  return world.add_body(body, ShapeDef{.geometry = Box{half}, .density = density});
}

World busy_world(int threads, int width) {
  World world = make_world(threads, width);
  scenes::add_fixed(world, {0, 0, 0}, Plane{});
  add_box(world, {0.7, 0.3, 0.3}, {0.1f, 0.1f, 0.1f}, 300.0f);
  LiquidDef def = tank({1, 0.8, 0.6}, 0.4, 0.05f);
  def.fill = {{{0, 0, 0}, {0.4, 0.5, 0.6}}};
  world.add_liquid(def);
  return world;
}

TEST(Liquid, ATankAtRestStaysAtRest) {
  World world = make_world();
  const FluidId pool = world.add_liquid(tank({1, 1, 0.5}, 0.6, 0.05f));
  ASSERT_TRUE(pool);
  const double volume = world.fluid_info(pool).volume;
  EXPECT_NEAR(volume, 0.3, 0.003);
  step(world, 120);
  EXPECT_NEAR(world.fluid_info(pool).volume, volume, 0.001 * volume);
  const double energy = world.fluid_info(pool).kinetic_energy;
  EXPECT_LT(energy, 0.5 * 300.0 * 1.0e-6 * 9.81);  // a thousandth of sqrt(g H), squared
  for (const double depth : {0.1, 0.3, 0.5}) {
    const FluidProbe probe = world.probe(pool, {0.5, 0.6 - depth, 0.25});
    EXPECT_NEAR(probe.pressure, 1000.0 * 9.81 * depth, 0.01 * 1000.0 * 9.81 * 0.6) << depth;
    EXPECT_EQ(probe.density, 1.0f);
    EXPECT_NEAR(probe.surface, 0.6f, 0.005f);
  }
  EXPECT_EQ(world.probe(pool, {0.5, 0.8, 0.25}).density, 0.0f);
}

// Archimedes: a box floats with the share of its height in the liquid that its density has of the liquid's.
TEST(Liquid, ABoxFloatsAsDeepAsItsDensitySays) {
  for (const float ratio : {0.1f, 0.7f}) {
    World world = make_world();
    scenes::add_fixed(world, {0, 0, 0}, Plane{});
    constexpr float kHeight = 0.2f;
    const double y = 0.4 + double(kHeight) * (0.5 - double(ratio));
    // Flat enough to stand upright at every density.
    const BodyId box = add_box(world, {0.4, y, 0.4}, {0.2f, 0.5f * kHeight, 0.2f}, 1000.0f * ratio);
    const FluidId pool = world.add_liquid(tank({0.8, 0.6, 0.8}, 0.4, 0.05f));
    step(world, 90);
    double mean = 0.0;
    for (int i = 0; i < 60; ++i) {
      world.step(kStep);
      mean += world.pose(box).position.y / 60.0;
    }
    const double level = double(world.probe(pool, {0.1, 0.3, 0.1}).surface);
    const double draft = level - (mean - 0.5 * double(kHeight));
    EXPECT_NEAR(draft, double(ratio * kHeight), 0.05 * double(kHeight)) << ratio;
  }
}

// Liquid gets beneath a box on the ground, so that the liquid above does not hold it down.
TEST(Liquid, ALightBoxOnTheGroundRises) {
  for (const float density : {50.0f, 700.0f}) {
    World world = make_world();
    scenes::add_fixed(world, {0, 0, 0}, Plane{});
    const BodyId box = add_box(world, {0.42, 0.1, 0.38}, {0.1f, 0.1f, 0.1f}, density);
    const BodyId stone = add_box(world, {0.7, 0.1, 0.7}, {0.1f, 0.1f, 0.1f}, 2000.0f);
    world.add_liquid(tank({0.9, 0.7, 0.9}, 0.5, 0.05f));
    step(world, 120);
    EXPECT_GT(world.pose(box).position.y, 0.35) << density;
    EXPECT_LT(world.pose(box).position.y, 0.7) << density;
    EXPECT_NEAR(world.pose(stone).position.y, 0.1, 0.005) << density;
  }
}

TEST(Liquid, AHeavyBoxSinksAndALightOneIsThrownNowhere) {
  World world = make_world();
  scenes::add_fixed(world, {0, 0, 0}, Plane{});
  const BodyId lead = add_box(world, {0.25, 0.5, 0.25}, {0.1f, 0.1f, 0.1f}, 5000.0f);
  const BodyId foam = add_box(world, {0.75, 0.25, 0.25}, {0.1f, 0.1f, 0.1f}, 20.0f);
  world.add_liquid(tank({1, 1, 0.5}, 0.6, 0.05f));
  double highest = 0.0;
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    highest = std::fmax(highest, world.pose(foam).position.y);
  }
  EXPECT_NEAR(world.pose(lead).position.y, 0.1, 0.01);
  EXPECT_GT(world.pose(foam).position.y, 0.6);
  // Its lift over 0.35 m becomes motion of the foam and of half as much liquid as it displaces, and then height above the surface.
  const double square = 2.0 * 9.81 * 0.35 / (0.02 + 0.5);
  EXPECT_LT(highest, 0.7 + square / (2.0 * 9.81));
}

TEST(Liquid, IsTheSameForThreadsAndWidths) {
  World one = busy_world(1, 0);
  step(one, 30);
  for (const int threads : {2, 8}) {
    World other = busy_world(threads, 0);
    step(other, 30);
    EXPECT_EQ(one.hash(), other.hash()) << threads;
  }
  for (const int width : {1, 4, 8}) {
    World other = busy_world(1, width);
    step(other, 30);
    EXPECT_EQ(one.hash(), other.hash()) << width;
  }
}

TEST(Liquid, ASnapshotGoesOnToTheBit) {
  World world = busy_world(1, 0);
  step(world, 20);
  const std::vector<std::byte> saved = save_snapshot(world);
  Result<World> loaded = load_snapshot(saved);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->hash(), world.hash());
  step(world, 20), step(*loaded, 20);
  EXPECT_EQ(loaded->hash(), world.hash());
  ASSERT_FALSE(restore_snapshot(world, saved));
  step(world, 20);
  EXPECT_EQ(loaded->hash(), world.hash());
}

TEST(Liquid, ARecordingPlaysToTheSameBits) {
  MemorySink sink;
  World world = make_world();
  Recorder recorder(world, sink);
  add_box(world, {0.7, 0.3, 0.3}, {0.1f, 0.1f, 0.1f}, 300.0f);
  LiquidDef def = tank({1, 0.8, 0.6}, 0.2, 0.05f);
  def.emitters = {{.position = {0.2, 0.6, 0.3}, .radius = 0.1f, .velocity = Vec3{1, 0, 0}, .end = 0.2}};
  const FluidId pool = world.add_liquid(def);
  step(world, 20);
  const int before = world.fluid_info(pool).particles;
  EXPECT_GT(before, 0);
  ASSERT_TRUE(recorder.finish());
  Result<Replay> replay = Replay::open(sink.bytes);
  ASSERT_TRUE(replay);
  bool matches = true;
  for (bool good = true; replay->step(&good);) matches = matches && good;
  EXPECT_TRUE(matches);
  EXPECT_EQ(replay->world().hash(), world.hash());
}

TEST(Liquid, ADefinitionGoesOnAsItIs) {
  World world = make_world();
  // The box is no whole number of cells, so it is widened, and the liquid gets there.
  LiquidDef def = tank({1.01, 0.6, 0.32}, 0.3, 0.05f);
  def.fill = {{{0.6, 0, 0}, {1.05, 0.3, 0.35}}};
  const FluidId pool = world.add_liquid(def);
  step(world, 10);
  World other = make_world();
  const FluidId copy = other.add_liquid(world.liquid_def(pool));
  ASSERT_TRUE(copy);
  EXPECT_EQ(other.fluid_info(copy).particles, world.fluid_info(pool).particles);
  step(world, 5), step(other, 5);
  EXPECT_NEAR(world.fluid_info(pool).kinetic_energy, other.fluid_info(copy).kinetic_energy,
              0.02 * world.fluid_info(pool).kinetic_energy);
}

TEST(Liquid, ItsSurfaceIsClosedAndAsLargeAsItsVolume) {
  World world = make_world();
  const FluidId pool = world.add_liquid(tank({1, 1, 0.5}, 0.4, 0.05f));
  const FluidSurfaceSize size = world.liquid_surface(pool, {}, {});
  ASSERT_GT(size.indices, 0u);
  std::vector<Vec3> vertices(size.vertices);
  std::vector<std::uint32_t> indices(size.indices);
  world.liquid_surface(pool, vertices, indices);
  double volume = 0.0;
  for (std::size_t t = 0; t + 2 < indices.size(); t += 3) {
    const DVec3 a(vertices[indices[t]]), b(vertices[indices[t + 1]]), c(vertices[indices[t + 2]]);
    volume += dot(a, cross(b, c)) / 6.0;
  }
  EXPECT_NEAR(volume, 0.2, 0.02);
}

TEST(Liquid, WhatIsOutOfRangeIsRefusedInWords) {
  World world = make_world();
  const auto refused = [&](const LiquidDef& def, const char* words) {
    world.step(kStep);
    EXPECT_FALSE(world.add_liquid(def)) << words;
    ASSERT_FALSE(world.problems().empty());
    EXPECT_NE(std::string(world.problems().back().message).find(words), std::string::npos)
        << world.problems().back().message;
  };
  LiquidDef def;
  def.cell_size = 1.0e-5f;
  refused(def, "at most 16777216 cells");
  def = tank({1, 1, 1}, 1.0, 0.01f);
  refused(def, "particles");
  def = {};
  def.cell_size = 0.0f;
  refused(def, "cell_size");
  def = {};
  def.fill = {{{0, 1, 0}, {1, 0, 1}}};
  refused(def, "fill[0]");
  def = {};
  def.particles = LiquidParticles{.positions = {{0.5, 0.5, 5.0}}, .velocities = {{}}};
  refused(def, "particles.positions[0]");
}

TEST(Liquid, GetsTheMomentumThatItsDragTakesFromACloth) {
  WorldDef world_def;
  world_def.gravity = {};
  World world = std::move(*World::create(world_def));
  LiquidDef def = tank({1.2, 1.2, 1.2}, 1.2, 0.06f);
  def.sides.fill(FluidBoundary::periodic);
  const FluidId pool = world.add_liquid(def);
  ClothDef cloth{.grid = ClothGrid{{0.4f, 0.4f}, {8, 8}}, .area_density = 20.0f};
  cloth.pose.position = {0.6, 0.4, 0.6};
  cloth.settings.velocities.assign(81, Vec3{0, 1, 0});
  const SoftId sail = world.add_cloth(cloth);
  ASSERT_TRUE(pool && sail);
  const auto momentum_of_cloth = [&] {
    const SoftVertices v = world.vertices(sail);
    double sum = 0.0;
    for (std::size_t i = 0; i < v.size(); ++i) sum += double(v.vy[i]);
    return sum;
  };
  const double all = world.momentum().linear.y, cloth_before = momentum_of_cloth();
  step(world, 30);
  EXPECT_LT(momentum_of_cloth(), 0.7 * cloth_before);
  EXPECT_NEAR(world.momentum().linear.y, all, 0.03 * all);
}

// 4.8 m are 80 cells of 6 cm, though the float nearest to 0.06 is a little less.
TEST(Liquid, ABoxOfWholeCellsIsNotWidened) {
  World world = make_world();
  const FluidId pool = world.add_liquid(tank({4.8, 0.6, 0.3}, 0.3, 0.06f));
  EXPECT_EQ(world.fluid_info(pool).cells, (std::array<int, 3>{80, 10, 5}));
}

// Waves of cells of 0.2 mm need steps of 0.1 ms. A step that cannot be divided so often has less tension instead of an explosion.
TEST(Liquid, TensionOfSmallCellsStaysStableInLongSteps) {
  World world = make_world();
  LiquidDef def = tank({0.0033, 0.0025, 0.0033}, 0.0006, 2.08e-4f);
  def.surface_tension = 0.07f;
  def.initial_velocity = {0.1f, 0, 0};
  const FluidId pool = world.add_liquid(def);
  const double volume = world.fluid_info(pool).volume;
  step(world, 10);
  std::vector<Vec3> velocities(std::size_t(world.fluid_info(pool).particles));
  world.liquid_particles(pool, {}, velocities);
  float fastest = 0.0f;
  for (const Vec3 one : velocities) fastest = std::fmax(fastest, length(one));
  EXPECT_LT(fastest, 0.5f);
  EXPECT_NEAR(world.fluid_info(pool).volume / volume, 1.0, 0.05);
}

}  // namespace
}  // namespace gyre::liquid_test
