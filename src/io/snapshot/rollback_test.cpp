#include "determinism/scenes.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

namespace gyre::rollback_test {
namespace {

using scenes::kScenes;
using scenes::Scene;
using scenes::step_scene;

TEST(Rollback, KeepsTheLastStates) {
  World world = *World::create();
  scenes::add_moving(world, {}, Sphere{});
  Rollback ring(4);
  EXPECT_FALSE(ring.restore(world, 0));
  EXPECT_EQ(ring.newest(), UINT64_MAX);
  for (int i = 0; i < 10; ++i) {
    ring.save(world);
    world.step(0.01f);
  }
  EXPECT_EQ(ring.oldest(), 6u);
  EXPECT_EQ(ring.newest(), 9u);
  EXPECT_FALSE(ring.restore(world, 5));
  EXPECT_FALSE(ring.restore(world, 10));
  EXPECT_TRUE(ring.restore(world, 7));
  EXPECT_EQ(world.step_count(), 7u);
  // A new save drops the states of later steps.
  ring.save(world);
  EXPECT_EQ(ring.newest(), 7u);
  EXPECT_EQ(ring.oldest(), 6u);
}

TEST(Rollback, EventsOfTheAbandonedFutureAreGone) {
  World world = *World::create();
  scenes::add_fixed(world, {0, -0.5, 0}, Box{});
  const BodyId ball = scenes::add_moving(world, {0, 0.45, 0}, Sphere{});
  Rollback ring(4);
  ring.save(world);
  world.step(0.01f);
  ASSERT_EQ(world.events().begins.size(), 1u);
  world.remove_body(ball);  // its end event waits for the next step
  ASSERT_TRUE(ring.restore(world, 0));
  EXPECT_TRUE(world.events().begins.empty());
  EXPECT_TRUE(world.exists(ball));
  world.step(0.01f);
  EXPECT_EQ(world.events().begins.size(), 1u);
  EXPECT_TRUE(world.events().ends.empty());
}

// B-22: every frame rewinds eight steps and plays them again, first with other input, then with the true one.
void soak(const Scene& scene, int steps) {
  constexpr int kBack = 8;
  World straight = *World::create();
  World world = *World::create();
  scene.build(straight);
  scene.build(world);
  Rollback ring(kBack + 1);
  for (int step = 0; step < steps; ++step) {
    step_scene(scene, straight, step);
    const int from = step < kBack ? 0 : step - kBack;
    ring.save(world);
    ASSERT_TRUE(ring.restore(world, std::uint64_t(from)));
    if (world.stats().bodies > 4) {
      world.add_impulse(scenes::body_number(world, 3 + std::size_t(step) % 2), {100, 50, 30});
      scenes::add_moving(world, {0, 3, 0}, Sphere{0.5f});
    }
    for (int i = 0; i < 3; ++i) world.step(scenes::kStepSeconds);
    ASSERT_TRUE(ring.restore(world, std::uint64_t(from)));
    for (int replayed = from; replayed <= step; ++replayed) {
      ring.save(world);
      step_scene(scene, world, replayed);
    }
    ASSERT_EQ(world.hash(), straight.hash()) << step;
  }
}

class RollbackSoak : public testing::TestWithParam<Scene> {};

TEST_P(RollbackSoak, ReplayedStepsEqualTheStraightRun) { soak(GetParam(), 120); }

INSTANTIATE_TEST_SUITE_P(Scenes, RollbackSoak, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Ten seconds of play.
class LongRollbackSoak : public testing::TestWithParam<Scene> {};

TEST_P(LongRollbackSoak, ReplayedStepsEqualTheStraightRun) { soak(GetParam(), 600); }

INSTANTIATE_TEST_SUITE_P(LongScenes, LongRollbackSoak, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace gyre::rollback_test
