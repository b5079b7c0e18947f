#include "io/snapshot/motion_hash.h"

#include "determinism/scenes.h"
#include "world/world_access.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cstring>
#include <set>

namespace gyre::motion_hash_test {
namespace {

World make_pile(int steps) {
  World world = *World::create();
  scenes::kScenes[1].build(world);
  for (int i = 0; i < steps; ++i) world.step(scenes::kStepSeconds);
  return world;
}

template <class T>
void flip(T& value, int bit) {
  std::byte bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof value);
  bytes[bit / 8] ^= std::byte(1 << bit % 8);
  std::memcpy(static_cast<void*>(&value), bytes, sizeof value);
}

TEST(MotionHash, EveryBitOfWhatMovesMatters) {
  World world = make_pile(20);
  WorldState& state = state_of(world);
  ASSERT_FALSE(state.rigid.bodies.awake.empty());
  std::set<std::uint64_t> seen{hash_motion(state)};
  const auto try_bits = [&](auto& value) {
    for (int bit = 0; bit < int(8 * sizeof value); ++bit) {
      flip(value, bit);
      EXPECT_TRUE(seen.insert(hash_motion(state)).second) << bit;
      flip(value, bit);
    }
  };
  const std::uint32_t last = state.rigid.bodies.awake.back();
  BodyMotion& motion = state.rigid.bodies.motion[last];
  BodyPose& place = state.rigid.bodies.poses[last];
  try_bits(motion.linear_velocity), try_bits(motion.angular_velocity);
  try_bits(place.center), try_bits(place.orientation);
  try_bits(state.time), try_bits(state.step_count), try_bits(state.rigid.contacts.live);
  state.rigid.bodies.awake.pop_back();
  EXPECT_TRUE(seen.insert(hash_motion(state)).second);
}

TEST(MotionHash, IsThatOfALoadedWorldAfterTheSameStep) {
  World world = make_pile(20);
  World loaded = *load_snapshot(save_snapshot(world), {.threads = 2, .simd_width = 1});
  for (int i = 0; i < 200; ++i) {
    world.step(scenes::kStepSeconds);
    loaded.step(scenes::kStepSeconds);
    ASSERT_EQ(hash_motion(state_of(world)), hash_motion(state_of(loaded))) << i;
  }
}

// A body that fell asleep in the step is hashed, since its pose may have changed.
TEST(MotionHash, IncludesWhatFellAsleepInTheStep) {
  World world = *World::create();
  scenes::add_fixed(world, {}, Plane{});
  const BodyId box = scenes::add_moving(world, {0, 0.5, 0}, Box{});
  while (world.is_awake(box)) world.step(scenes::kStepSeconds);
  const std::uint64_t hash = hash_motion(state_of(world));
  state_of(world).rigid.bodies.poses[box.index].center.x += 0.25;
  EXPECT_NE(hash_motion(state_of(world)), hash);
}

}  // namespace
}  // namespace gyre::motion_hash_test
