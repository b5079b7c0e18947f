// Bodies read all at once: what the getters say of each, by ascending index.
#include <gyre/gyre.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace gyre::columns_test {
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

TEST(Columns, OfAllAndOfThoseAwakeStandSideBySide) {
  std::vector<BodyId> bodies, awake;
  const World world = make_yard(bodies);
  for (const BodyId body : bodies)
    if (world.is_awake(body)) awake.push_back(body);
  const BodyColumns all = world.bodies(), some = world.awake_bodies(), all_again = world.bodies();
  expect_columns(world, all, bodies);
  expect_columns(world, some, awake);
  EXPECT_EQ(all.poses.data(), all_again.poses.data());  // nothing has changed: not copied again
}

TEST(Columns, FollowEveryKindOfChange) {
  std::vector<BodyId> bodies;
  World world = make_yard(bodies);
  const BodyId last = bodies.back();
  const auto last_position = [&] { return world.bodies().poses.back().position; };
  const DVec3 before = last_position();
  ASSERT_TRUE(world.set_pose(last, {.position = before + Vec3{0, 0, 7}}));
  EXPECT_EQ(last_position(), (before + Vec3{0, 0, 7}));
  EXPECT_FALSE(world.set_pose(last, {.position = {1e300, 0, 0}}));  // refused: nothing changes
  EXPECT_EQ(last_position(), (before + Vec3{0, 0, 7}));

  const std::vector<std::byte> moment = save_snapshot(world);
  Rollback rollback(2);
  rollback.save(world);
  const std::uint64_t step = world.step_count();
  ASSERT_TRUE(world.step(0.1f));
  const DVec3 stepped = last_position();
  EXPECT_EQ(stepped, world.pose(last).position);
  EXPECT_NE(stepped, (before + Vec3{0, 0, 7}));
  ASSERT_TRUE(restore_snapshot(world, moment).ok());
  EXPECT_EQ(last_position(), (before + Vec3{0, 0, 7}));
  ASSERT_TRUE(world.step(0.1f));
  EXPECT_EQ(last_position(), stepped);
  ASSERT_TRUE(rollback.restore(world, step));
  EXPECT_EQ(last_position(), (before + Vec3{0, 0, 7}));

  const std::size_t awake = world.awake_bodies().ids.size();
  ASSERT_TRUE(world.set_awake(bodies[1], true));
  EXPECT_EQ(world.awake_bodies().ids.size(), awake + 1);
  ASSERT_TRUE(world.remove_body(last));
  EXPECT_EQ(world.bodies().ids.size(), bodies.size() - 1);
}

// Any number of threads may read while nobody changes the world: the first to ask makes the copy for all.
TEST(Columns, MayBeReadByManyThreadsAtOnce) {
  std::vector<BodyId> bodies, awake;
  World world = make_yard(bodies);
  for (const BodyId body : bodies)
    if (world.is_awake(body)) awake.push_back(body);
  constexpr int kThreads = 4, kRounds = 50;
  for (int round = 0; round < kRounds; ++round) {
    ASSERT_TRUE(world.step(1.0f / 600.0f));
    std::vector<std::thread> readers;
    for (int i = 0; i < kThreads; ++i) {
      readers.emplace_back([&, i] {
        const BodyColumns first = i % 2 == 0 ? world.bodies() : world.awake_bodies();
        const BodyColumns second = i % 2 == 0 ? world.awake_bodies() : world.bodies();
        expect_columns(world, i % 2 == 0 ? first : second, bodies);
        expect_columns(world, i % 2 == 0 ? second : first, awake);
      });
    }
    for (std::thread& reader : readers) reader.join();
  }
}

}  // namespace
}  // namespace gyre::columns_test
