#include "io/recording.h"

#include "determinism/record_scene.h"

#include <gtest/gtest.h>

#include <cstring>

namespace gyre {
namespace {

using scenes::kScenes;
using scenes::Scene;
using scenes::step_scene;

// The scene recorded from its first command on, with the hash before the first step and after each.
struct Recorded {
  std::vector<std::byte> bytes;
  std::vector<std::uint64_t> hashes;
};
Recorded record(const Scene& scene, int steps) {
  Recorded recorded;
  recorded.bytes = scenes::record_scene(scene, steps, {.from = scenes::RecordFrom::first_command},
                                        [&](const World& world) { recorded.hashes.push_back(world.hash()); });
  EXPECT_FALSE(recorded.bytes.empty());
  return recorded;
}

class RecordingOfScene : public testing::TestWithParam<Scene> {};

TEST_P(RecordingOfScene, PlaysBackBitForBit) {
  const Recorded recorded = record(GetParam(), 150);
  Result<Replay> replay = Replay::open(recorded.bytes);
  ASSERT_TRUE(replay) << replay.error().message;
  EXPECT_FALSE(replay->truncated());
  ASSERT_EQ(replay->step_count(), 150u);
  for (int i = 0; i < 150; ++i) {
    bool matches = false;
    ASSERT_TRUE(replay->step(&matches));
    ASSERT_TRUE(matches) << i;
    ASSERT_EQ(replay->world().hash(), recorded.hashes[std::size_t(i) + 1]);
  }
  EXPECT_FALSE(replay->step());
  EXPECT_EQ(replay->position(), 150u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, RecordingOfScene, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(Recording, SeeksForwardAndBack) {
  const Recorded recorded = record(kScenes[6], 130);
  Result<Replay> replay = Replay::open(recorded.bytes);
  ASSERT_TRUE(replay);
  for (const std::uint64_t to : {100u, 3u, 64u, 130u, 0u, 129u, 17u, 16u, 15u}) {
    ASSERT_EQ(replay->seek(to).code, ErrorCode::none);
    EXPECT_EQ(replay->position(), to);
    EXPECT_EQ(replay->world().step_count(), to);
    // The commands that built the scene come with the first step.
    EXPECT_TRUE(to == 0 || replay->world().hash() == recorded.hashes[std::size_t(to)]) << to;
  }
  EXPECT_EQ(replay->seek(131).code, ErrorCode::invalid_argument);
  EXPECT_EQ(replay->position(), 15u);
}

TEST(Recording, StartsAnywhere) {
  World world = *World::create();
  kScenes[3].build(world);
  for (int i = 0; i < 40; ++i) world.step(scenes::kStepSeconds);
  MemorySink sink;
  {
    Recorder recorder(world, sink);  // finished by its destructor
    for (int i = 0; i < 20; ++i) world.step(scenes::kStepSeconds);
  }
  world.step(scenes::kStepSeconds);  // not recorded any more
  Result<Replay> replay = Replay::open(sink.bytes);
  ASSERT_TRUE(replay) << replay.error().message;
  EXPECT_EQ(replay->step_count(), 20u);
  EXPECT_FALSE(replay->truncated());
  bool matches = true;
  while (replay->step(&matches)) EXPECT_TRUE(matches);
  EXPECT_EQ(replay->world().step_count(), 60u);
}

TEST(Recording, GoesOnWhenTheWorldIsPutBack) {
  const Scene& scene = kScenes[5];
  World world = *World::create();
  scene.build(world);
  MemorySink sink;
  Recorder recorder(world, sink);
  Rollback ring(4);
  for (int i = 0; i < 30; ++i) {
    ring.save(world);
    step_scene(scene, world, i);
  }
  const std::vector<std::byte> snapshot = save_snapshot(world);
  world.set_gravity({0, 5, 0});
  ASSERT_TRUE(ring.restore(world, 28));
  for (int i = 0; i < 10; ++i) world.step(scenes::kStepSeconds);
  ASSERT_EQ(restore_snapshot(world, snapshot).code, ErrorCode::none);
  for (int i = 0; i < 10; ++i) world.step(scenes::kStepSeconds);
  EXPECT_TRUE(recorder.finish());
  Result<Replay> replay = Replay::open(sink.bytes);
  ASSERT_TRUE(replay) << replay.error().message;
  ASSERT_EQ(replay->step_count(), 50u);
  bool matches = true;
  while (replay->step(&matches)) EXPECT_TRUE(matches) << replay->position();
  EXPECT_EQ(replay->world().hash(), world.hash());
}

TEST(Recording, OneRecorderAtATime) {
  World world = *World::create();
  MemorySink sink, second_sink;
  Recorder recorder(world, sink);
  {
    Recorder second(world, second_sink);
    EXPECT_TRUE(second.failed());
    EXPECT_FALSE(second.finish());
  }
  EXPECT_TRUE(second_sink.bytes.empty());
  world.step(0.01f);
  EXPECT_TRUE(recorder.finish());
  Recorder third(world, second_sink);
  EXPECT_FALSE(third.failed());
}

TEST(Recording, RefusedCommandsAreNotRecorded) {
  World world = *World::create();
  MemorySink sink;
  Recorder recorder(world, sink);
  world.step(0.01f);
  const std::size_t size = sink.bytes.size();
  EXPECT_FALSE(world.step(-1));
  EXPECT_FALSE(world.remove_body({}));
  EXPECT_EQ(sink.bytes.size(), size);
}

TEST(Recording, AFullDiskLeavesWholeSteps) {
  const Recorded whole = record(kScenes[1], 30);
  for (const double part : {0.5, 0.8, 0.99}) {
    World world = *World::create();
    MemorySink sink;
    sink.room = std::size_t(part * double(whole.bytes.size()));
    Recorder recorder(world, sink);
    kScenes[1].build(world);
    for (int i = 0; i < 30; ++i) world.step(scenes::kStepSeconds);
    EXPECT_TRUE(recorder.failed());
    EXPECT_FALSE(recorder.finish());
    Result<Replay> replay = Replay::open(sink.bytes);
    ASSERT_TRUE(replay) << replay.error().message;
    EXPECT_TRUE(replay->truncated());
    bool matches = true;
    while (replay->step(&matches)) EXPECT_TRUE(matches);
  }
}

// ------------------------------------------------------------------------------------------------------ outside data

TEST(DamagedRecording, CutAnywherePlaysUpToTheLastWholeStep) {
  const Recorded recorded = record(kScenes[6], 40);
  std::uint64_t most = 0;
  for (std::size_t length = 0; length < recorded.bytes.size(); length += 97) {
    Result<Replay> replay =
        Replay::open({recorded.bytes.begin(), recorded.bytes.begin() + std::ptrdiff_t(length)});
    if (!replay) {
      EXPECT_EQ(most, 0u);
      continue;
    }
    EXPECT_TRUE(replay->truncated());
    EXPECT_GE(replay->step_count(), most);
    most = replay->step_count();
    bool matches = true;
    if (length % 3 == 0) {
      while (replay->step(&matches)) EXPECT_TRUE(matches);
    }
  }
  EXPECT_GE(most, 39u);
}

TEST(DamagedRecording, AFlippedBitEndsThePlayingThere) {
  const Recorded recorded = record(kScenes[6], 40);
  scenes::Random random(9);
  int opened = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<std::byte> bytes = recorded.bytes;
    const auto place = std::size_t(random.next(0, float(bytes.size() - 1)));
    if (place >= 12 && place < 16) continue;  // spare
    bytes[place] ^= std::byte(1 << i % 8);
    Result<Replay> replay = Replay::open(std::move(bytes));
    if (!replay) continue;
    ++opened;
    EXPECT_TRUE(replay->truncated());
    EXPECT_LE(replay->step_count(), 40u);
  }
  EXPECT_GT(opened, 20);
}

TEST(DamagedRecording, OtherVersionAndOtherStateAreRefused) {
  const Recorded recorded = record(kScenes[0], 2);
  std::vector<std::byte> version = recorded.bytes;
  version[8] ^= std::byte(2);
  EXPECT_EQ(Replay::open(version).error().code, ErrorCode::unsupported);
  std::vector<std::byte> layout = recorded.bytes;
  layout[17] ^= std::byte(1);
  EXPECT_EQ(Replay::open(layout).error().code, ErrorCode::unsupported);
  EXPECT_EQ(Replay::open({}).error().code, ErrorCode::invalid_data);
  EXPECT_EQ(Replay::open(std::vector<std::byte>(100)).error().code, ErrorCode::invalid_data);
}

TEST(DamagedRecording, SealedAgainIsRefusedOrPlays) {
  const Recorded recorded = record(kScenes[6], 30);
  scenes::Random random(10);
  int played = 0;
  for (int i = 0; i < 150; ++i) {
    std::vector<std::byte> bytes = recorded.bytes;
    for (int k = 0; k < 1 + i % 4; ++k) {
      bytes[24 + std::size_t(random.next(0, float(bytes.size() - 25)))] = std::byte(int(random.next(0, 256)));
    }
    reseal_recording(bytes);
    Result<Replay> replay = Replay::open(std::move(bytes));
    if (!replay) continue;
    while (replay->step()) {
    }
    ++played;
  }
  EXPECT_GT(played, 20);
}

}  // namespace
}  // namespace gyre
