// Fluids as regions of the world: who enters and leaves them, and boxes that are turned or move.
#include "determinism/scenes.h"
#include "memory_sink.h"

#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gyre::fluid_regions_test {
namespace {

constexpr float kStep = 1.0f / 60.0f;

World make_world(const WorldDef& def = {}) { return std::move(*World::create(def)); }

LiquidDef tank(DVec3 size, double depth, float cell) {
  LiquidDef def;
  def.lower = {}, def.upper = size;
  def.cell_size = cell;
  def.fill = {{{}, {size.x, depth, size.z}}};
  return def;
}

BodyId add_ball(World& world, DVec3 at, float radius, float density = 2000.0f) {
  return world.add_body({.pose = {.position = at}}, {.geometry = Sphere{radius}, .density = density});
}

// ------------------------------------------------------------------------------------------------------------ events

TEST(FluidEvents, ABallEntersWhenItMeetsTheSurfaceAndLeavesWhenItIsLiftedOut) {
  World world = make_world();
  const FluidId pool = world.add_liquid(tank({1, 0.6, 1}, 0.4, 0.05f));
  const BodyId ball = add_ball(world, {0.5, 1.0, 0.5}, 0.1f);
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  // It falls by 0.5 m until its lowest point is at the level.
  const int expected = int(std::sqrt(2.0 * 0.5 / 9.81) / double(kStep));
  int entered = -1;
  for (int i = 0; i < 30; ++i) {
    world.step(kStep);
    for (const FluidTouch& one : world.events().fluid_touches) {
      EXPECT_EQ(entered, -1);
      EXPECT_TRUE(one.begins);
      EXPECT_EQ(one.fluid, pool);
      EXPECT_EQ(one.body, ball) << "not the ground";
      EXPECT_FALSE(one.soft);
      entered = i;
    }
  }
  EXPECT_NEAR(entered, expected, 1);
  world.set_gravity({});
  int left = -1;
  for (int i = 0; i < 60 && left < 0; ++i) {
    world.set_velocity(ball, {0, 3, 0}, {});
    world.step(kStep);
    for (const FluidTouch& one : world.events().fluid_touches) {
      EXPECT_FALSE(one.begins);
      EXPECT_EQ(one.body, ball);
      left = i;
    }
  }
  ASSERT_GE(left, 0);
  EXPECT_GT(world.pose(ball).position.y, 0.45);
}

TEST(FluidEvents, ABodyIsInAGasWhileItsShapeIsInTheBox) {
  World world = make_world({.gravity = {}});
  const FluidId room = world.add_gas({.lower = {0, -1, -1}, .upper = {2, 1, 1}, .cells = {8, 8, 8}});
  const BodyId box = world.add_body(
      {.type = BodyType::kinematic,
       .pose = {.position = {-1.0, 0.9, 0.0}, .orientation = from_axis_angle({0, 0, 1}, 0.25f * kPi)},
       .linear_velocity = {3, 0, 0}},
      {.geometry = Box{{0.2f, 0.2f, 0.2f}}});
  world.add_body({.type = BodyType::kinematic, .pose = {.position = {1, 0, 0}}},
                 {.geometry = Sphere{0.1f}, .sensor = true});
  const double reach = 0.2 * std::sqrt(2.0);
  for (int i = 0; i < 80; ++i) {
    const double before = world.pose(box).position.x;
    world.step(kStep);
    const double now = world.pose(box).position.x;
    const auto is_in = [&](double x) { return x > -reach && x < 2.0 + reach; };
    const std::span<const FluidTouch> touches = world.events().fluid_touches;
    ASSERT_EQ(touches.size(), is_in(before) != is_in(now) ? 1u : 0u) << now;
    if (touches.empty()) continue;
    EXPECT_EQ(touches[0].begins, is_in(now));
    EXPECT_EQ(touches[0].body, box);
    EXPECT_EQ(touches[0].fluid, room);
  }
}

TEST(FluidEvents, ARopeEntersByItsVertexAndWhatIsRemovedLeaves) {
  World world = make_world();
  const FluidId pool = world.add_liquid(tank({1, 0.6, 1}, 0.4, 0.05f));
  const FluidId other = world.add_gas({.lower = {0, 0, 0}, .upper = {1, 1, 1}, .cells = {4, 4, 4}});
  RopeDef rope;
  rope.points = {{0.5, 1.4, 0.5}, {0.5, 1.2, 0.5}, {0.5, 1.05, 0.5}};
  const SoftId soft = world.add_rope(rope);
  ASSERT_TRUE(soft);
  const BodyId ball = world.add_body({.type = BodyType::kinematic, .pose = {.position = {0.3, 0.2, 0.3}}},
                                     {.geometry = Sphere{0.05f}});
  world.step(kStep);
  ASSERT_EQ(world.events().fluid_touches.size(), 2u) << "the ball is inside from the start";
  EXPECT_EQ(world.events().fluid_touches[0].fluid, pool);
  EXPECT_EQ(world.events().fluid_touches[1].fluid, other);
  std::vector<FluidTouch> all;
  for (int i = 0; i < 25; ++i) {
    world.step(kStep);
    for (const FluidTouch& one : world.events().fluid_touches) all.push_back(one);
  }
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].soft, soft);
  EXPECT_EQ(all[0].fluid, other) << "the gas reaches higher";
  EXPECT_EQ(all[0].vertex, 2);
  EXPECT_EQ(all[1].fluid, pool);
  EXPECT_EQ(all[1].vertex, 2);
  world.remove_body(ball);
  world.remove_fluid(other);
  world.step(kStep);
  const std::span<const FluidTouch> touches = world.events().fluid_touches;
  ASSERT_EQ(touches.size(), 3u);
  for (const FluidTouch& one : touches) EXPECT_FALSE(one.begins);
  EXPECT_EQ(touches[0].body, ball);
  EXPECT_EQ(touches[0].fluid, other);
  EXPECT_EQ(touches[1].soft, soft);
  EXPECT_EQ(touches[2].body, ball);
  EXPECT_EQ(touches[2].fluid, pool);
}

