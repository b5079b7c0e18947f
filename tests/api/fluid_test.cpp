// Gases in a world: laws that hold for every grid, and that they are part of the world's state.
#include "determinism/scenes.h"
#include "memory_sink.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace gyre::fluid_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

World make_world(Vec3 gravity = {0, -9.81f, 0}, int threads = 1, int width = 0) {
  WorldDef def;
  def.gravity = gravity;
  def.threads = threads;
  def.simd_width = width;
  return std::move(*World::create(def));
}

std::array<FluidBoundary, 6> all_sides(FluidBoundary one) { return {one, one, one, one, one, one}; }

BodyId add_body(World& world, BodyType type, DVec3 at, AnyShape shape, float density = 1000.0f) {
  BodyDef body;
  body.type = type;
  body.pose.position = at;
  return world.add_body(body, ShapeDef{.geometry = shape, .density = density});
}

void step(World& world, int steps) {
  for (int i = 0; i < steps; ++i) world.step(kStep);
}

GasDef smoky_room() {
  GasDef def;
  def.lower = {-1, 0, -1}, def.upper = {1, 2, 1};
  def.cells = {20, 20, 20};
  def.vorticity = 0.3f;
  def.emitters = {{.position = {0.1, 0.3, 0}, .radius = 0.3f, .temperature = 400.0f}};
  return def;
}
GasDef burning_room() {
  GasDef def = smoky_room();
  def.combustion = Combustion{.ignition_temperature = 390.0f, .smoke_yield = 2.0f};
  def.emitters[0].fuel = 0.004f;
  return def;
}

// Warm smoke, a turning paddle, a ball that falls through and a cloth: something of everything.
World busy_world(int threads, int width) {
  World world = make_world({0, -9.81f, 0}, threads, width);
  scenes::add_fixed(world, {0, 0, 0}, Plane{});
  world.add_gas(smoky_room());
  const BodyId paddle = add_body(world, BodyType::kinematic, {-0.4, 1, 0.1}, Box{{0.4f, 0.3f, 0.06f}});
  world.set_velocity(paddle, {}, {0, 5, 0});
  add_body(world, BodyType::dynamic, {0.4, 1.5, 0}, Sphere{0.2f}, 5.0f);
  world.add_cloth({.grid = ClothGrid{{0.6f, 0.6f}, {6, 6}}, .pose = {{0, 1.2, -0.3}}});
  return world;
}

TEST(Gas, WarmGasRisesAndCarriesItsSmoke) {
  World world = make_world();
  GasDef def = smoky_room();
  const FluidId room = world.add_gas(def);
  ASSERT_TRUE(room);
  step(world, 60);
  EXPECT_GT(world.probe(room, {0.1, 0.8, 0}).velocity.y, 0.5f);
  EXPECT_GT(world.probe(room, {0.1, 1.0, 0}).density, 0.1f);
  EXPECT_GT(world.probe(room, {0.1, 1.0, 0}).temperature, 300.0f);
  const FluidInfo info = world.fluid_info(room);
  EXPECT_GT(info.smoke_mass, 0.0);
  EXPECT_LT(info.divergence * kStep, 1.0e-3f);
  EXPECT_EQ(info.cells[1], 20);
}

TEST(Gas, SmokeInAClosedRoomStays) {
  World world = make_world();
  GasDef def = smoky_room();
  def.sides = all_sides(FluidBoundary::closed);
  def.emitters[0].end = 0.1;
  const FluidId room = world.add_gas(def);
  step(world, 12);
  const double before = world.fluid_info(room).smoke_mass;
  step(world, 120);
  EXPECT_GT(before, 0.0);
  EXPECT_NEAR(world.fluid_info(room).smoke_mass, before, 0.005 * before);
}

