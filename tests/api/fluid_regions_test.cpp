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
  const BodyId box = world.add_body({.type = BodyType::kinematic,
                                     .pose = {.position = {-1.0, 0.9, 0.0},
                                              .orientation = from_axis_angle({0, 0, 1}, 0.25f * kPi)},
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
  const BodyId ball = add_ball(world, {0.3, 0.2, 0.3}, 0.05f);
  world.step(kStep);
  ASSERT_EQ(world.events().fluid_touches.size(), 2u) << "the ball is inside from the start";
  EXPECT_EQ(world.events().fluid_touches[0].fluid, pool);
  EXPECT_EQ(world.events().fluid_touches[1].fluid, other);
  std::vector<FluidTouch> all;
  for (int i = 0; i < 40; ++i) {
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

}  // namespace
}  // namespace gyre::fluid_regions_test