TEST(FluidEvents, AWorldThatGoesOnFromASnapshotTellsTheSame) {
  World world = make_world();
  world.add_liquid(tank({1, 0.6, 1}, 0.4, 0.05f));
  const BodyId inside = add_ball(world, {0.3, 0.3, 0.3}, 0.05f, 300.0f);
  const BodyId above = add_ball(world, {0.7, 0.7, 0.7}, 0.05f);
  for (int i = 0; i < 5; ++i) world.step(kStep);
  EXPECT_TRUE(world.events().fluid_touches.empty());
  World again = std::move(*load_snapshot(save_snapshot(world)));
  EXPECT_EQ(again.hash(), world.hash());
  bool any = false;
  for (int i = 0; i < 20; ++i) {
    world.step(kStep), again.step(kStep);
    const auto a = world.events().fluid_touches, b = again.events().fluid_touches;
    ASSERT_EQ(a.size(), b.size()) << i;
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_NE(a[n].body.index, inside.index);
      EXPECT_EQ(a[n].body.index, above.index);
      EXPECT_EQ(b[n].body.index, above.index);
      any = true;
    }
  }
  EXPECT_TRUE(any);
}

// ------------------------------------------------------------------------------------------------- large boxes

// A stream runs over ground and a ramp through a large basin and pushes a light block: the cells that a step works on move with it.
World basin(int threads) {
  World world = make_world({.threads = threads});
  world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}});
  world.add_body({.type = BodyType::fixed, .pose = {{1.0, 0.1, 1.0}, from_axis_angle({0, 0, 1}, -0.3f)}},
                 {.geometry = Box{{0.8f, 0.05f, 0.6f}}});
  world.add_body({.pose = {.position = {2.0, 0.1, 1.0}}},
                 {.geometry = Box{{0.1f, 0.1f, 0.1f}}, .density = 200.0f});
  LiquidDef def = tank({4.8, 1.2, 4.8}, 0.0, 0.05f);
  def.fill = {{{0.3, 0.4, 0.7}, {0.9, 0.8, 1.3}}};
  def.emitters = {
      {.position = {0.5, 0.9, 1.0}, .radius = 0.1f, .velocity = Vec3{1, 0, 0}, .start = 0.2, .end = 0.6}};
  world.add_liquid(def);
  return world;
}

TEST(LargeBoxOfALiquid, AStreamIsTheSameFromASnapshotAndForAnyThreads) {
  World world = basin(1), parallel = basin(3), again = basin(1);
  for (int i = 0; i < 45; ++i) {
    world.step(kStep), parallel.step(kStep);
    ASSERT_EQ(world.hash(), parallel.hash()) << i;
    if (i > 4) {
      again.step(kStep);
      ASSERT_EQ(world.hash(), again.hash()) << i;
    }
    if (i % 10 != 4) continue;
    const std::vector<std::byte> saved = save_snapshot(world);
    if (i > 4) {
      ASSERT_EQ(saved, save_snapshot(again)) << i;
    }
    again = std::move(*load_snapshot(saved));
  }
}

