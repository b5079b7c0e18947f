#include "io/snapshot/state_copy.h"

#include "determinism/scenes.h"
#include "world/world_access.h"

#include <gtest/gtest.h>

namespace gyre::state_copy_test {
namespace {

using scenes::kScenes;
using scenes::Scene;
using scenes::step_scene;

struct ManifoldCount {
  std::size_t used = 0, points = 0, room = 0;
};
ManifoldCount count_manifolds(const WorldState& state) {
  const ContactStore& store = state.rigid.contacts;
  ManifoldCount count;
  for (const Contact& contact : store.contacts) {
    for (const Manifold& manifold : manifolds_of(store, contact)) {
      ++count.used;
      count.points += std::size_t(manifold.count);
    }
  }
  count.room = store.manifolds.size();
  return count;
}

// The size of a state with each array at full length.
struct ColumnBytes {
  std::size_t bytes = 0;

  template <class T>
  void operator()(const char*, const Array<T>& column) {
    bytes += column.size() * sizeof(T);
  }
  template <IsColumn T>
  void operator()(const char*, const T& column) {
    bytes += column.bytes();
  }
  void operator()(const char*, const IdPool& ids) { bytes += ids.bytes(); }
  void operator()(const char*, const std::vector<AnyShape>& shapes) { bytes += shapes.size() * sizeof(AnyShape); }
  template <class T>
  void operator()(const char*, const T&) {
    bytes += sizeof(T);
  }
};

class KeptStates : public testing::TestWithParam<Scene> {};

// Restores a state to itself, to a later state of the same world, and to a world that never had it.
TEST_P(KeptStates, ArePutBackToTheLastBit) {
  const Scene& scene = GetParam();
  World world = *World::create();
  scene.build(world);
  for (int i = 0; i < 60; ++i) step_scene(scene, world, i);
  const std::uint64_t hash = world.hash();
  StateCopy copy;
  copy.save(state_of(world));
  EXPECT_EQ(copy.step_count(), world.step_count());
  copy.restore(state_of(world));
  EXPECT_EQ(world.hash(), hash);
  for (int i = 60; i < 120; ++i) step_scene(scene, world, i);
  const std::uint64_t later = world.hash();
  copy.restore(state_of(world));
  EXPECT_EQ(world.hash(), hash);
  EXPECT_EQ(find_fault(state_of(world).rigid.contacts), nullptr);
  for (int i = 60; i < 120; ++i) step_scene(scene, world, i);
  EXPECT_EQ(world.hash(), later);

  World other = *World::create();
  copy.restore(state_of(other));
  EXPECT_EQ(other.hash(), hash);
  EXPECT_EQ(find_fault(state_of(other).rigid.contacts), nullptr);
}

// A second save leaves nothing of the first.
TEST_P(KeptStates, ReplaceEachOther) {
  const Scene& scene = GetParam();
  World world = *World::create();
  scene.build(world);
  StateCopy copy;
  std::uint64_t hash = 0;
  for (int i = 0; i < 90; ++i) {
    if (i % 30 == 0) {
      hash = world.hash();
      copy.save(state_of(world));
    }
    step_scene(scene, world, i);
  }
  copy.restore(state_of(world));
  EXPECT_EQ(world.hash(), hash);
  EXPECT_EQ(world.step_count(), 60u);
}

INSTANTIATE_TEST_SUITE_P(Scenes, KeptStates, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

// Data for the next step: events of removed objects, and boxes that the broad phase has not seen.
TEST(StateCopy, KeepsWhatWaitsForTheNextStep) {
  World world = *World::create({.gravity = {}, .sleeping = false});
  const BodyId wall = scenes::add_fixed(world, {5, 0, 0}, Box{});
  const BodyId low = scenes::add_fixed(world, {0, -0.99, 0}, Box{});
  scenes::add_moving(world, {0, 0, 0}, Box{});
  for (int i = 0; i < 3; ++i) world.step(scenes::kStepSeconds);
  ASSERT_EQ(world.stats().touching, 1);
  world.remove_body(low);
  world.set_pose(wall, {{0.99, 0, 0}, {}});
  StateCopy copy;
  copy.save(state_of(world));
  std::uint64_t hash = 0;
  for (int run = 0; run < 2; ++run) {
    world.step(scenes::kStepSeconds);
    EXPECT_EQ(world.events().ends.size(), 1u) << run;
    EXPECT_EQ(world.events().begins.size(), 1u) << run;
    if (run == 0) hash = world.hash();
    EXPECT_EQ(world.hash(), hash);
    copy.restore(state_of(world));
  }
}

// Balls on a diagonal that do not touch, but whose boxes do.
TEST(StateCopy, HoldsNothingOfManifoldsThatAreNotInUse) {
  World world = *World::create({.gravity = {}});
  for (int i = 0; i < 400; ++i) scenes::add_moving(world, {0.9 * i, 0.9 * i, 0}, Sphere{0.5f});
  for (int i = 0; i < 2; ++i) world.step(scenes::kStepSeconds);
  const ManifoldCount count = count_manifolds(state_of(world));
  ASSERT_GT(count.room, 300u) << count.used;
  ASSERT_LT(count.used, 10u) << count.room;
  ColumnBytes all;
  for_each_column(state_of(world), all);
  StateCopy copy;
  copy.save(state_of(world));
  // Arrays begin on cache lines of their own and grow by an eighth.
  EXPECT_LT(copy.bytes(), (all.bytes - count.room * sizeof(Manifold)) * 9 / 8 + 32 * 128);
}

}  // namespace
}  // namespace gyre::state_copy_test
