// Bodies read all at once: what the getters say of each, by ascending index.
#include <gyre/gyre.h>

#include <gtest/gtest.h>

#include <vector>

namespace gyre {
namespace {

// A box of each sort, and a gap where one was removed.
World make_yard(std::vector<BodyId>& bodies) {
  World world = std::move(*World::create({}));
  const auto add = [&](BodyType type, double x) {
    bodies.push_back(world.add_body({.type = type, .pose = {.position = {x, 5, 0}}},
                                    {.geometry = Box{{0.5f, 0.5f, 0.5f}}}));
  };
  add(BodyType::fixed, 0);
  for (int i = 1; i < 5; ++i) add(BodyType::dynamic, 3.0 * i);
  add(BodyType::kinematic, -3);
  EXPECT_TRUE(world.remove_body(bodies[2]));
  bodies.erase(bodies.begin() + 2);
  world.set_velocity(bodies.back(), {1, 2, 3}, {0, 1, 0});
  for (int step = 0; step < 5; ++step) EXPECT_TRUE(world.step(1.0f / 60.0f));
  world.set_awake(bodies[1], false);
  return world;
}

void expect_columns(const World& world, const BodyColumns& columns, const std::vector<BodyId>& expected) {
  ASSERT_EQ(columns.ids.size(), expected.size());
  ASSERT_EQ(columns.poses.size(), expected.size());
  ASSERT_EQ(columns.linear_velocities.size(), expected.size());
  ASSERT_EQ(columns.angular_velocities.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(columns.ids[i], expected[i]);
    EXPECT_EQ(columns.poses[i].position, world.pose(expected[i]).position);
    EXPECT_EQ(columns.poses[i].orientation, world.pose(expected[i]).orientation);
    EXPECT_EQ(columns.linear_velocities[i], world.linear_velocity(expected[i]));
    EXPECT_EQ(columns.angular_velocities[i], world.angular_velocity(expected[i]));
  }
}

TEST(Columns, SayOfEachBodyWhatTheGettersSay) {
  std::vector<BodyId> bodies;
  const World world = make_yard(bodies);
  expect_columns(world, world.bodies(), bodies);
}

TEST(Columns, OfThoseAwakeLeaveOutWhatRests) {
  std::vector<BodyId> bodies, awake;
  const World world = make_yard(bodies);
  for (const BodyId body : bodies)
    if (world.is_awake(body)) awake.push_back(body);
  ASSERT_EQ(awake.size(), 3u);  // neither the fixed one nor the one put to sleep
  expect_columns(world, world.awake_bodies(), awake);
  expect_columns(world, world.bodies(), bodies);  // and again all
}

}  // namespace
}  // namespace gyre