// ------------------------------------------------------------------------------------------------- turned and moving boxes

// By 30 degrees about two axes.
Quat turned() { return from_axis_angle({0, 0, 1}, kPi / 6) * from_axis_angle({1, 0, 0}, kPi / 6); }

DVec3 to_world(const Pose& pose, DVec3 point) {
  return pose.position + rotate(pose.orientation, to_float(point));
}

// A cube of liquid cells whose centre is the origin, and particles below a level in the world.
LiquidDef tilted_tank(int cells, float cell, const Pose& pose, double level) {
  LiquidDef def;
  const double half = 0.5 * cells * double(cell);
  def.lower = {-half, -half, -half}, def.upper = {half, half, half};
  def.cell_size = cell;
  def.pose = pose;
  LiquidParticles particles;
  for (int k = 0; k < 2 * cells; ++k) {
    for (int j = 0; j < 2 * cells; ++j) {
      for (int i = 0; i < 2 * cells; ++i) {
        const DVec3 at = def.lower + 0.5 * double(cell) * DVec3{i + 0.5, j + 0.5, k + 0.5};
        if (to_world(pose, at).y > level) continue;
        particles.positions.push_back(at);
        particles.velocities.push_back({});
      }
    }
  }
  def.particles = std::move(particles);
  return def;
}

TEST(FluidFrames, ATurnedTankRestsWithThePressureOfItsDepthInTheWorld) {
  World world = make_world();
  const Pose pose{{3, 1, -2}, turned()};
  const FluidId pool = world.add_liquid(tilted_tank(16, 0.05f, pose, 1.0));
  const double volume = world.fluid_info(pool).volume;
  EXPECT_NEAR(volume, 0.5 * 0.8 * 0.8 * 0.8, 0.01 * volume) << "a plane through the middle halves a cube";
  for (int i = 0; i < 90; ++i) world.step(kStep);
  EXPECT_NEAR(world.fluid_info(pool).volume, volume, 2e-3 * volume);
  for (const DVec3 off : {DVec3{0, 0, 0}, DVec3{0.1, 0, 0.05}, DVec3{-0.1, 0, 0.1}}) {
    const FluidProbe deep = world.probe(pool, pose.position + off - DVec3{0, 0.25, 0});
    EXPECT_NEAR(deep.pressure, 1000.0f * 9.81f * 0.25f, 0.02f * 2452.0f);
    EXPECT_NEAR(deep.surface, 1.0f, 0.01f);
    EXPECT_LT(length(deep.velocity), 0.02f);
    EXPECT_EQ(world.probe(pool, pose.position + off + DVec3{0, 0.05, 0}).density, 0.0f);
  }
  std::vector<DVec3> places(world.liquid_particles(pool, {}, {}));
  world.liquid_particles(pool, places, {});
  double lowest = 1e9, highest = -1e9;
  for (const DVec3 place : places) lowest = std::min(lowest, place.y), highest = std::max(highest, place.y);
  EXPECT_LT(highest, 1.03);
  EXPECT_LT(lowest, 0.6) << "the lowest corner is below the middle of the lowest side";
}

TEST(FluidFrames, ABoxFloatsInATurnedTankAsInAStraightOne) {
  const float ratio = 0.5f;
  const auto run = [&](Quat orientation) {
    World world = make_world();
    const Pose pose{{0, 1, 0}, orientation};
    const BodyId box = world.add_body({.pose = {.position = {0, 1.0, 0}}},
                                      {.geometry = Box{{0.14f, 0.1f, 0.14f}}, .density = 1000.0f * ratio});
    LiquidDef def = tilted_tank(18, 0.05f, pose, 1.0);
    LiquidParticles& all = *def.particles;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < all.positions.size(); ++i) {
      const DVec3 at = to_world(pose, all.positions[i]) - DVec3{0, 1, 0};
      if (std::fabs(at.x) < 0.145 && std::fabs(at.y) < 0.105 && std::fabs(at.z) < 0.145) continue;
      all.positions[kept++] = all.positions[i];
    }
    all.positions.resize(kept), all.velocities.resize(kept);
    const FluidId pool = world.add_liquid(def);
    double draft = 0.0, lift = 0.0, wet = 0.0;
    for (int i = 0; i < 120; ++i) {
      world.step(kStep);
      if (i < 60) continue;
      const DVec3 place = world.pose(box).position;
      draft += (double(world.probe(pool, place + DVec3{0.2, 0, 0}).surface) - (place.y - 0.1)) / 0.2 / 60.0;
      const FluidLoad load = world.fluid_load(box);
      lift += double(load.force.y) / 60.0, wet += load.wet_volume / 60.0;
    }
    const double mass = double(world.mass_properties(box).mass);
    EXPECT_NEAR(draft, double(ratio), 0.04);
    EXPECT_NEAR(lift, mass * 9.81, 0.05 * mass * 9.81);
    EXPECT_NEAR(1000.0 * wet, mass, 0.06 * mass);
    return draft;
  };
  EXPECT_NEAR(run(turned()), run({}), 0.04);
}

