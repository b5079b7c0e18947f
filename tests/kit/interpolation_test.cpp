// Poses between steps, and frames divided into steps.
#include <gyre/kit/interpolation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace gyre::kit::interpolation_test {
namespace {

TEST(FixedTimestep, StepsFollowTheClock) {
  FixedTimestep clock{0.01f, 5};
  int steps = 0;
  for (int frame = 0; frame < 1000; ++frame) steps += clock.advance(0.007);
  EXPECT_NEAR(steps, 700, 1);
  EXPECT_GE(clock.alpha(), 0);
  EXPECT_LE(clock.alpha(), 1);
  EXPECT_EQ(clock.advance(3.0), 5) << "a hitch is cut";
  EXPECT_LE(clock.advance(0), 5);
  EXPECT_LE(clock.alpha(), 1);
  EXPECT_EQ(clock.advance(-1), 0);
  EXPECT_EQ(clock.advance(NAN), 0);
}

TEST(Interpolation, LiesBetweenTheLastTwoSteps) {
  World world = *World::create({.gravity = {}});
  const BodyId ball =
      world.add_body({.linear_velocity = {1, 0, 0}, .angular_velocity = {0, 2, 0}}, ShapeDef{});
  const BodyId later_removed = world.add_body({.pose = {.position = {0, 9, 0}}}, ShapeDef{});
  Interpolation poses;
  poses.capture(world);
  world.step(0.5f);
  poses.capture(world);
  EXPECT_NEAR(poses.pose(ball, 0).position.x, 0, 1e-6);
  EXPECT_NEAR(poses.pose(ball, 0.5f).position.x, 0.25, 1e-6);
  EXPECT_NEAR(poses.pose(ball, 1).position.x, 0.5, 1e-6);
  EXPECT_NEAR(2 * std::acos(double(poses.pose(ball, 0.5f).orientation.w)), 0.5, 1e-3);
  // A new body stands where it is, a removed one is not there, a teleported one does not fly.
  world.remove_body(later_removed);
  const BodyId added = world.add_body({.pose = {.position = {0, 0, 7}}}, ShapeDef{});
  world.set_pose(ball, {.position = {100, 0, 0}});
  poses.teleport(ball);
  poses.capture(world);
  EXPECT_EQ(poses.pose(added, 0).position.z, 7);
  EXPECT_EQ(poses.pose(later_removed, 0.5f).position.y, 0) << "its slot has another body";
  EXPECT_EQ(poses.pose(ball, 0.1f).position.x, 100);
  std::vector<Pose> all(poses.ids().size());
  poses.poses(0.5f, all);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].position.x, 100);
}

}  // namespace
}  // namespace gyre::kit::interpolation_test