// A flame is the same for threads, in a snapshot and as a definition; without combustion fuel means nothing.
TEST(Gas, AFlameIsStateLikeTheRest) {
  const auto burning = [](int threads, int width) {
    World world = make_world({0, -9.81f, 0}, threads, width);
    add_body(world, BodyType::dynamic, {0.4, 1.5, 0}, Sphere{0.2f}, 5.0f);
    world.add_gas(burning_room());
    step(world, 20);
    return world;
  };
  World world = burning(1, 0);
  FluidId room;
  world.fluids({&room, 1});
  EXPECT_EQ(burning(2, 1).hash(), world.hash());
  const FluidProbe flame = world.probe(room, {0.1, 0.5, 0});
  EXPECT_GT(flame.temperature, 405.0f);  // hotter than the emitter
  EXPECT_GT(flame.fuel, 0.0f);
  EXPECT_GT(world.fluid_info(room).heat_rate, 0.0);
  const GasDef now = world.gas_def(room);
  ASSERT_TRUE(now.combustion && now.fields);
  EXPECT_EQ(now.emitters[0].fuel, 0.004f);
  EXPECT_EQ(now.fields->fuel.size(), 8000u);
  Result<World> loaded = load_snapshot(save_snapshot(world));
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->hash(), world.hash());
  step(world, 10), step(*loaded, 10);
  EXPECT_EQ(loaded->hash(), world.hash());
  World other = make_world();
  const FluidId copy = other.add_gas(now);
  ASSERT_TRUE(copy);
  EXPECT_EQ(other.probe(copy, {0.1, 0.5, 0}).fuel, flame.fuel);
  GasDef cold = burning_room();
  cold.combustion.reset();
  World plain = make_world(), without = make_world();
  plain.add_gas(smoky_room()), without.add_gas(cold);
  step(plain, 5), step(without, 5);
  EXPECT_EQ(plain.hash(), without.hash());
}

// A piston that fills a channel moves all of the gas in it as fast as itself, whatever the cells.
TEST(Gas, APistonMovesAllGasOfItsChannel) {
  for (const int cells : {12, 23}) {
    World world = make_world({});
    GasDef def;
    def.lower = {-2, 0, 0}, def.upper = {2, 1, 1};
    def.cells = {4 * cells, cells, cells};
    def.sides = all_sides(FluidBoundary::closed);
    def.sides[0] = def.sides[1] = FluidBoundary::open;
    const FluidId channel = world.add_gas(def);
    const BodyId piston = add_body(world, BodyType::kinematic, {-0.6, 0.5, 0.5}, Box{{0.2f, 1.0f, 1.0f}});
    world.set_velocity(piston, {0.8f, 0, 0}, {});
    step(world, 10);
    for (const double x : {-1.5, 0.3, 1.5}) {
      const Vec3 v = world.probe(channel, {x, 0.4, 0.6}).velocity;
      EXPECT_NEAR(v.x, 0.8f, 2.0e-3f) << x << " at " << cells;
      EXPECT_NEAR(v.y, 0.0f, 2.0e-3f) << x;
    }
  }
}

// Archimedes: gas at rest lifts a held body by the weight of the gas that it displaces.
TEST(Gas, LiftsABodyByTheWeightThatItDisplaces) {
  for (const float density : {1.2f, 300.0f}) {
    World world = make_world();
    GasDef def;
    def.density = density;
    def.cells = {30, 30, 30};
    def.sides = all_sides(FluidBoundary::closed);
    world.add_gas(def);
    // A body of ten times the density, so that it hardly moves in one step: its acceleration tells the force.
    const BodyId ball =
        add_body(world, BodyType::dynamic, {0.03, 1.02, -0.01}, Sphere{0.4f}, 10.0f * density);
    world.step(kStep);
    const double lift = 9.81 + double(world.linear_velocity(ball).y) / double(kStep);
    EXPECT_NEAR(lift, 0.1 * 9.81, 0.02 * 0.1 * 9.81) << density;
    EXPECT_NEAR(length(world.angular_velocity(ball)), 0.0, 1.0e-3);
  }
}

