#include "io/recording/difference.h"

#include "determinism/scenes.h"
#include "memory_sink.h"
#include "world/world_access.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::difference_test {
namespace {

using scenes::kScenes;

struct Pair {
  World a = *World::create();
  World b;
  explicit Pair(const scenes::Scene& scene, int steps) : b(start(scene, steps)) {}

 private:
  World start(const scenes::Scene& scene, int steps) {
    scene.build(a);
    for (int i = 0; i < steps; ++i) scenes::step_scene(scene, a, i);
    return *load_snapshot(save_snapshot(a));
  }
};

void flip_lowest_bit(float& value) {
  value = __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, value) ^ 1u);
}

TEST(Difference, NoneBetweenEqualWorlds) {
  Pair worlds(kScenes[1], 30);
  Difference found;
  for (int i = 0; i < 10; ++i)
    EXPECT_FALSE(step_and_compare(state_of(worlds.a), state_of(worlds.b), 0.01f, found));
}

TEST(Difference, OfAVelocityBitBetweenSteps) {
  Pair worlds(kScenes[1], 30);
  flip_lowest_bit(state_of(worlds.b).rigid.bodies.motion[17].angular_velocity.z);
  Difference found;
  ASSERT_TRUE(step_and_compare(state_of(worlds.a), state_of(worlds.b), 0.01f, found));
  EXPECT_STREQ(found.stage, "before the step");
  EXPECT_STREQ(found.column, "body_motion");
  EXPECT_EQ(found.row, 17u);
}

// The hook runs after each stage, so its change after `collide` is found there first.
TEST(Difference, OfABitWithinAStep) {
  for (const char* const stage : {"find_pairs", "collide", "solve", "put_to_sleep"}) {
    Pair worlds(kScenes[1], 30);
    struct Fault {
      WorldState& state;
      const char* stage;
    } fault{state_of(worlds.b), stage};
    fault.state.stage_hook = {[](void* context, const char* now) {
                                const Fault& f = *static_cast<Fault*>(context);
                                if (std::strcmp(now, f.stage) == 0) {
                                  flip_lowest_bit(f.state.rigid.bodies.motion[23].linear_velocity.x);
                                }
                              },
                              &fault};
    Difference found;
    ASSERT_TRUE(step_and_compare(state_of(worlds.a), state_of(worlds.b), 0.01f, found));
    EXPECT_STREQ(found.stage, stage);
    EXPECT_STREQ(found.column, "body_motion");
    EXPECT_EQ(found.row, 23u);
    EXPECT_NE(fault.state.stage_hook.call, nullptr) << "what hung on the hook is put back";
  }
}

// Derived data is in no column. A fault in it shows in the first stage that uses it.
TEST(Difference, OfDerivedDataShowsWhereItIsUsed) {
  Pair worlds(kScenes[1], 80);
  BodyStore& bodies = state_of(worlds.b).rigid.bodies;
  std::uint32_t touching = 0;
  for (std::uint32_t i = 0; i < bodies.flags.size(); ++i) {
    if (bodies.flags[i].type == BodyType::dynamic && bodies.flags[i].constraint_use != 0) touching = i;
  }
  ASSERT_NE(touching, 0u);
  bodies.inertia[touching].inverse.xx *= 1.5f;
  Difference found;
  ASSERT_TRUE(step_and_compare(state_of(worlds.a), state_of(worlds.b), 0.01f, found));
  EXPECT_STREQ(found.stage, "solve");
}

TEST(Difference, OfLengthsNamesTheFirstRowBeyond) {
  Pair worlds(kScenes[0], 1);
  const std::size_t count = state_of(worlds.a).rigid.bodies.motion.size();
  scenes::add_moving(worlds.b, {0, 50, 0}, Sphere{});
  Difference found;
  ASSERT_TRUE(step_and_compare(state_of(worlds.a), state_of(worlds.b), 0.01f, found));
  EXPECT_STREQ(found.column, "body_ids");
  EXPECT_EQ(found.row, count);
}

TEST(FirstDifference, NoneBetweenThreadsAndWidths) {
  World world = *World::create();
  kScenes[1].build(world);
  const std::vector<std::byte> snapshot = save_snapshot(world);
  WorldDef a, b;
  a.simd_width = 1;
  b.threads = 3;
  const Result<Difference> found = first_difference(snapshot, a, b, 40, scenes::kStepSeconds);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->step, UINT64_MAX) << found->stage << " " << found->column << " " << found->row;
  EXPECT_FALSE(first_difference({}, a, b, 1, 0.01f));
}

TEST(FirstDifference, OfARecordingMadeWithAFault) {
  World world = *World::create();
  MemorySink sink;
  Recorder recorder(world, sink);
  kScenes[2].build(world);
  for (int i = 0; i < 20; ++i) {
    if (i == 12) flip_lowest_bit(state_of(world).rigid.bodies.motion[5].linear_velocity.y);
    world.step(scenes::kStepSeconds);
  }
  recorder.finish();
  const Result<Difference> found = first_difference(sink.bytes, WorldDef{});
  ASSERT_TRUE(found) << found.error().message;
  // Two worlds of this build agree, so the fault was on the recording machine.
  EXPECT_EQ(found->step, 12u);
  EXPECT_STREQ(found->stage, "none: only the recorded hash differs");
}

// The motion hash misses this change; the next hash of the whole state finds it.
TEST(FirstDifference, OfHiddenStateIsToldByTheNextWholeHash) {
  World world = *World::create();
  MemorySink sink;
  Recorder recorder(world, sink, {.hash_interval = 8});
  kScenes[2].build(world);
  for (int i = 0; i < 30; ++i) {
    if (i == 12) state_of(world).rigid.bodies.user_data[5] ^= 1;
    world.step(scenes::kStepSeconds);
  }
  recorder.finish();
  const Result<Difference> found = first_difference(sink.bytes, WorldDef{});
  ASSERT_TRUE(found) << found.error().message;
  // Two worlds of this build agree. Only the recorded hash after the sixteenth step differs.
  EXPECT_EQ(found->step, 15u);
  EXPECT_STREQ(found->stage, "none: only the recorded hash differs");
}

TEST(FirstDifference, NoneOfAGoodRecording) {
  World world = *World::create();
  MemorySink sink;
  Recorder recorder(world, sink);
  kScenes[2].build(world);
  for (int i = 0; i < 20; ++i) world.step(scenes::kStepSeconds);
  recorder.finish();
  WorldDef def;
  def.threads = 2;
  const Result<Difference> found = first_difference(sink.bytes, def);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_EQ(found->step, UINT64_MAX);
}

}  // namespace
}  // namespace gyre::difference_test
