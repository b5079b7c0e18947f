// Times of stages: they sum to the whole, have the names of the step table, and are empty when timing is off.
#include "laws/kit.h"
#include "world/stages.h"

#include <gyre/debug.h>
#include <gyre/replay.h>

#include <string>

namespace gyre::laws::times_test {
namespace {

World make_heap() {
  World world = make_world();
  add_ground(world);
  for (int i = 0; i < 60; ++i) {
    world.add_body({.pose = {.position = {1.1 * (i % 4), 0.6 + 1.1 * (i / 16), 1.1 * (i / 4 % 4)}}},
                   {.geometry = Box{}});
  }
  return world;
}
std::uint64_t count_of(const StepTimes& times, const std::string& name) {
  for (const StepCount& count : times.counts) {
    if (name == count.name) return count.value;
  }
  ADD_FAILURE() << "no counter " << name;
  return 0;
}

TEST(Times, AreOffAtFirst) {
  World world = make_heap();
  EXPECT_FALSE(timing(world));
  run(world, 0.1);
  StepTimes times;
  read_times(world, times);
  EXPECT_EQ(times.steps, 0u);
  EXPECT_EQ(times.seconds, 0.0);
  for (const StageSeconds& stage : times.stages) EXPECT_EQ(stage.seconds, 0.0);
  for (const StepCount& count : times.counts) EXPECT_EQ(count.value, 0u);
}

TEST(Times, StagesAreThoseOfTheStepAndSumUpBelowTheWhole) {
  World world = make_heap();
  set_timing(world, true);
  StepTimes times;
  for (std::uint64_t step = 1; step <= 30; ++step) {
    world.step(kStep);
    read_times(world, times);
    EXPECT_EQ(times.steps, step);
    ASSERT_EQ(times.stages.size(), std::size_t(kStageCount));
    double sum = 0.0;
    for (int i = 0; i < kStageCount; ++i) {
      EXPECT_STREQ(times.stages[std::size_t(i)].name, kStageNames[i]);
      EXPECT_GE(times.stages[std::size_t(i)].seconds, 0.0);
      sum += times.stages[std::size_t(i)].seconds;
    }
    EXPECT_GT(sum, 0.0);
    EXPECT_LE(sum, times.seconds * (1 + 1e-12));
  }
}

TEST(Times, CountsAreThoseOfTheStep) {
  World world = make_heap();
  set_timing(world, true);
  StepTimes times;
  world.step(kStep);
  read_times(world, times);
  EXPECT_EQ(count_of(times, "refitted_boxes"), 61u) << "all shapes are new";
  EXPECT_EQ(count_of(times, "new_pairs"), std::uint64_t(world.stats().pairs));
  for (int i = 0; i < 20; ++i) world.step(kStep);
  read_times(world, times);
  const WorldStats counts = world.stats();
  EXPECT_EQ(count_of(times, "contacts"), std::uint64_t(counts.pairs));
  EXPECT_EQ(count_of(times, "colors"), std::uint64_t(counts.colors));
  EXPECT_EQ(count_of(times, "awake_bodies"), std::uint64_t(counts.awake_bodies));
  EXPECT_EQ(count_of(times, "joints"), 0u);
  EXPECT_LE(count_of(times, "full_looks"), count_of(times, "contacts"));
  EXPECT_GT(count_of(times, "manifolds"), 0u);
}

TEST(Times, AreNoPartOfSnapshotsAndRecordings) {
  World timed = make_heap(), plain = make_heap();
  set_timing(timed, true);
  run(timed, 0.2);
  run(plain, 0.2);
  EXPECT_EQ(timed.hash(), plain.hash());
  EXPECT_EQ(save_snapshot(timed), save_snapshot(plain));
  Result<World> loaded = load_snapshot(save_snapshot(timed));
  ASSERT_TRUE(loaded);
  EXPECT_FALSE(timing(*loaded));
}

TEST(Times, CanBeSwitchedWhileItRuns) {
  World world = make_heap();
  set_timing(world, true);
  run(world, 0.1);
  set_timing(world, false);
  StepTimes before, after;
  read_times(world, before);
  run(world, 0.1);
  read_times(world, after);
  EXPECT_EQ(before.steps, after.steps) << "what was measured last stays to be read";
  EXPECT_EQ(before.seconds, after.seconds);
  set_timing(world, true);
  world.step(kStep);
  read_times(world, after);
  EXPECT_EQ(after.steps, before.steps + 1);
}

}  // namespace
}  // namespace gyre::laws::times_test
