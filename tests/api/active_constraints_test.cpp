// Sleeping islands have no active constraints, and visiting theirs all the same changes nothing.
#include "determinism/random_world.h"
#include "determinism/scenes.h"
#include "rigid/store/active_constraints.h"
#include "world/validate_state.h"
#include "world/world_access.h"
#include "world/world_state.h"

#include <gtest/gtest.h>

namespace gyre::active_constraints_test {
namespace {

ActiveConstraints& constraints_of(World& world) { return state_of(world).rigid.active_constraints; }

// `columns` stacks of two boxes each, side by side on a thin plate.
World make_stacks(int columns) {
  Result<World> world = World::create();
  EXPECT_TRUE(world);
  scenes::add_fixed(*world, {0, -0.05, 0}, Box{{100, 0.05f, 100}});
  for (int i = 0; i < columns; ++i)
    for (int k = 0; k < 2; ++k) scenes::add_moving(*world, {3.0 * (i % 8), 0.5 + k, 3.0 * (i / 8)}, Box{});
  return std::move(*world);
}

TEST(ActiveConstraints, SleepingIslandsHaveNone) {
  World world = make_stacks(16);
  const BodyId low = scenes::add_moving(world, {-8, 0.25, 0}, Box{{0.25f, 0.25f, 0.25f}});
  const BodyId high = scenes::add_moving(world, {-8, 0.75, 0}, Box{{0.25f, 0.25f, 0.25f}});
  world.add_joint(FixedDef{.a = low, .b = high, .anchor = {-8, 0.5, 0}});
  world.step(scenes::kStepSeconds);
  EXPECT_EQ(constraints_of(world).contacts.count(), constraints_of(world).contacts.size()) << "nobody sleeps";
  for (int i = 0; i < 120; ++i) world.step(scenes::kStepSeconds);
  ASSERT_EQ(world.stats().awake_bodies, 0);
  ASSERT_GT(world.stats().touching, 32);
  EXPECT_EQ(constraints_of(world).contacts.count(), 0u);
  EXPECT_EQ(constraints_of(world).joints.count(), 0u);
  // One stack is pushed: two boxes have two contacts.
  world.set_velocity(scenes::body_number(world, 1), {0.5f, 0, 0}, {});
  world.step(scenes::kStepSeconds);
  EXPECT_EQ(world.stats().awake_bodies, 2);
  EXPECT_EQ(constraints_of(world).contacts.count(), 2u);
  EXPECT_EQ(constraints_of(world).joints.count(), 0u);
}

// Must hold between steps, too: tools may read a world before its next step.
TEST(ActiveConstraints, IncludeThoseOfABodyThatBeginsToMove) {
  World world = make_stacks(16);
  const BodyId hook = scenes::add_fixed(world, {0, 5, 8}, Sphere{0.5f});
  const JointId joint = world.add_joint(BallDef{.b = hook, .anchor = {0, 6, 8}});
  for (int i = 0; i < 120; ++i) world.step(scenes::kStepSeconds);
  EXPECT_FALSE(constraints_of(world).joints.test(joint.index)) << "nothing can move it";
  world.set_type(hook, BodyType::dynamic);
  EXPECT_TRUE(constraints_of(world).joints.test(joint.index));
  EXPECT_EQ(validate_state(state_of(world)).code, ErrorCode::none);
}

// The joint keeps its impulse of the step in which it fell asleep. Divided by a shorter step it would be a larger
// force.
TEST(ActiveConstraints, ASleepingJointDoesNotBreakInAShorterStep) {
  // Alone, and among many that fall.
  for (const int falling : {0, 16}) {
    World world = make_stacks(0);
    for (int i = 0; i < falling; ++i) scenes::add_moving(world, {3.0 * i, 1000, 0}, Sphere{0.5f});
    const BodyId weight = scenes::add_moving(world, {0, 5, 8}, Sphere{0.5f});
    const float load = 9.81f * world.mass_properties(weight).mass;
    const JointId joint =
        world.add_joint(BallDef{.b = weight, .anchor = {0, 5, 8}, .break_force = 1.5f * load});
    for (int i = 0; i < 120; ++i) world.step(scenes::kStepSeconds);
    ASSERT_FALSE(world.is_awake(weight));
    world.step(0.25f * scenes::kStepSeconds);
    EXPECT_TRUE(world.exists(joint));
  }
}

// Two worlds, one with active constraints and one that visits all. Counts the steps in which the first visited fewer.
struct WorldPair {
  World active, all;
  int reduced_steps = 0;

