#include "io/snapshot/snapshot.h"

#include "determinism/scenes.h"
#include "world/world_access.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cstring>

namespace gyre::snapshot_test {
namespace {

using scenes::kScenes;
using scenes::Scene;
using scenes::step_scene;

const Scene& scene_named(const char* name) {
  for (const Scene& scene : kScenes) {
    if (std::strcmp(scene.name, name) == 0) return scene;
  }
  return kScenes[0];
}

World make_scene(const Scene& scene, int steps) {
  World world = *World::create();
  scene.build(world);
  for (int i = 0; i < steps; ++i) step_scene(scene, world, i);
  return world;
}

class SnapshotOfScene : public testing::TestWithParam<Scene> {};

// At several moments, the first before any step: right after commands.
TEST_P(SnapshotOfScene, GoesOnBitForBit) {
  World straight = make_scene(GetParam(), 0);
  int step = 0;
  for (const int moment : {0, 1, 7, 60, 150, 220}) {
    for (; step < moment; ++step) step_scene(GetParam(), straight, step);
    const std::vector<std::byte> bytes = save_snapshot(straight);
    Result<World> loaded = load_snapshot(bytes);
    ASSERT_TRUE(loaded) << loaded.error().message;
    EXPECT_EQ(loaded->hash(), straight.hash());
    EXPECT_EQ(save_snapshot(*loaded), bytes) << "saving what was loaded gives the same bytes";
    for (int i = 0; i < 25; ++i, ++step) {
      step_scene(GetParam(), straight, step);
      step_scene(GetParam(), *loaded, step);
      ASSERT_EQ(loaded->hash(), straight.hash())
          << "saved after " << moment << " steps, " << i + 1 << " later";
    }
    EXPECT_EQ(loaded->time(), straight.time());
    EXPECT_EQ(loaded->step_count(), straight.step_count());
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, SnapshotOfScene, testing::ValuesIn(kScenes),
                         [](const auto& tested) { return std::string(tested.param.name); });

TEST(Snapshot, OfAnEmptyWorld) {
  World world = *World::create();
  Result<World> loaded = load_snapshot(save_snapshot(world));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->hash(), world.hash());
  EXPECT_TRUE(loaded->step(0.01f));
}

TEST(Snapshot, SleepersStaySleepersAndWakeTogether) {
  const Scene& scene = scene_named("pusher");
  World world = make_scene(scene, 119);
  ASSERT_LT(world.stats().awake_bodies, 15) << "the scene sleeps by now";
  Result<World> loaded = load_snapshot(save_snapshot(world));
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->stats().awake_bodies, world.stats().awake_bodies);
  for (int i = 119; i < 240; ++i) {
    step_scene(scene, world, i);
    step_scene(scene, *loaded, i);
    ASSERT_EQ(loaded->hash(), world.hash()) << i;
  }
}

// Commands between loading and the first step use derived data of the loaded state.
TEST(Snapshot, CommandsAfterLoadingHaveTheSameEffect) {
  const Scene& scene = scene_named("changes");
  World world = make_scene(scene, 100);
  scene.drive(world, 100);
  Result<World> loaded = load_snapshot(save_snapshot(world));
  ASSERT_TRUE(loaded) << loaded.error().message;
  for (World* w : {&world, &*loaded}) {
    for (std::size_t i = 2; i < 10; ++i) {
      const BodyId body = scenes::body_number(*w, i);
      w->add_impulse_at(body, {10, 20, 30}, w->center_of_mass(body) + DVec3{0.125, 0.25, 0.5});
      w->set_pose(body, {w->pose(body).position + DVec3{0, 0.03125, 0}, w->pose(body).orientation});
      w->add_shape(body, {.geometry = Sphere{0.125f}, .local = {{0.3f, 0.1f, 0.7f}, {}}});
    }
    w->remove_body(scenes::body_number(*w, 5));
  }
  EXPECT_EQ(loaded->hash(), world.hash());
  for (int i = 0; i < 20; ++i) {
    world.step(scenes::kStepSeconds);
    loaded->step(scenes::kStepSeconds);
    ASSERT_EQ(loaded->hash(), world.hash()) << i;
  }
}

TEST(Snapshot, RestoringKeepsIdsValid) {
  World world = *World::create();
  const BodyId body = scenes::add_moving(world, {0, 5, 0}, Sphere{});
  const std::vector<std::byte> bytes = save_snapshot(world);
  const BodyId later = scenes::add_moving(world, {3, 5, 0}, Sphere{});
  world.remove_body(body);
  world.step(0.01f);
  EXPECT_FALSE(world.exists(body));
  const Error e = restore_snapshot(world, bytes);
  ASSERT_EQ(e.code, ErrorCode::none) << e.message;
  EXPECT_TRUE(world.exists(body));
  EXPECT_FALSE(world.exists(later));
  EXPECT_TRUE(world.set_velocity(body, {1, 0, 0}, {}));
  EXPECT_EQ(world.step_count(), 0u);
  EXPECT_TRUE(world.events().begins.empty());
}

TEST(Snapshot, RestoringSharesGeometry) {
  World world = make_scene(scene_named("terrain"), 3);
  const auto cooked = [&] {
    return std::get<Geometry>(*world.geometry(world.shapes(scenes::body_number(world, 0))[0])).data();
  };
  const CookedGeometry* const before = cooked();
  ASSERT_EQ(restore_snapshot(world, save_snapshot(world)).code, ErrorCode::none);
  EXPECT_EQ(cooked(), before);
}

TEST(Snapshot, LoadsAtAnyThreadsAndWidth) {
  const Scene& scene = scene_named("pile");
  World world = make_scene(scene, 50);
  WorldDef def;
  def.threads = 2;
  def.simd_width = 1;
  def.stepping.broad_phase = BroadPhaseKind::brute_force;
  Result<World> loaded = load_snapshot(save_snapshot(world), def);
  ASSERT_TRUE(loaded);
  for (int i = 50; i < 80; ++i) {
    step_scene(scene, world, i);
    step_scene(scene, *loaded, i);
  }
  EXPECT_EQ(loaded->hash(), world.hash());
  def.simd_width = 3;
  EXPECT_EQ(load_snapshot(save_snapshot(world), def).error().code, ErrorCode::invalid_argument);
}

// ------------------------------------------------------------------------------------------------------ outside data

class DamagedSnapshot : public testing::Test {
 protected:
  DamagedSnapshot()
      : world_(make_scene(scene_named("joints"), 20)), good_(save_snapshot(world_)), hash_(world_.hash()) {}

