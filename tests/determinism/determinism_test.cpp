// What must never change a bit: threads, SIMD width, broad phase, a snapshot on the way, a recording. Every run of a scene
// is compared with the golden hashes every 50 steps, so that a difference is caught near where it starts.
//
// The goldens change when the engine's numbers change on purpose: then tests/determinism/update_golden.sh writes them anew.
#include "determinism/scenes.h"
#include "memory_sink.h"

#include <gyre/debug.h>

#include <gtest/gtest.h>

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <map>
#include <string>

namespace gyre::determinism_test {
namespace {

using scenes::kHashEvery;
using scenes::kScenes;
using scenes::kSteps;
using scenes::Scene;
using scenes::step_scene;

using Hashes = std::map<int, std::uint64_t>;  // by step

const Hashes& golden(const Scene& scene) {
  static const std::map<std::string, Hashes> all = [] {
    std::map<std::string, Hashes> read;
    std::ifstream file(GYRE_SOURCE_DIR "/tests/determinism/golden.txt");
    std::string name, hash;
    for (int step = 0; file >> name >> step >> hash;) read[name][step] = std::stoull(hash, nullptr, 16);
    return read;
  }();
  static const Hashes none;
  const auto found = all.find(scene.name);
  return found != all.end() ? found->second : none;
}

World make_world(const WorldDef& def) {
  Result<World> made = World::create(def);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

// Steps from `begin` to `end`, compared on the way. False at the first difference.
testing::AssertionResult follows_golden(const Scene& scene, World& world, int begin, int end) {
  for (int step = begin; step < end; ++step) {
    step_scene(scene, world, step);
    if ((step + 1) % kHashEvery != 0) continue;
    const auto expected = golden(scene).find(step + 1);
    if (expected == golden(scene).end())
      return testing::AssertionFailure() << "no golden hash of step " << step + 1;
    if (world.hash() != expected->second)
      return testing::AssertionFailure() << "another hash after step " << step + 1;
  }
  return testing::AssertionSuccess();
}

testing::AssertionResult runs_golden(const Scene& scene, const WorldDef& def) {
  World world = make_world(def);
  scene.build(world);
  testing::AssertionResult result = follows_golden(scene, world, 0, kSteps);
  if (result && world.step_count() != std::uint64_t(kSteps))
    return testing::AssertionFailure() << "a step was refused";
  return result;
}

WorldDef with_threads(int threads) {
  WorldDef def;
  def.threads = threads;
  return def;
}
WorldDef with_width(int width) {
  WorldDef def;
  def.simd_width = width;
  return def;
}

class Determinism : public testing::TestWithParam<Scene> {};

TEST_P(Determinism, SameAtEveryWidth) {
  for (const int width : {0, 1, 4, 8, 16}) EXPECT_TRUE(runs_golden(GetParam(), with_width(width))) << width;
}

TEST_P(Determinism, SameAtEveryNumberOfThreads) {
  for (const int threads : {2, 3, 4}) EXPECT_TRUE(runs_golden(GetParam(), with_threads(threads))) << threads;
}

TEST_P(Determinism, SameWithEveryBroadPhase) {
  for (int kind = 0; kind < kBroadPhaseKindCount; ++kind) {
    WorldDef def;
    def.stepping.broad_phase = BroadPhaseKind(kind);
    EXPECT_TRUE(runs_golden(GetParam(), def)) << to_string(def.stepping.broad_phase);
  }
}

// Long after the goldens end, when most things rest: whole worlds step side by side, each with its own broad phase.
TEST_P(Determinism, SameWithEveryBroadPhaseAndForTwiceAsLong) {
  const Scene& scene = GetParam();
  std::vector<World> worlds;
  for (int kind = 0; kind < kBroadPhaseKindCount; ++kind) {
    WorldDef def;
    def.stepping.broad_phase = BroadPhaseKind(kind);
    worlds.push_back(make_world(def));
    scene.build(worlds.back());
  }
  // What is driven adds more and more after the goldens' end.
  const int steps = scene.drive == nullptr ? 2 * kSteps : kSteps;
  for (int step = 0; step < steps; ++step) {
    for (World& world : worlds) step_scene(scene, world, step);
    if (step % 20 != 19) continue;
    for (int kind = 1; kind < kBroadPhaseKindCount; ++kind) {
      ASSERT_EQ(worlds[std::size_t(kind)].hash(), worlds[0].hash())
          << to_string(BroadPhaseKind(kind)) << ", step " << step;
    }
  }
  for (const World& world : worlds) EXPECT_EQ(validate(world).code, ErrorCode::none) << validate(world).message;
}

// Saved half-way, loaded into a world of other threads and width, and gone on from there.
TEST_P(Determinism, SameAcrossASnapshot) {
  World first = make_world(with_width(4));
  GetParam().build(first);
  EXPECT_TRUE(follows_golden(GetParam(), first, 0, kSteps / 2));
  WorldDef other = with_threads(2);
  other.stepping.broad_phase = BroadPhaseKind::brute_force;
  Result<World> second = load_snapshot(save_snapshot(first), other);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_TRUE(follows_golden(GetParam(), *second, kSteps / 2, kSteps));
}

// What a loaded world must find out anew, as how far ahead boxes reach, depends on nothing but what was saved: steps of any
// lengths follow. Every few steps a world is left for the one that its bytes make.
TEST_P(Determinism, SameAcrossSnapshotsWhereStepsDiffer) {
  if (GetParam().drive != nullptr) return;  // these step by themselves
  World world = make_world({}), loaded = make_world({});
  GetParam().build(world);
  GetParam().build(loaded);
  for (int step = 0; step < kSteps / 4; ++step) {
    const float seconds = 1.0f / (step % 5 == 0 ? 25.0f : step % 3 == 0 ? 100.0f : 60.0f);
    world.step(seconds);
    loaded.step(seconds);
    ASSERT_EQ(world.hash(), loaded.hash()) << "step " << step;
    if (step % 4 != 3) continue;
    Result<World> next = load_snapshot(save_snapshot(loaded), {});
    ASSERT_TRUE(next) << next.error().message;
    loaded = std::move(*next);
  }
}

TEST_P(Determinism, SameWhenARecordingIsPlayed) {
  MemorySink sink;
  {
    World world = make_world({});
    Recorder recorder(world, sink);
    GetParam().build(world);
    EXPECT_TRUE(follows_golden(GetParam(), world, 0, kSteps));
  }
  Result<Replay> replay = Replay::open(std::move(sink.bytes), with_width(1));
  ASSERT_TRUE(replay) << replay.error().message;
  bool matches = true;
  while (matches && replay->step(&matches)) {
  }
  EXPECT_TRUE(matches) << "after " << replay->position() << " steps";
  EXPECT_EQ(replay->position(), std::uint64_t(kSteps));
  EXPECT_EQ(replay->world().hash(), golden(GetParam()).at(kSteps));
}

// A host's own threads that take the blocks in any order.
TEST_P(Determinism, SameWithTheHostsThreads) {
  WorldDef def;
  def.host_tasks.worker_count = 3;
  def.host_tasks.run = [](void*, int count, void (*task)(void*, int), void* context) {
    for (int i = count; i-- > 0;) task(context, i);
  };
  EXPECT_TRUE(runs_golden(GetParam(), def));
}

INSTANTIATE_TEST_SUITE_P(Scenes, Determinism, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

class LongDeterminism : public testing::TestWithParam<Scene> {};

TEST_P(LongDeterminism, SameAtManyThreads) {
  for (const int threads : {1, 8, 16}) EXPECT_TRUE(runs_golden(GetParam(), with_threads(threads))) << threads;
}

INSTANTIATE_TEST_SUITE_P(LongScenes, LongDeterminism, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

// The hash itself must be able to see: any bit of the state makes another.
TEST(StateHash, SeesASingleBit) {
  for (const Scene& scene : kScenes) {
    World world = make_world({}), other = make_world({});
    scene.build(world);
    scene.build(other);
    for (int i = 0; i < 20; ++i) {
      step_scene(scene, world, i);
      step_scene(scene, other, i);
    }
    ASSERT_EQ(world.hash(), other.hash());
    const BodyId last = scenes::body_number(world, world.bodies().ids.size() - 1);
    const BodyId twin = scenes::body_number(other, other.bodies().ids.size() - 1);
    const Vec3 spin = other.angular_velocity(twin);
    const float next = __builtin_bit_cast(float, __builtin_bit_cast(std::uint32_t, spin.x + 1.0f) ^ 1u);
    world.set_velocity(last, world.linear_velocity(last), {spin.x + 1.0f, spin.y, spin.z});
    other.set_velocity(twin, other.linear_velocity(twin), {next, spin.y, spin.z});
    EXPECT_NE(world.hash(), other.hash()) << scene.name;
  }
}

// B-24: bodies that are added in another order take other slots and other places in every queue. The run may differ in its
// last bits, so its hash does; what it means does not.
TEST(CreationOrder, ChangesBitsButNotTheOutcome) {
  const auto build = [](bool backwards) {
    World world = make_world({});
    scenes::add_fixed(world, {0, -0.5, 0}, Box{{20, 0.5f, 20}});
    for (int n = 0; n < 12; ++n) {
      const int i = backwards ? 11 - n : n;
      scenes::add_moving(world, {1.25 * (i % 4), 0.5 + i / 4, 0}, Box{});
    }
    for (int i = 0; i < 120; ++i) world.step(scenes::kStepSeconds);
    return world;
  };
  const World forwards = build(false), backwards = build(true);
  EXPECT_NE(forwards.hash(), backwards.hash());
  for (std::size_t i = 0; i < 12; ++i) {
    const DVec3 a = forwards.bodies().poses[1 + i].position, b = backwards.bodies().poses[12 - i].position;
    EXPECT_LT(length(difference(a, b)), 1.0e-3f) << i;
  }
}

// B-25: the number of threads of a run may change on the way, by loading its snapshot.
TEST(WorkerCount, MayChangeMidRun) {
  const Scene& scene = kScenes[1];
  std::vector<std::byte> snapshot;
  {
    World world = make_world({});
    scene.build(world);
    snapshot = save_snapshot(world);
  }
  for (int part = 0; part < 6; ++part) {
    Result<World> world = load_snapshot(snapshot, with_threads(1 + part % 4));
    ASSERT_TRUE(world);
    EXPECT_TRUE(follows_golden(scene, *world, 50 * part, 50 * part + 50)) << part;
    snapshot = save_snapshot(*world);
  }
}

}  // namespace
}  // namespace gyre::determinism_test