  WorldPair(World first, World second) : active(std::move(first)), all(std::move(second)) {
    constraints_of(all).all = true;
  }
  template <class Drive>
  void step(Drive&& drive) {
    for (World* const world : {&active, &all}) {
      drive(*world);
      world->step(scenes::kStepSeconds);
    }
    const Bitset& contacts = constraints_of(active).contacts;
    reduced_steps += contacts.count() < contacts.size() ? 1 : 0;
    EXPECT_EQ(constraints_of(all).contacts.count(), constraints_of(all).contacts.size());
  }
  bool are_equal() const {
    const Events &a = active.events(), &b = all.events();
    return hash_state(state_of(active)) == hash_state(state_of(all)) && a.begins.size() == b.begins.size() &&
           a.ends.size() == b.ends.size() && a.hits.size() == b.hits.size() &&
           a.sleep_changes.size() == b.sleep_changes.size();
  }
};

// Returns the number of steps with fewer active constraints than all.
int compare_random_worlds(std::uint32_t first, std::uint32_t count, TimeStepping time) {
  int reduced_steps = 0;
  for (std::uint32_t number = first; number < first + count; ++number) {
    scenes::RandomWorld one(number), other(number);
    WorldDef def = one.def();
    def.sleeping = true;
    def.stepping.time = time;
    WorldPair pair(*World::create(def), *World::create(def));
    one.build(pair.active), other.build(pair.all);
    for (int step = 0; step < 300; ++step) {
      // Long pauses, in which some bodies fall asleep.
      pair.step([&](World& world) {
        if (step % 100 < 3) (&world == &pair.active ? one : other).drive(world, step);
      });
      EXPECT_TRUE(pair.are_equal()) << "world " << number << ", step " << step;
      if (testing::Test::HasFailure()) return 0;
    }
    reduced_steps += pair.reduced_steps;
  }
  return reduced_steps;
}
TEST(ActiveConstraints, VisitingAllChangesNothingInRandomWorlds) {
  EXPECT_GT(compare_random_worlds(1, 20, TimeStepping::fixed), 500);
}
// Islands may fall asleep between the pieces of an adaptive step.
TEST(LongActiveConstraints, VisitingAllChangesNothingInAdaptiveSteps) {
  EXPECT_GT(compare_random_worlds(100, 4, TimeStepping::adaptive), 50);
}

// A sleeping body that is shot is fast in the step in which it wakes, and the plate below is thin.
TEST(ActiveConstraints, VisitingAllChangesNothingWhereSleepersAreShot) {
  WorldPair pair(make_stacks(40), make_stacks(40));
  for (int i = 0; i < 120; ++i) pair.step([](World&) {});
  ASSERT_EQ(pair.active.stats().awake_bodies, 0);
  for (int step = 0; step < 200; ++step) {
    pair.step([&](World& world) {
      if (step % 10 != 0) return;
      const int target = step / 10 * 2;
      const DVec3 above{3.0 * (target % 8), 12, 3.0 * (target / 8)};
      BodyDef def;
      def.pose.position = above;
      def.linear_velocity = {0, -400, 0};
      def.mass = 2000.0f;
      ShapeDef shape;
      shape.geometry = Sphere{0.3f};
      ASSERT_TRUE(world.exists(world.add_body(def, shape)));
    });
    ASSERT_TRUE(pair.are_equal()) << step;
  }
  EXPECT_GT(pair.reduced_steps, 150);
}

// A sleeping body is hit and does not leave its fat box. Its CCD blockers must be known, although the narrow phase
// did not visit them in that step. Boxes are put to sleep in flight before walls as thin as paper, which their fat
// boxes overlap.
TEST(ActiveConstraints, VisitingAllChangesNothingWhereWallsStopSleepers) {
  constexpr int kBoxes = 100;
  const auto make = [] {
    Result<World> world = World::create({.gravity = {}});
    scenes::Random random(5);
    for (int i = 0; i < kBoxes; ++i) {
      const BodyId box = scenes::add_moving(*world, {0, 0, 2.0 * i}, Box{{0.1f, 0.1f, 0.1f}});
      world->set_velocity(box, {12, 0, 0}, {});
      scenes::add_fixed(*world, {0.3 + double(random.next(0.005f, 0.15f)), 0, 2.0 * i}, Box{{0.0005f, 0.5f, 0.5f}});
    }
    world->step(scenes::kStepSeconds);
    for (int i = 0; i < kBoxes; ++i) world->set_awake(scenes::body_number(*world, std::size_t(2 * i)), false);
    return std::move(*world);
  };
  WorldPair pair(make(), make());
  for (int i = 0; i < 3; ++i) pair.step([](World&) {});
  ASSERT_EQ(pair.active.stats().awake_bodies, 0);
  scenes::Random random(6);
  for (int i = 0; i < kBoxes; ++i) {
    const float speed = random.next(2.0f, 12.0f);
    pair.step([&](World& world) {
      BodyDef def;
      def.pose.position = {-0.1, 0, 2.0 * i};
      def.linear_velocity = {speed, 0, 0};
      def.mass = 500.0f;
      ShapeDef shape;
      shape.geometry = Sphere{0.08f};
      world.add_body(def, shape);
    });
    ASSERT_TRUE(pair.are_equal()) << i;
  }
  EXPECT_GT(pair.reduced_steps, 60);
}

}  // namespace
}  // namespace gyre::active_constraints_test
