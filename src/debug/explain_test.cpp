// Staged situations with the expected reason of each.
#include "laws/kit.h"

#include <gyre/debug.h>

#include <string>

namespace gyre::laws::explain_test {
namespace {

BodyId add_box(World& world, DVec3 at, BodyDef def = {}) {
  def.pose.position = at;
  return world.add_body(def, {.geometry = Box{}});
}
bool says(const Explanation& e, const std::string& words) {
  const bool found = std::string(e.words).find(words) != std::string::npos;
  if (!found) std::printf("does not say \"%s\": %s\n", words.c_str(), e.words);
  return found;
}

TEST(Explain, AStaleId) {
  World world = make_world();
  const BodyId gone = add_box(world, {});
  world.remove_body(gone);
  const Explanation e = explain(world, gone);
  EXPECT_EQ(e.reason, AwakeReason::none);
  EXPECT_TRUE(says(e, "does not exist"));
  EXPECT_EQ(explain(world, {}).reason, AwakeReason::none);
}

TEST(Explain, WhatNeverSleeps) {
  World world = make_world();
  const BodyId ground = add_ground(world);
  const BodyId lift = add_box(world, {9, 5, 0}, {.type = BodyType::kinematic});
  const BodyId guard = add_box(world, {0, 0.5, 0}, {.can_sleep = false});
  run(world, 2.0);
  EXPECT_EQ(explain(world, ground).reason, AwakeReason::fixed);
  EXPECT_EQ(explain(world, lift).reason, AwakeReason::kinematic);
  EXPECT_EQ(explain(world, guard).reason, AwakeReason::may_not_sleep);
  EXPECT_TRUE(says(explain(world, guard), "may not sleep"));
}

TEST(Explain, SleepingSwitchedOff) {
  World world = make_world({.sleeping = false});
  add_ground(world);
  const BodyId box = add_box(world, {0, 0.5, 0});
  run(world, 2.0);
  EXPECT_EQ(explain(world, box).reason, AwakeReason::sleeping_off);
}

TEST(Explain, FallingSettlingAsleepAndMoving) {
  World world = make_world();
  add_ground(world);
  const BodyId box = add_box(world, {0, 3, 0});
  run(world, 0.2);
  Explanation e = explain(world, box);
  EXPECT_EQ(e.reason, AwakeReason::unsupported);
  EXPECT_GT(e.speed, e.rest_speed);
  EXPECT_TRUE(e.touching.empty());
  EXPECT_EQ(e.island_bodies, 1);
  EXPECT_EQ(e.still_seconds, 0.0f);
  bool settled = false;
  for (int i = 0; i < 600 && world.is_awake(box); ++i) {
    world.step(kStep);
    e = explain(world, box);
    settled = settled || e.reason == AwakeReason::settling;
    if (e.reason == AwakeReason::settling) {
      EXPECT_LE(e.speed, e.rest_speed);
    }
    EXPECT_LT(e.still_seconds, e.seconds_to_sleep + kStep);
  }
  EXPECT_TRUE(settled);
  e = explain(world, box);
  EXPECT_EQ(e.reason, AwakeReason::asleep);
  EXPECT_TRUE(says(e, "asleep"));
  ASSERT_EQ(e.touching.size(), 1u);
  EXPECT_EQ(e.touching[0].points, 4);
  EXPECT_NEAR(e.touching[0].force, 1000 * kGravity, 100.0);
  world.set_velocity(box, {4, 0, 0}, {});
  run(world, 0.1);
  e = explain(world, box);
  EXPECT_EQ(e.reason, AwakeReason::moving);
  ASSERT_EQ(e.touching.size(), 1u);
  EXPECT_TRUE(e.touching[0].sliding);
  EXPECT_TRUE(says(e, "sliding"));
}

// A quiet box on a body that is joined to a moving one.
TEST(Explain, ANeighbourKeepsItAwake) {
  World world = make_world();
  add_ground(world);
  const BodyId quiet = world.add_body({.pose = {.position = {0, 0.5, 0}}, .mass = 1e6f}, {.geometry = Box{}});
  const BodyId swing =
      world.add_body({.pose = {.position = {0.9, 2, 0}}, .mass = 0.1f}, {.geometry = Sphere{0.1f}});
  world.add_joint(BallDef{.a = quiet, .b = swing, .anchor = {0, 2, 0}, .collide_connected = true});
  run(world, 2.0);
  const Explanation e = explain(world, quiet);
  EXPECT_EQ(e.reason, AwakeReason::neighbor);
  EXPECT_EQ(e.cause, swing);
  EXPECT_EQ(e.cause_reason, AwakeReason::moving);
  EXPECT_EQ(e.island_bodies, 2);
  EXPECT_EQ(e.island, quiet);
  ASSERT_EQ(e.joints.size(), 1u);
  EXPECT_EQ(e.joints[0].other, swing);
  EXPECT_EQ(e.joints[0].kind, JointKind::ball);
  EXPECT_GT(e.joints[0].force, 0.0f);
  EXPECT_TRUE(says(e, "waits for body " + std::to_string(swing.index)));
  EXPECT_TRUE(says(e, "ball joint 0"));
  EXPECT_EQ(explain(world, swing).reason, AwakeReason::moving);
}

// A belt moves the bodies on it only a little by its own velocity, but it never stands still.
TEST(Explain, OnAKinematicBodyThatMoves) {
  World world = make_world();
  const BodyId disc = world.add_body({.type = BodyType::kinematic, .pose = {.position = {0, -0.5, 0}}},
                                     {.geometry = Box{{40, 0.5f, 40}}});
  const BodyId box = add_box(world, {0, 0.5, 0});
  for (int i = 0; i < 120; ++i) {
    world.set_velocity(disc, {}, {0, 0.001f, 0});
    world.step(kStep);
  }
  const Explanation e = explain(world, box);
  EXPECT_EQ(e.reason, AwakeReason::moving_support);
  EXPECT_EQ(e.cause, disc);
  EXPECT_TRUE(says(e, "which the program moves"));
}

TEST(Explain, NamesOfTheCallersOwn) {
  World world = make_world();
  const BodyId ground = add_ground(world);
  const BodyId box = add_box(world, {0, 0.5, 0});
  run(world, 0.3);
  struct Context {
    BodyId ground;
  } context{ground};
  const BodyNames names{[](void* user, BodyId body) -> const char* {
                          return static_cast<Context*>(user)->ground == body ? "the floor" : nullptr;
                        },
                        &context};
  const Explanation e = explain(world, box, names);
  EXPECT_TRUE(says(e, "touches the floor (4 points"));
  EXPECT_TRUE(says(e, "body 1 is awake"));
}

// A body with more neighbours than fit in a sentence, and names longer than the room for words.
TEST(Explain, CutsWhatIsTooLong) {
  World world = make_world({.sleeping = false});
  const BodyId table = world.add_body({.type = BodyType::fixed}, {.geometry = Box{{20, 1, 20}}});
  const BodyId plate = world.add_body({.pose = {.position = {0, 1.1, 0}}}, {.geometry = Box{{8, 0.1f, 8}}});
  for (int i = 0; i < 20; ++i) add_box(world, {1.5 * (i % 5) - 3, 1.7, 1.5 * (i / 5) - 3});
  run(world, 0.5);
  Explanation e = explain(world, plate);
  EXPECT_EQ(e.touching.size(), 21u);
  EXPECT_TRUE(says(e, "and 17 more"));
  for (std::size_t i = 1; i < e.touching.size(); ++i)
    EXPECT_LT(e.touching[i - 1].body.index, e.touching[i].body.index);
  static const std::string kLong(600, 'x');
  e = explain(world, plate, {[](void*, BodyId) { return kLong.c_str(); }, nullptr});
  EXPECT_EQ(std::string(e.words).size(), sizeof e.words - 1);
  EXPECT_EQ(explain(world, table).island_bodies, 0);
}

}  // namespace
}  // namespace gyre::laws::explain_test