// A world that is turned as a whole, gravity too, does the same.
TEST(FluidFrames, AGasTurnedWithItsWorldDoesTheSame) {
  const auto run = [](const Pose& pose, const std::vector<DVec3>& points) {
    World world = make_world({.gravity = rotate(pose.orientation, Vec3{0, -9.81f, 0})});
    world.add_body({.type = BodyType::kinematic,
                    .pose = {.position = to_world(pose, {-0.1, 0.9, 0.0}), .orientation = pose.orientation},
                    .linear_velocity = rotate(pose.orientation, Vec3{0.3f, 0, 0})},
                   {.geometry = Box{{0.2f, 0.1f, 0.3f}}});
    const BodyId balloon = world.add_body({.pose = {.position = to_world(pose, {0.3, 0.5, 0.2})}},
                                          {.geometry = Sphere{0.25f}, .density = 0.3f});
    GasDef def{.cells = {12, 12, 12},
               .emitters = {{.position = {0, 0.4, 0}, .radius = 0.3f, .temperature = 400.0f}},
               .pose = pose};
    def.sides[3] = FluidBoundary::closed;
    const FluidId gas = world.add_gas(def);
    for (int i = 0; i < 30; ++i) world.step(kStep);
    std::vector<float> out;
    for (const DVec3 point : points) {
      const FluidProbe probe = world.probe(gas, to_world(pose, point));
      const Vec3 velocity = rotate_inverse(pose.orientation, probe.velocity);
      for (const float one : {velocity.x, velocity.y, velocity.z, probe.pressure, probe.density})
        out.push_back(one);
    }
    const Vec3 load = rotate_inverse(pose.orientation, world.fluid_load(balloon).force);
    const Vec3 place =
        rotate_inverse(pose.orientation, difference(world.pose(balloon).position, pose.position));
    for (const float one : {load.x, load.y, load.z, place.x, place.y, place.z}) out.push_back(one);
    return out;
  };
  const std::vector<DVec3> points{{0, 0.8, 0}, {0.1, 1.3, 0.1}, {-0.4, 0.9, 0.2}, {0.2, 1.6, -0.3}};
  const std::vector<float> straight = run({}, points), other = run({{5, -2, 1}, turned()}, points);
  ASSERT_EQ(straight.size(), other.size());
  EXPECT_GT(straight[1], 0.1f) << "it rises";
  for (std::size_t i = 0; i < straight.size(); ++i)
    EXPECT_NEAR(straight[i], other[i], 2e-3f + 2e-3f * std::fabs(straight[i])) << i;
}

