// Gases with an adaptive domain in a world: they cost what moves, and they are state as other gases are.
#include "determinism/scenes.h"
#include "memory_sink.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>

namespace gyre::adaptive_domain_test {
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

int active_cells(const World& world, FluidId gas) {
  const FluidInfo info = world.fluid_info(gas);
  return info.active_cells[0] * info.active_cells[1] * info.active_cells[2];
}

// A warm puff in the lower corner of a box of cells of 1/32 m.
GasDef puff_in(int cells, bool adapts) {
  GasDef def;
  def.lower = {}, def.upper = (double(cells) / 32) * DVec3{1, 1, 1};
  def.cells = {cells, cells, cells};
  def.emitters = {{.position = {0.25, 0.25, 0.25}, .radius = 0.1f, .temperature = 340.0f, .end = 0.05}};
  if (adapts) def.adaptive_domain.emplace();
  return def;
}

TEST(AdaptiveDomain, APuffInALargeBoxCostsWhatItCostsInASmallOne) {
  World world = make_world();
  const FluidId gas = world.add_gas(puff_in(128, true));
  ASSERT_TRUE(gas);
  EXPECT_EQ(active_cells(world, gas), 8 * 8 * 8);
  for (int i = 0; i < 45; ++i) {
    step(world, 1);
    EXPECT_LE(active_cells(world, gas), 2 * 32 * 32 * 32);
  }
  World small = make_world();
  const FluidId all = small.add_gas(puff_in(32, false));
  step(small, 45);
  EXPECT_EQ(active_cells(small, all), 32 * 32 * 32);
  const FluidProbe a = world.probe(gas, {0.25, 0.4, 0.25}), b = small.probe(all, {0.25, 0.4, 0.25});
  EXPECT_GT(b.velocity.y, 0.1f);
  EXPECT_NEAR(a.velocity.y, b.velocity.y, 0.01f * b.velocity.y);
  EXPECT_NEAR(a.density, b.density, 0.02f * b.density);
}

TEST(AdaptiveDomain, BeyondItTheAirIsAtRest) {
  World world = make_world();
  const FluidId gas = world.add_gas(puff_in(64, true));
  step(world, 10);
  const FluidInfo info = world.fluid_info(gas);
  EXPECT_EQ(info.cells, (std::array<int, 3>{64, 64, 64}));
  EXPECT_LT(info.active_cells[0], 48);
  const FluidProbe probe = world.probe(gas, {1.9, 1.9, 1.9});
  EXPECT_EQ(probe.velocity, Vec3{});
  EXPECT_EQ(probe.density, 0.0f);
  EXPECT_EQ(probe.temperature, 293.15f);
  std::vector<float> field(64 * 64 * 64 + 1, -1.0f);
  EXPECT_EQ(world.fluid_field(gas, FluidField::temperature, field), 64u * 64u * 64u);
  EXPECT_EQ(field[64 * 64 * 64 - 1], 293.15f);
  EXPECT_EQ(field[64 * 64 * 64], -1.0f);
  EXPECT_GT(field[8 + 64 * (8 + 64 * 8)], 300.0f);
  const GasFields fields = *world.gas_def(gas).fields;
  EXPECT_EQ(fields.temperature, std::vector<float>(field.begin(), field.end() - 1));
  EXPECT_EQ(fields.velocity_x.size(), 65u * 64u * 64u);
}

TEST(AdaptiveDomain, AClosedRoomKeepsItsSmoke) {
  GasDef def = puff_in(64, true);
  def.sides.fill(FluidBoundary::closed);
  World world = make_world();
  const FluidId gas = world.add_gas(def);
  step(world, 5);
  const double before = world.fluid_info(gas).smoke_mass;
  step(world, 90);
  EXPECT_NEAR(world.fluid_info(gas).smoke_mass, before, 5.0e-6 * before);
}

// A puff that burns, a fan that turns far from it, a light ball and a cloth.
World busy_world(int threads = 1, int width = 0) {
  World world = make_world(threads, width);
  GasDef def = puff_in(64, true);
  def.vorticity = 0.2f;
  def.combustion = Combustion{.ignition_temperature = 330.0f, .smoke_yield = 2.0f};
  def.emitters[0].fuel = 0.004f;
  world.add_gas(def);
  scenes::add_fixed(world, {0, 0, 0}, Plane{});
  const BodyId fan = world.add_body({.type = BodyType::kinematic, .pose = {{1.0, 0.4, 0.4}}},
                                    {.geometry = Box{{0.2f, 0.15f, 0.05f}}});
  world.set_velocity(fan, {}, {0, 5, 0});
  world.add_body({.pose = {{0.6, 1.0, 0.5}}}, {.geometry = Sphere{0.1f}, .density = 3.0f});
  world.add_cloth({.grid = ClothGrid{{0.3f, 0.3f}, {6, 6}}, .pose = {{0.5, 0.5, 1.0}}});
  return world;
}

TEST(AdaptiveDomain, IsTheSameForThreadsAndWidths) {
  World one = busy_world();
  step(one, 20);
  for (const int threads : {2, 3, 8}) {
    World other = busy_world(threads);
    step(other, 20);
    EXPECT_EQ(one.hash(), other.hash()) << threads;
  }
  for (const int width : {1, 4, 8, 16}) {
    World other = busy_world(1, width);
    step(other, 20);
    EXPECT_EQ(one.hash(), other.hash()) << width;
  }
}

TEST(AdaptiveDomain, SnapshotsClonesAndRecordingsGoOnToTheBit) {
  MemorySink sink;
  World world = busy_world();
  Recorder recorder(world, sink);
  step(world, 12);
  const std::vector<std::byte> saved = save_snapshot(world);
  Result<World> loaded = load_snapshot(saved);
  Result<World> copy = clone(world);
  ASSERT_TRUE(loaded && copy);
  EXPECT_EQ(loaded->hash(), world.hash());
  step(world, 12), step(*loaded, 12), step(*copy, 12);
  EXPECT_EQ(loaded->hash(), world.hash());
  EXPECT_EQ(copy->hash(), world.hash());
  ASSERT_TRUE(recorder.finish());
  Result<Replay> replay = Replay::open(sink.bytes);
  ASSERT_TRUE(replay);
  bool matches = true;
  for (bool good = true; replay->step(&good);) matches = matches && good;
  EXPECT_TRUE(matches);
  ASSERT_FALSE(restore_snapshot(world, saved));
  step(world, 12);
  EXPECT_EQ(loaded->hash(), world.hash());
}

TEST(AdaptiveDomain, ASmallSnapshotOfALargeGasIsRead) {
  World world = make_world();
  world.add_gas(puff_in(128, true));
  const std::vector<std::byte> saved = save_snapshot(world);
  EXPECT_LT(saved.size(), 1u << 18);
  ASSERT_TRUE(load_snapshot(saved));
}

TEST(AdaptiveDomain, FollowsWhatMovesIt) {
  World world = make_world();
  GasDef def = puff_in(128, true);
  def.emitters.clear();
  const FluidId gas = world.add_gas(def);
  const auto holds = [&](int x, int y, int z) {
    const FluidInfo info = world.fluid_info(gas);
    const int cell[3] = {x, y, z};
    bool within = true;
    for (std::size_t axis = 0; axis < 3; ++axis)
      within = within && cell[axis] >= info.active_first[axis] &&
               cell[axis] < info.active_first[axis] + info.active_cells[axis];
    return within;
  };
  step(world, 1);
  EXPECT_EQ(active_cells(world, gas), 8 * 8 * 8);
  const BodyId fan =
      world.add_body({.type = BodyType::kinematic, .pose = {{2, 2, 2}}}, {.geometry = Sphere{0.1f}});
  step(world, 1);
  EXPECT_FALSE(holds(64, 64, 64));
  world.set_velocity(fan, {0.5f, 0, 0}, {});
  step(world, 1);
  EXPECT_TRUE(holds(64, 64, 64));
  EXPECT_LT(active_cells(world, gas), 40 * 40 * 40);
  world.remove_body(fan);
  const BodyId crate = world.add_body({.pose = {{3, 1, 1}}}, {.geometry = Sphere{0.1f}});
  step(world, 1);
  EXPECT_TRUE(holds(96, 32, 32));
  world.remove_body(crate);
  const FluidEmitter late{.position = {1, 3, 3}, .radius = 0.1f, .start = world.time() + 0.02};
  world.set_emitters(gas, {&late, 1});
  step(world, 1);
  EXPECT_FALSE(holds(32, 96, 96));
  step(world, 2);
  EXPECT_TRUE(holds(32, 96, 96));
  world.add_cloth({.grid = ClothGrid{{0.3f, 0.3f}, {6, 6}}, .pose = {{3, 3, 0.5}}});
  step(world, 1);
  EXPECT_TRUE(holds(96, 96, 16));
}

// All of the air moves against a box that moves.
TEST(AdaptiveDomain, ABoxThatMovesIsComputedWhole) {
  World world = make_world();
  const FluidId gas = world.add_gas(puff_in(32, true));
  step(world, 3);
  EXPECT_LT(active_cells(world, gas), 32 * 32 * 32);
  world.set_fluid_velocity(gas, {1, 0, 0}, {});
  EXPECT_EQ(active_cells(world, gas), 32 * 32 * 32);
  EXPECT_NEAR(world.probe(gas, {0.9, 0.9, 0.9}).velocity.x, 0.0f, 1.0e-6f);
  step(world, 3);
  EXPECT_EQ(active_cells(world, gas), 32 * 32 * 32);
  EXPECT_NEAR(world.probe(gas, {0.9, 0.9, 0.9}).velocity.x, 0.0f, 1.0e-3f);
}

TEST(AdaptiveDomain, ASleeperBeyondItSleepsOn) {
  World world = make_world();
  scenes::add_fixed(world, {0, 0, 0}, Plane{});
  const FluidId gas = world.add_gas(puff_in(64, true));
  const BodyId box = world.add_body({.pose = {{1.5, 0.15, 1.5}}},
                                    {.geometry = Box{{0.15f, 0.15f, 0.15f}}, .density = 20.0f});
  step(world, 240);
  ASSERT_FALSE(world.is_awake(box));
  const FluidLoad load = world.fluid_load(box);
  EXPECT_NEAR(load.force.y, 1.2f * 9.81f * 0.3f * 0.3f * 0.3f, 0.2f);
  step(world, 60);
  EXPECT_FALSE(world.is_awake(box));
  EXPECT_EQ(world.fluid_load(box).force, load.force);
  EXPECT_LT(world.fluid_info(gas).active_first[0] + world.fluid_info(gas).active_cells[0], 43);
}

TEST(AdaptiveDomain, WhatIsOutOfRangeIsRefusedInWords) {
  World world = make_world();
  GasDef def = puff_in(8, true);
  def.adaptive_domain->margin = 0;
  EXPECT_FALSE(world.add_gas(def));
  def.adaptive_domain->margin = 1, def.adaptive_domain->threshold = 0.0f;
  EXPECT_FALSE(world.add_gas(def));
  def.adaptive_domain->threshold = 1.1f;
  EXPECT_FALSE(world.add_gas(def));
  def.adaptive_domain->threshold = 1.0f;
  EXPECT_TRUE(world.add_gas(def));
}

}  // namespace
}  // namespace gyre::adaptive_domain_test