  void expect_refused(std::span<const std::byte> bytes, ErrorCode code, const char* what) {
    const Error e = restore_snapshot(world_, bytes);
    EXPECT_EQ(e.code, code) << what << ": " << e.message;
    EXPECT_NE(e.message[0], 0) << what;
    EXPECT_EQ(world_.hash(), hash_) << what;
    EXPECT_FALSE(load_snapshot(bytes)) << what;
  }

  World world_;
  std::vector<std::byte> good_;
  std::uint64_t hash_;
};

TEST_F(DamagedSnapshot, EveryLength) {
  for (std::size_t length = 0; length < good_.size(); length += 1 + length / 7) {
    expect_refused(std::span(good_).first(length), ErrorCode::invalid_data, "cut");
  }
  std::vector<std::byte> longer = good_;
  longer.push_back(std::byte(0));
  expect_refused(longer, ErrorCode::invalid_data, "longer");
}

TEST_F(DamagedSnapshot, EveryFlippedBitIsNoticed) {
  for (std::size_t place = 0; place < good_.size(); place += 1 + place / 40) {
    if (place >= 12 && place < 16) continue;  // spare
    std::vector<std::byte> bytes = good_;
    bytes[place] ^= std::byte(1 << place % 8);
    EXPECT_NE(restore_snapshot(world_, bytes).code, ErrorCode::none) << place;
  }
  EXPECT_EQ(world_.hash(), hash_);
}

TEST_F(DamagedSnapshot, AnotherVersion) {
  std::vector<std::byte> bytes = good_;
  bytes[8] = std::byte(kSnapshotVersion + 1);
  expect_refused(bytes, ErrorCode::unsupported, "version");
}

// Replaces the first occurrence of a column's name and seals the snapshot again.
std::vector<std::byte> with_name(std::vector<std::byte> bytes, std::string_view from, std::string_view to) {
  for (std::size_t i = 0; i + from.size() <= bytes.size(); ++i) {
    if (std::memcmp(bytes.data() + i, from.data(), from.size()) != 0) continue;
    std::memcpy(bytes.data() + i, to.data(), to.size());
    break;
  }
  reseal_snapshot(bytes);
  return bytes;
}

TEST_F(DamagedSnapshot, ColumnsMissingOrUnknownOrTwice) {
  expect_refused(with_name(good_, "body_masses", "body_passes"), ErrorCode::invalid_data, "missing");
  expect_refused(with_name(good_, "body_sleep", "body_flags"), ErrorCode::invalid_data, "twice");
}

TEST_F(DamagedSnapshot, AnotherLayoutIsNamed) {
  std::vector<std::byte> bytes = good_;
  constexpr std::string_view kName = "body_places";
  for (std::size_t i = 0; i + kName.size() < bytes.size(); ++i) {
    if (std::memcmp(bytes.data() + i, kName.data(), kName.size()) != 0) continue;
    bytes[i + kName.size()] ^= std::byte(1);
    break;
  }
  reseal_snapshot(bytes);
  expect_refused(bytes, ErrorCode::unsupported, "layout");
  EXPECT_NE(std::strstr(restore_snapshot(world_, bytes).message, "body_places"), nullptr);
}

// The checksum is valid, so the data must be checked itself: refused, or a state that can be stepped.
TEST_F(DamagedSnapshot, SealedAgainIsRefusedOrRuns) {
  int refused = 0, ran = 0;
  scenes::Random random(5);
  for (int i = 0; i < 1500; ++i) {
    std::vector<std::byte> bytes = good_;
    for (int flips = 1 + i % 3; flips > 0; --flips) {
      const auto place = std::size_t(random.next(0, float(bytes.size() - 33)));
      bytes[32 + place] = std::byte(int(random.next(0, 256)));
    }
    reseal_snapshot(bytes);
    Result<World> loaded = load_snapshot(bytes);
    if (!loaded) {
      ++refused;
      continue;
    }
    ++ran;
    for (int k = 0; k < 3; ++k) loaded->step(0.01f);
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(ran, 50);
}

// ------------------------------------------------------------------------------- columns that do not hang together

template <class Change>
Error reload(int steps, const char* scene, Change&& change) {
  World world = make_scene(scene_named(scene), steps);
  change(state_of(world).rigid);
  return load_snapshot(save_snapshot(world)).error();
}

TEST(SnapshotCheck, RingsThatNeverCloseAreRefused) {
  EXPECT_EQ(reload(119, "pusher", [](RigidWorld&) {}).code, ErrorCode::none);
  const Error e = reload(119, "pusher", [](RigidWorld& w) {
    // A ring that returns to its second member: a walk from the first would never end.
    for (std::uint32_t i = 0; i < w.bodies.sleep.size(); ++i) {
      if (w.bodies.sleep[i].group != kNoGroup && w.bodies.sleep[i].group != i)
        w.bodies.sleep[i].next_in_group = i;
    }
  });
  EXPECT_EQ(e.code, ErrorCode::invalid_data) << e.message;
}

// The first contact that is in use.
Contact& live_contact(RigidWorld& w) {
  std::size_t i = 0;
  while (w.contacts.contacts[i].manifold_room == 0) ++i;
  return w.contacts.contacts[i];
}

TEST(SnapshotCheck, EveryLinkIsChecked) {
  const auto refused = [](auto change) {
    return reload(60, "joints", change).code == ErrorCode::invalid_data;
  };
  EXPECT_FALSE(refused([](RigidWorld&) {}));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.settings.substeps = 0; }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.settings.last_substep = __builtin_nanf(""); }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.bodies.poses[2].center.x = __builtin_nan(""); }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.bodies.motion[2].linear_velocity.y = __builtin_inff(); }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.bodies.flags.pop_back(); }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.bodies.flags[3].awake = 0; }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.shapes.bodies[1] = 100000; }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.shapes.proxies[1].body = 0; }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.shapes.proxies[1].fat_box.low.x = __builtin_nanf(""); }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.shapes.geometry[1] = Sphere{-1}; }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.joints.records[0].body_b = 4000; }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.joints.records[0].body_b = kNoBody; }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.contacts.manifolds.resize(w.contacts.manifolds.size() - 1); }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.contacts.contacts.push_back(live_contact(w)); }));
  EXPECT_TRUE(refused([](RigidWorld& w) { live_contact(w).first_manifold = 0xfffffff8u; }));
  EXPECT_TRUE(refused([](RigidWorld& w) { w.contacts.manifolds[0].count = 5; }));
}

}  // namespace
}  // namespace gyre::snapshot_test