TEST(Gas, ABodyInTheWindIsPushedAndACloth) {
  World world = make_world({});
  GasDef def;
  def.lower = {-2, -1, -1}, def.upper = {2, 1, 1};
  def.cells = {32, 16, 16};
  def.initial_velocity = {5, 0, 0};
  def.emitters = {{.position = {-1.8, 0, 0},
                   .radius = 0.9f,
                   .density = 0.0f,
                   .temperature = 293.15f,
                   .velocity = Vec3{5, 0, 0}}};
  world.add_gas(def);
  const SoftId flag = world.add_cloth(
      {.grid = ClothGrid{{0.5f, 0.5f}, {5, 5}}, .pose = {{0.6, 0, 0}, {0, 0, 0.70710678f, 0.70710678f}}});
  step(world, 20);
  const SoftVertices v = world.vertices(flag);
  double mean = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i) mean += double(v.vx[i]) / double(v.size());
  EXPECT_GT(mean, 1.0);
  EXPECT_LT(mean, 5.5);
}

TEST(Gas, IsTheSameForThreadsAndWidths) {
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

TEST(Gas, ASnapshotGoesOnToTheBit) {
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

TEST(Gas, ARecordingPlaysToTheSameBits) {
  MemorySink sink;
  World world = busy_world(1, 0);
  FluidId room;
  world.fluids({&room, 1});
  Recorder recorder(world, sink);
  step(world, 10);
  const FluidEmitter moved{
      .position = {0.5, 0.5, 0.2}, .radius = 0.2f, .velocity = Vec3{0, 0, 2}, .start = 0.0};
  EXPECT_TRUE(world.set_emitters(room, {&moved, 1}));
  step(world, 5);
  GasDef second;
  second.cells = {8, 8, 1};
  second.vortices = TaylorGreen{1.0f, {3.0f, 3.0f}};
  const FluidId flat = world.add_gas(second);
  EXPECT_TRUE(flat);
  step(world, 5);
  EXPECT_TRUE(world.remove_fluid(room));
  step(world, 5);
  ASSERT_TRUE(recorder.finish());
  Result<Replay> replay = Replay::open(sink.bytes);
  ASSERT_TRUE(replay);
  bool matches = true;
  for (bool good = true; replay->step(&good);) matches = matches && good;
  EXPECT_TRUE(matches);
  EXPECT_EQ(replay->world().hash(), world.hash());
}

TEST(Gas, ADefinitionGoesOnAsItIs) {
  World world = make_world();
  const FluidId room = world.add_gas(smoky_room());
  step(world, 30);
  World other = make_world();
  const FluidId copy = other.add_gas(world.gas_def(room));
  ASSERT_TRUE(copy);
  step(world, 10);
  // Its emitters run by the time of the world, which begins anew; these last from the start on.
  step(other, 10);
  const FluidProbe a = world.probe(room, {0.1, 0.9, 0}), b = other.probe(copy, {0.1, 0.9, 0});
  EXPECT_NEAR(a.velocity.y, b.velocity.y, 1.0e-3f * std::fabs(a.velocity.y));
  EXPECT_NEAR(a.density, b.density, 1.0e-3f);
}

TEST(Gas, WhatIsOutOfRangeIsRefusedInWords) {
  World world = make_world();
  const auto refused = [&](const GasDef& def, const char* words) {
    world.step(kStep);
    EXPECT_FALSE(world.add_gas(def)) << words;
    ASSERT_FALSE(world.problems().empty());
    EXPECT_NE(std::string(world.problems().back().message).find(words), std::string::npos)
        << world.problems().back().message;
  };
  GasDef def;
  def.cells = {1000, 1000, 1000};
  refused(def, "at most 16777216 cells");
  def = {};
  def.upper.y = -1.0;
  refused(def, "upper");
  def = {};
  def.density = 0.0f;
  refused(def, "density");
  def = {};
  def.sides[2] = FluidBoundary::periodic;
  refused(def, "periodic");
  def = {};
  def.emitters = {{.position = {5, 0, 0}}};
  refused(def, "emitters[0].position");
  def = {};
  def.fields = GasFields{};
  refused(def, "fields.velocity_x");
  def = {};
  def.emitters = {{.position = {0, 1, 0}, .fuel = -1.0f}};
  refused(def, "emitters[0].fuel");
  def = {};
  def.combustion = Combustion{.heat_capacity = 0.0f};
  refused(def, "combustion.heat_capacity");
  EXPECT_FALSE(world.set_emitters({}, {}));
  EXPECT_EQ(world.fluids({}), 0u);
}

TEST(Gas, AFieldThatIsNotFiniteIsStilledAndTold) {
  World world = make_world();
  GasDef def;
  def.cells = {8, 8, 8};
  def.emitters = {
      {.position = {0, 1, 0}, .radius = 0.5f, .velocity = Vec3{3.0e38f, 3.0e38f, 3.0e38f}, .end = 0.001}};
  const FluidId room = world.add_gas(def);
  ASSERT_TRUE(room);
  bool told = false;
  for (int i = 0; i < 5; ++i) {
    world.step(kStep);
    for (const Problem& problem : world.problems())
      told = told || std::string(problem.message).find("stilled") != std::string::npos;
  }
  EXPECT_TRUE(told);
  EXPECT_TRUE(std::isfinite(world.probe(room, {0, 1, 0}).velocity.y));
}

TEST(Gas, SleepersSleepOnAndWakeByTheWind) {
  World world = make_world();
  scenes::add_fixed(world, {0, 0, 0}, Plane{});
  GasDef def;
  def.lower = {-2, 0, -1}, def.upper = {2, 2, 1};
  def.cells = {32, 16, 16};
  const FluidId room = world.add_gas(def);
  const BodyId box = add_body(world, BodyType::dynamic, {0, 0.3, 0}, Box{{0.3f, 0.3f, 0.3f}}, 5.0f);
  step(world, 200);
  EXPECT_FALSE(world.is_awake(box));
  const FluidEmitter gust{.position = {-1.2, 0.5, 0},
                          .radius = 0.6f,
                          .density = 0.0f,
                          .temperature = 293.15f,
                          .velocity = Vec3{8, 0, 0}};
  ASSERT_TRUE(world.set_emitters(room, {&gust, 1}));
  step(world, 30);
  EXPECT_TRUE(world.is_awake(box));
  EXPECT_GT(world.linear_velocity(box).x, 0.1f);
}

// The momentum of the air in a box whose sides are all periodic.
DVec3 air_momentum(const World& world, FluidId gas, const GasDef& def) {
  std::vector<DVec3> points;
  const double edge = (def.upper.x - def.lower.x) / def.cells[0];
  for (int k = 0; k < def.cells[2]; ++k)
    for (int j = 0; j < def.cells[1]; ++j)
      for (int i = 0; i < def.cells[0]; ++i)
        points.push_back(def.lower + DVec3{(i + 0.5) * edge, (j + 0.5) * edge, (k + 0.5) * edge});
  std::vector<Vec3> velocities(points.size());
  world.sample_velocity(gas, points, velocities);
  DVec3 sum{};
  for (const Vec3 v : velocities) sum += DVec3(v);
  return (double(def.density) * edge * edge * edge) * sum;
}

TEST(Gas, GetsTheMomentumThatItsDragTakesFromACloth) {
  World world = make_world({});
  GasDef def;
  def.lower = {0, 0, 0}, def.upper = {2, 2, 2}, def.cells = {20, 20, 20};
  def.sides.fill(FluidBoundary::periodic);
  const FluidId gas = world.add_gas(def);
  ClothDef cloth;
  cloth.grid = ClothGrid{{0.6f, 0.6f}, {8, 8}};
  cloth.pose.position = {1, 0.6, 1};
  cloth.settings.velocities.assign(81, Vec3{0, 3, 0});
  const SoftId sail = world.add_cloth(cloth);
  ASSERT_TRUE(sail);
  const double before = world.momentum().linear.y;
  step(world, 60);
  const double given = before - world.momentum().linear.y;
  EXPECT_GT(given, 0.1 * before);
  EXPECT_NEAR(air_momentum(world, gas, def).y, given, 0.03 * given);
}

// A ball of a tenth of the air's density: with half of what it displaces of air moving along it starts at (1.2 - 0.12) / (0.12 + 0.6) g.
TEST(Gas, CarriesABalloonUpAndLeavesItAtTheCeiling) {
  World world = make_world();
  const BodyId ball = add_body(world, BodyType::dynamic, {0, 0.8, 0}, Sphere{0.25f}, 0.12f);
  add_body(world, BodyType::fixed, {0, 3.1, 0}, Box{{2, 0.1f, 2}});
  GasDef def;
  def.lower = {-1, 0, -1}, def.upper = {1, 3, 1}, def.cells = {20, 30, 20};
  def.sides = all_sides(FluidBoundary::closed);
  world.add_gas(def);
  step(world, 3);
  EXPECT_NEAR(double(world.linear_velocity(ball).y), 1.5 * 9.81 * 3.0 / 60.0, 0.05);
  double most = 0.0;
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    most = std::max(most, double(length(world.linear_velocity(ball))));
  }
  EXPECT_LT(most, 5.0);
  EXPECT_NEAR(world.pose(ball).position.y, 2.75, 0.01);
  EXPECT_LT(double(length(world.linear_velocity(ball))), 0.02);
}

// A periodic box repeats what is in it, so a ball that crosses a periodic side is the same obstacle as one in the middle.
TEST(Fluid, ABallAcrossAPeriodicSideIsLikeOneInTheMiddle) {
  const auto fastest = [](double place) {
    World world = make_world({});
    add_body(world, BodyType::fixed, {0.5, 0.5, place}, Sphere{0.2f});
    GasDef def{.lower = {}, .upper = {1, 1, 1}, .cells = {16, 16, 16}};
    def.sides = all_sides(FluidBoundary::closed);
    def.sides[4] = def.sides[5] = FluidBoundary::periodic;
    def.initial_velocity = {0, 0, 1};
    const FluidId gas = world.add_gas(def);
    step(world, 20);
    EXPECT_LT(world.fluid_info(gas).divergence, 0.01f) << place;
    return world.fluid_info(gas).kinetic_energy;
  };
  const double middle = fastest(0.5);
  for (const double place : {0.0, 1.0}) EXPECT_NEAR(fastest(place), middle, 1.0e-3 * middle) << place;
  for (const double place : {-0.1, 0.1, 0.9}) EXPECT_NEAR(fastest(place), middle, 0.05 * middle) << place;
}

// Bodies divide a gas into parts that no opening connects. Which parts there are depends on the bodies alone, and not on earlier solves, of which a
// snapshot knows nothing.
TEST(Fluid, ASnapshotOfADividedGasGoesOnWithTheSameBits) {
  World world = make_world({});
  // A wall across the whole box, and a piston that nears it in one of both rooms.
  add_body(world, BodyType::fixed, {0.5, 0.5, 0.5}, Box{{0.1f, 1.0f, 1.0f}});
  const BodyId piston = add_body(world, BodyType::kinematic, {-0.1, 0.5, 0.5}, Box{{0.15f, 1.0f, 1.0f}});
  world.set_velocity(piston, {0.5f, 0, 0}, {});
  GasDef def{.lower = {}, .upper = {1, 1, 1}, .cells = {16, 8, 8}};
  def.sides = all_sides(FluidBoundary::closed);
  def.initial_velocity = {0.3f, 0.2f, 0.1f};
  world.add_gas(def);
  step(world, 3);
  world.set_velocity(piston, {}, {});
  World again = std::move(*load_snapshot(save_snapshot(world)));
  for (int i = 0; i < 3; ++i) {
    step(world, 1), step(again, 1);
    ASSERT_EQ(world.hash(), again.hash()) << i;
  }
}

// More stages than the solver has would be needed: the viscosity acts like the largest that is stable.
TEST(Fluid, AGasOfAnyViscosityStaysFinite) {
  World world = make_world();
  GasDef def{.lower = {}, .upper = {0.004, 0.004, 0.004}, .cells = {12, 12, 12}};
  def.density = 0.1f, def.viscosity = 10.0f;
  def.initial_velocity = {0.1f, 0, 0};
  const FluidId gas = world.add_gas(def);
  world.step(1.0f / 30.0f);
  EXPECT_GT(world.fluid_info(gas).substeps, 0);  // 0: it was stilled
  EXPECT_TRUE(world.problems().empty());
  EXPECT_LT(length(world.probe(gas, {0.002, 0.002, 0.002}).velocity), 0.2f);
}

}  // namespace
}  // namespace gyre::fluid_test
