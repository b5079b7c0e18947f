#include "io/recording/recording.h"

#include "determinism/record_scene.h"
#include "world/world_access.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <iterator>

namespace gyre::recording_test {
namespace {

using scenes::kScenes;
using scenes::Scene;
using scenes::step_scene;

// The scene recorded from its first command, with the hash before the first step and after each.
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

// -------------------------------------------------------------------------------------------- when a replay differs

// The number of steps that match, up to the first that does not.
std::uint64_t steps_that_match(std::vector<std::byte> bytes) {
  Result<Replay> replay = Replay::open(std::move(bytes));
  EXPECT_TRUE(replay) << replay.error().message;
  bool matches = true;
  while (replay->step(&matches)) {
    if (!matches) return replay->position() - 1;
  }
  return replay->step_count();
}

// A pile; `change` is applied before step 20 without the recorder's knowledge.
template <class Change>
std::vector<std::byte> record_with_fault(int steps, const RecordOptions& options, Change&& change) {
  World world = *World::create();
  kScenes[1].build(world);
  MemorySink sink;
  Recorder recorder(world, sink, options);
  for (int i = 0; i < steps; ++i) {
    if (i == 20) change(world);
    world.step(scenes::kStepSeconds);
  }
  EXPECT_TRUE(recorder.finish());
  return sink.bytes;
}

void change_velocity(World& world) {
  float& value = state_of(world).rigid.bodies.motion[state_of(world).rigid.bodies.awake.back()].linear_velocity.x;
  value = __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, value) ^ 1u);
}
// The change affects no motion.
void change_hidden(World& world) { state_of(world).rigid.bodies.user_data[3] ^= 1; }

TEST(Replay, TellsAnotherMotionInTheVeryStep) {
  for (const std::uint32_t interval : {1u, 16u, 1000u})
    EXPECT_EQ(steps_that_match(record_with_fault(60, {.hash_interval = interval}, change_velocity)), 20u);
}

TEST(Replay, TellsAnAlteredCommandInTheStepItIsOf) {
  World world = *World::create();
  const BodyId body = scenes::add_moving(world, {0, 5, 0}, Sphere{});
  MemorySink sink;
  Recorder recorder(world, sink);
  const float given = 1.8046875f, other = 1.8046876f;
  for (int i = 0; i < 30; ++i) {
    if (i == 17) world.set_velocity(body, {given, 0, 0}, {});
    world.step(scenes::kStepSeconds);
  }
  EXPECT_TRUE(recorder.finish());
  EXPECT_EQ(steps_that_match(sink.bytes), 30u);
  std::byte was[4], becomes[4];
  store_little(was, to_bits(given)), store_little(becomes, to_bits(other));
  const auto place = std::search(sink.bytes.begin(), sink.bytes.end(), std::begin(was), std::end(was));
  ASSERT_NE(place, sink.bytes.end());
  std::copy(std::begin(becomes), std::end(becomes), place);
  reseal_recording(sink.bytes);
  EXPECT_EQ(steps_that_match(sink.bytes), 17u);
}

TEST(Replay, TellsAnotherHiddenStateAtTheNextWholeHash) {
  EXPECT_EQ(steps_that_match(record_with_fault(60, {.hash_interval = 1}, change_hidden)), 20u);
  EXPECT_EQ(steps_that_match(record_with_fault(60, {.hash_interval = 16}, change_hidden)), 31u);
  // The last step always has a state hash.
  EXPECT_EQ(steps_that_match(record_with_fault(60, {.hash_interval = 1000}, change_hidden)), 59u);
}

TEST(Recording, CommandsAfterTheLastStepLeaveItItsHash) {
  World world = *World::create();
  const BodyId body = scenes::add_moving(world, {0, 5, 0}, Sphere{});
  MemorySink sink;
  Recorder recorder(world, sink);
  for (int i = 0; i < 5; ++i) world.step(scenes::kStepSeconds);
  world.set_velocity(body, {1, 0, 0}, {});
  EXPECT_TRUE(recorder.finish());
  EXPECT_EQ(steps_that_match(sink.bytes), 5u);
}

// The default of older versions.
TEST(Recording, WithWholeHashesAloneIsOfTheFirstLayout) {
  const auto kinds = [](const RecordOptions& options, std::uint64_t layout) {
    const std::vector<std::byte> bytes = record_with_fault(30, options, [](World&) {});
    ChunkReader reader(bytes);
    EXPECT_EQ(reader.read_header().code, ErrorCode::none);
    EXPECT_EQ(reader.layout(), layout);
    std::pair<int, int> counts;
    Chunk chunk;
    while (reader.next(chunk)) {
      if (chunk.kind == ChunkKind::step_hash) ++counts.first;
      if (chunk.kind == ChunkKind::motion_hash) ++counts.second;
    }
    EXPECT_EQ(steps_that_match(bytes), 30u);
    return counts;
  };
  const std::uint64_t first_layout = mix_bits(state_layout() + kCommandLayout);
  EXPECT_EQ(kinds({.hash_interval = 1}, first_layout), std::pair(30, 0));
  EXPECT_EQ(kinds({.hash_interval = 10}, recording_layout(true)), std::pair(3, 27));
  EXPECT_EQ(kinds({}, recording_layout(true)), std::pair(1, 30));
  EXPECT_NE(first_layout, recording_layout(true));
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
}  // namespace gyre::recording_test