TEST(FluidFrames, ABoxThatMovesLeavesStillAirStillAndAFullTankFeelsItsAcceleration) {
  World world = make_world({.gravity = {}});
  const FluidId air = world.add_gas({.cells = {10, 10, 10}});
  world.set_fluid_velocity(air, {1.5f, 0, 0.5f}, {0, 0.7f, 0});
  LiquidDef def = tank({0.4, 0.4, 0.4}, 0.4, 0.05f);
  def.pose.position = {10, 0, 0};
  const FluidId full = world.add_liquid(def);
  const int particles = world.fluid_info(full).particles;
  constexpr float kAcceleration = 4.0f;
  for (int i = 0; i < 30; ++i) {
    world.set_fluid_velocity(full, {kAcceleration * kStep * float(i + 1), 0, 0}, {});
    world.step(kStep);
  }
  // The air is at rest in the world, although its box has moved by 0.75 m and has turned.
  const FluidInfo info = world.fluid_info(air);
  EXPECT_NEAR(info.pose.position.x, 0.75, 1e-5);
  for (const DVec3 point : {DVec3{0, 1, 0}, DVec3{0.5, 0.5, 0.3}, DVec3{-0.6, 1.5, -0.4}})
    EXPECT_LT(length(world.probe(air, to_world(info.pose, point)).velocity), 0.08f);
  const FluidInfo moved = world.fluid_info(full);
  EXPECT_EQ(moved.particles, particles);
  EXPECT_NEAR(moved.pose.position.x, 10.0 + 0.5 * 4.0 * 0.25, 0.05);
  const auto pressure = [&](double x) {
    return world.probe(full, to_world(moved.pose, {x, 0.2, 0.2})).pressure;
  };
  EXPECT_NEAR(pressure(0.075) - pressure(0.325), 1000.0f * kAcceleration * 0.25f, 30.0f);
  EXPECT_NEAR(world.momentum().linear.x, 64.0 * 2.0, 2.0) << "64 kg at 2 m/s";
}

// Liquid that turns with its box rests in it, with the surface that its spin asks for.
TEST(FluidFrames, ATankThatTurnsHasItsParabola) {
  World world = make_world();
  constexpr double kSpin = 5.0, kRise = kSpin * kSpin / (2 * 9.81);
  LiquidDef def;
  def.lower = {-0.2, 0, -0.2}, def.upper = {0.2, 0.4, 0.2};
  def.cell_size = 0.025f;
  def.angular_velocity = {0, float(kSpin), 0};
  LiquidParticles particles;
  for (int k = 0; k < 32; ++k) {
    for (int i = 0; i < 32; ++i) {
      const double x = (i - 15.5) * 0.0125, z = (k - 15.5) * 0.0125;
      for (int j = 0; 0.0125 * (j + 0.5) < 0.12 + kRise * (x * x + z * z); ++j) {
        particles.positions.push_back({x, 0.0125 * (j + 0.5), z});
        particles.velocities.push_back({});
      }
    }
  }
  def.particles = std::move(particles);
  const FluidId pool = world.add_liquid(def);
  double rise = 0.0;
  for (int i = 0; i < 60; ++i) {
    world.step(kStep);
    if (i < 20) continue;
    const Pose pose = world.fluid_info(pool).pose;
    const auto level = [&](double x, double z) {
      return double(world.probe(pool, to_world(pose, {x, 0.2, z})).surface);
    };
    rise +=
        (0.25 * (level(0.15, 0) + level(-0.15, 0) + level(0, 0.15) + level(0, -0.15)) - level(0, 0)) / 40.0;
  }
  EXPECT_NEAR(rise, kRise * 0.15 * 0.15, 0.06 * kRise * 0.15 * 0.15);
  const Pose pose = world.fluid_info(pool).pose;
  const Vec3 velocity = world.probe(pool, to_world(pose, {0.1, 0.05, 0})).velocity;
  EXPECT_NEAR(length(velocity), 0.1f * float(kSpin), 0.03f);
  World again = std::move(*load_snapshot(save_snapshot(world)));
  for (int i = 0; i < 5; ++i) world.step(kStep), again.step(kStep);
  EXPECT_EQ(again.hash(), world.hash());
}

TEST(FluidFrames, WhatIsOutOfRangeIsRefusedInWords) {
  World world = make_world();
  GasDef gas{.cells = {4, 4, 4}};
  gas.pose.orientation = {0, 0, 0, 0};
  EXPECT_FALSE(world.add_gas(gas));
  EXPECT_NE(std::string(world.problems().back().message).find("pose.orientation"), std::string::npos);
  gas.pose.orientation = {};
  const FluidId id = world.add_gas(gas);
  ASSERT_TRUE(id);
  EXPECT_FALSE(world.set_fluid_velocity(id, {NAN, 0, 0}, {}));
  EXPECT_FALSE(world.set_fluid_pose(FluidId{}, {}));
  EXPECT_TRUE(world.set_fluid_pose(id, {{1, 2, 3}, {0, 0, 2, 0}}));
  EXPECT_EQ(world.fluid_info(id).pose, (Pose{{1, 2, 3}, {0, 0, 1, 0}}));
  EXPECT_EQ(world.gas_def(id).pose, (Pose{{1, 2, 3}, {0, 0, 1, 0}}));
}

}  // namespace
}  // namespace gyre::fluid_regions_test
