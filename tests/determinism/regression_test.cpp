// What once made two runs differ, each as the smallest world that showed it.
#include "determinism/scenes.h"

#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cfenv>

namespace gyre::regression_test {
namespace {

using scenes::add_fixed;
using scenes::add_moving;
using scenes::kStepSeconds;

World make_world(const WorldDef& def = {}) {
  Result<World> made = World::create(def);
  EXPECT_TRUE(made) << made.error().message;
  return *std::move(made);
}

World copy_of(const World& world) {
  Result<World> loaded = load_snapshot(save_snapshot(world));
  EXPECT_TRUE(loaded) << loaded.error().message;
  return *std::move(loaded);
}

// A joint went on reading how far a body had moved in the last step before it was nailed down. A snapshot does not know.
TEST(Snapshot, GoesOnWithAJointToABodyThatWasNailedDown) {
  World world = make_world();
  const BodyId above = add_moving(world, {0, 4, 0}, Box{});
  const BodyId below = add_moving(world, {0, 2, 0}, Sphere{});
  scenes::join(world, JointKind::ball, above, below, {0, 3.5, 0});
  world.set_velocity(above, {3, 1, 0}, {0, 0, 2});
  world.step(kStepSeconds);
  world.set_type(above, BodyType::fixed);
  World loaded = copy_of(world);
  ASSERT_EQ(world.hash(), loaded.hash());
  for (int step = 0; step < 5; ++step) {
    world.step(kStepSeconds);
    loaded.step(kStepSeconds);
    ASSERT_EQ(world.hash(), loaded.hash()) << step;
  }
}

// Vertices that are pinned are held from the solve on; a loaded state does not know. What breaks before the solve asked whether they are.
TEST(Snapshot, GoesOnWithAPinnedSolidThatBreaks) {
  World world = make_world();
  const SoftId beam = world.add_solid({.box = SolidBox{{0.5f, 0.125f, 0.125f}, {6, 2, 2}},
                                       .young_modulus = 2.0e4f,
                                       .fracture_stress = 1000.0f});
  for (const int vertex : {0, 7, 14, 21, 28, 35, 42}) world.pin(beam, vertex);
  std::size_t torn = 0;
  for (int step = 0; step < 40; ++step) {
    World loaded = copy_of(world);
    world.step(kStepSeconds);
    loaded.step(kStepSeconds);
    ASSERT_EQ(world.hash(), loaded.hash()) << step;
    torn += world.events().torn.size();
  }
  EXPECT_GT(torn, 40u);
}

// A sheet that bodies squeeze cannot meet its contacts. That this was so in the last step shone into the first sub-step of sheets that came later.
TEST(Snapshot, GoesOnWithSheetsThatComeAfterASqueeze) {
  World world = make_world({.sleeping = false});
  add_fixed(world, {}, Plane{});
  const SoftId squeezed = world.add_cloth({.grid = ClothGrid{{1, 1}, {8, 8}},
                                           .pose = {{0, 0.05, 0}, {}},
                                           .stretch_stiffness = 2.0e3f,
                                           .self_collision = false});
  const BodyId body = world.add_body(
      {.type = BodyType::kinematic, .pose = {{0, 0.2, 0}, {}}, .linear_velocity = {0, -0.7f, 0}},
      {.geometry = Box{{0.3f, 0.1f, 0.3f}}});
  for (int step = 0; step < 20; ++step) world.step(kStepSeconds);
  world.remove_body(body);
  world.remove_soft(squeezed);
  SoftId upper;
  const ClothGrid grid{{1, 1}, {8, 8}};
  for (const double height : {0.1, 0.105})
    upper = world.add_cloth({.grid = grid, .pose = {{0, height, 0}, {}}, .thickness = 0.004f});
  world.set_vertices(upper, {}, std::vector<Vec3>(world.vertices(upper).size(), Vec3{0, -3, 0}));
  World loaded = copy_of(world);
  world.step(kStepSeconds);
  loaded.step(kStepSeconds);
  EXPECT_EQ(world.hash(), loaded.hash());
}

// The faces that a body cut went on bounding a liquid after the body had left it, where they were at a side.
TEST(Snapshot, GoesOnWithALiquidThatABodyHasLeft) {
  World world = make_world();
  LiquidDef liquid{.lower = {0, 0, 0}, .upper = {4, 1, 1}, .cell_size = 0.125f};
  liquid.fill = {{{0, 0, 0}, {0.5, 0.75, 1}}};
  world.add_liquid(liquid);
  const BodyId body = add_moving(world, {0.05, 0.3, 0.5}, Box{{0.15f, 0.15f, 0.15f}});
  world.set_velocity(body, {1, -3, 0}, {});
  for (int step = 0; step < 2; ++step) world.step(kStepSeconds);
  world.remove_body(body);
  World loaded = copy_of(world);
  for (int step = 0; step < 40; ++step) {
    world.step(kStepSeconds);
    loaded.step(kStepSeconds);
    ASSERT_EQ(world.hash(), loaded.hash()) << step;
  }
}

// A snapshot forgot the generations of ids once the last soft body or fluid was removed. The next one then had the id of one that is gone.
TEST(Snapshot, KeepsIdsOfSoftMatterAndFluidsThatAreGone) {
  World world = make_world();
  const SoftId rope = world.add_rope({.points = {{0, 0, 0}, {1, 0, 0}}});
  const FluidId gas = world.add_gas({.cells = {4, 4, 4}});
  world.remove_soft(rope);
  world.remove_fluid(gas);
  World loaded = copy_of(world);
  EXPECT_EQ(world.hash(), loaded.hash());
  EXPECT_NE(loaded.add_rope({.points = {{0, 0, 0}, {1, 0, 0}}}).generation, rope.generation);
  EXPECT_NE(loaded.add_gas({.cells = {4, 4, 4}}).generation, gas.generation);
}

// The fat box of a body that the step does not move was extended by its velocity, but only if a command had set that since the last step. A
// snapshot and a rollback do not know.
TEST(Snapshot, GoesOnWithADisabledBodyThatWasGivenAVelocity) {
  World world = make_world();
  const BodyId body = add_moving(world, {0, 4, 0}, Sphere{});
  world.set_enabled(body, false);
  world.step(kStepSeconds);
  world.set_velocity(body, {60, 0, 0}, {});
  World loaded = copy_of(world);
  world.step(kStepSeconds);
  loaded.step(kStepSeconds);
  EXPECT_EQ(world.hash(), loaded.hash());
}
TEST(Rollback, GoesOnWithAFrozenBodyThatWasGivenAVelocity) {
  World world = make_world();
  BodyDef light;
  light.mass = 1.0e-30f;
  const BodyId body = world.add_body(light, ShapeDef{.geometry = Sphere{}});
  world.add_force(body, {3.0e38f, 0, 0});
  world.step(kStepSeconds);
  ASSERT_EQ(world.problems().size(), 1u);  // of the body, which is frozen
  world.set_velocity(body, {60, 0, 0}, {});
  Rollback ring(1);
  ring.save(world);
  world.step(kStepSeconds);
  const std::uint64_t straight = world.hash();
  ASSERT_TRUE(ring.restore(world, 1));
  world.step(kStepSeconds);
  EXPECT_EQ(world.hash(), straight);
}

// The old rolling impulse of a surface that no longer brakes rolling acted once more, but only where another contact in the
// same block of lanes did brake it.
TEST(SimdWidth, DoesNotShowWhenASurfaceCeasesToBrakeRolling) {
  const Material braking{.rolling_friction = 0.05f};
  std::uint64_t hashes[3] = {};
  const int widths[3] = {1, 4, 8};
  for (int k = 0; k < 3; ++k) {
    World world = make_world({.simd_width = widths[k]});
    add_fixed(world, {}, Plane{});
    std::vector<BodyId> balls;
    for (int i = 0; i < 8; ++i) {
      balls.push_back(add_moving(world, {2.0 * i, 0.5, 0}, Sphere{}, braking));
      world.set_velocity(balls.back(), {0, 0, 4}, {8, 0, 0});
    }
    for (int step = 0; step < 10; ++step) world.step(kStepSeconds);
    for (int i = 0; i < 8; i += 2) world.set_material(world.shapes(balls[std::size_t(i)])[0], {});
    world.set_material(world.shapes(scenes::body_number(world, 0))[0], {});
    for (int step = 0; step < 10; ++step) world.step(kStepSeconds);
    hashes[k] = world.hash();
  }
  EXPECT_EQ(hashes[0], hashes[1]);
  EXPECT_EQ(hashes[0], hashes[2]);
}

// Constraints for which no colour was left share bodies, and were solved by several workers at once.
TEST(Threads, DoNotShowWhereABodyHasMoreConstraintsThanThereAreColors) {
  const auto outcome = [](int threads) {
    World world = make_world({.threads = threads});
    add_fixed(world, {}, Plane{});
    const BodyId plate = add_moving(world, {0, 0.5, 0}, Box{{6, 0.5f, 6}});
    for (int i = 0; i < 100; ++i) {
      const DVec3 place{1.125 * (i % 10) - 5, 1.5, 1.125 * (i / 10) - 5};
      const BodyId box = add_moving(world, place, Box{{0.5f, 0.5f, 0.5f}});
      world.set_velocity(box, {0.25f * float(i % 5), 0, 0.25f * float(i % 3)}, {});
    }
    for (int i = 0; i < 80; ++i) {
      const DVec3 place{0.125 * i - 5, 4, 0};
      const BodyId ball = add_moving(world, place + DVec3{0, 1, 2}, Sphere{0.0625f});
      scenes::join(world, JointKind::ball, plate, ball, place);
    }
    for (int step = 0; step < 20; ++step) world.step(kStepSeconds);
    return world.hash();
  };
  const std::uint64_t expected = outcome(1);
  for (int again = 0; again < 4; ++again) EXPECT_EQ(expected, outcome(2 + again)) << again;
}

// Large enough for shares that are cut where bodies are (dynamics/worker_partition): those of one kind in contact, others that hang on joints
// only, some without a body A.
TEST(Threads, DoNotShowInALargePile) {
  const auto outcome = [](int threads, int width) {
    World world = make_world({.threads = threads, .simd_width = width});
    add_fixed(world, {}, Plane{});
    for (int i = 0; i < 600; ++i) {
      const DVec3 place{1.0 * (i % 10) - 5 + 0.25 * (i / 100), 0.5 + 1.0 * (i / 100),
                        1.0 * (i / 10 % 10) - 5};
      const BodyId body = i % 3 == 0 ? add_moving(world, place, Sphere{0.5f}, {.rolling_friction = 0.02f})
                          : i % 7 == 0
                              ? add_moving(world, place, Capsule{.radius = 0.25f, .half_height = 0.25f})
                              : add_moving(world, place, Box{{0.5f, 0.5f, 0.5f}});
      world.set_velocity(body, {0.25f * float(i % 5), 0, 0.25f * float(i % 3)}, {0, float(i % 4), 0});
      if (i % 50 == 0) {
        const BodyId bob = add_moving(world, place + DVec3{0, 12, 0}, Sphere{0.125f});
        scenes::join(world, JointKind::ball, body, bob, place + DVec3{0, 11, 0});
      }
    }
    for (int step = 0; step < 25; ++step) world.step(kStepSeconds);
    EXPECT_GT(world.stats().touching, 600);  // of one island: all lie side by side
    return world.hash();
  };
  const std::uint64_t expected = outcome(1, 1);
  for (const int threads : {1, 2, 3, 8})
    for (const int width : {4, 16})
      EXPECT_EQ(expected, outcome(threads, width)) << threads << " threads, " << width << " lanes";
}

// Contacts leave rounding along a locked axis. Their effect that is repeated in the next half-step contained it where the batch had joints,
// and several workers have other batches than one.
TEST(Threads, DoNotShowInALockedBodyApartFromJoints) {
  const auto outcome = [](int threads) {
    World world = make_world({.threads = threads});
    add_fixed(world, {}, Plane{{0.6f, 0.8f, 0}, 0});
    const BodyId bob = add_moving(world, {0, 50, 0}, Sphere{0.125f});
    scenes::join(world, JointKind::ball, {}, bob, {0.5, 50, 0});
    for (int i = 0; i < 100; ++i) {
      BodyDef def;
      def.pose.position = {0, 0.625, 2.0 * i};
      def.linear_velocity = {0, 0, 0.25f};
      def.locked.linear[0] = true;
      world.add_body(def, ShapeDef{.geometry = Sphere{0.5f}});
    }
    for (int step = 0; step < 60; ++step) world.step(kStepSeconds);
    EXPECT_EQ(world.stats().touching, 100);
    return world.hash();
  };
  const std::uint64_t expected = outcome(1);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(expected, outcome(threads)) << threads;
}

// A hinge whose body cannot rotate has angular impulses of zero, some of them negative. Where its neighbour's limit acted, zeros were added,
// which made them positive.
TEST(SimdWidth, DoesNotShowInZerosOfHingesBesideALimit) {
  const auto outcome = [](int width) {
    World world = make_world({.simd_width = width});
    for (int i = 0; i < 16; ++i) {
      BodyDef def;
      def.pose.position = {3.0 * i, 0, 0};
      for (bool& locked : def.locked.angular) locked = i % 2 == 0;
      HingeDef hinge;
      hinge.b = world.add_body(def, ShapeDef{.geometry = Box{{0.5f, 0.5f, 0.5f}}});
      hinge.anchor = DVec3{3.0 * i - 0.75, 0, 0};
      hinge.axis = {0.25f * float(i % 3) - 0.25f, 0.25f * float(i % 5) - 0.5f, 1};
      hinge.limits = Limits{-0.25f, 0.25f};
      world.add_joint(hinge);
    }
    for (int step = 0; step < 60; ++step) world.step(kStepSeconds);
    return world.hash();
  };
  const std::uint64_t expected = outcome(1);
  for (const int width : {4, 8, 16}) EXPECT_EQ(expected, outcome(width)) << width;
}

// Ends of contacts were told in the order of a list that a loaded world builds anew.
TEST(Events, OfALoadedWorldComeInTheSameOrder) {
  World world = make_world();
  const BodyId floor = add_fixed(world, {0, -0.5, 0}, Box{{10, 0.5f, 10}});
  std::vector<ShapeDef> feet(4);
  for (std::size_t i = 0; i < feet.size(); ++i) {
    feet[i].geometry = Box{{0.125f, 0.125f, 0.125f}};
    feet[i].local.position = {0.75f * float(i) - 1.0f, 0, 0};
  }
  BodyDef table;
  table.pose.position = {0, 0.125, 0};
  const BodyId body = world.add_body(table, feet);
  for (int step = 0; step < 3; ++step) world.step(kStepSeconds);
  // Away and back, so that the contacts are found in another order than that of their slots.
  world.set_filter(world.shapes(body)[0], {});
  for (int step = 0; step < 3; ++step) world.step(kStepSeconds);
  World loaded = copy_of(world);
  std::vector<std::uint32_t> order[2];
  World* const worlds[2] = {&world, &loaded};
  for (int k = 0; k < 2; ++k) {
    const BodyId a = scenes::body_number(*worlds[k], 0), b = scenes::body_number(*worlds[k], 1);
    scenes::join(*worlds[k], JointKind::fixed, a, b, {});
    worlds[k]->step(kStepSeconds);
    for (const ContactEnd& end : worlds[k]->events().ends) order[k].push_back(end.shape_b.index);
  }
  EXPECT_TRUE(world.exists(floor));
  EXPECT_EQ(order[0].size(), 4u);
  EXPECT_EQ(order[0], order[1]);
}

// Only what ran in blocks kept the host's rounding out; commands, loading, cooking, readings and the hash did not.
TEST(HostRounding, DoesNotShow) {
  const auto outcome = [](int rounding) {
    std::fesetround(rounding);
    World world = make_world();
    add_fixed(world, {}, Plane{{0.1f, 1, 0.3f}, 0.1f});
    const float heights[] = {0, 0.3f, 0.1f, 0.7f, 0.2f, 0.1f, 0.9f, 0.3f, 0.1f};
    if (const Result<Geometry> field = cook_height_field({heights, 3, 3, 0.7f}))
      add_fixed(world, {0, 0.2, 0}, *field);
    const Vec3 corners[] = {
        {0.3f, 0, 0}, {-0.3f, 0.1f, 0}, {0, 0.4f, 0.1f}, {0.1f, 0.1f, 0.3f}, {0, -0.2f, -0.3f}};
    const Result<Geometry> cooked = cook_hull(corners);
    if (!cooked) return std::pair(std::uint64_t(0), 0.0);
    const BodyId hull = add_moving(world, {0.1, 2, 0.2}, *cooked);
    const BodyId cone = add_moving(world, {0.3, 3, 0.1}, Cone{0.3f, 0.7f});
    scenes::join(world, JointKind::hinge, hull, cone, {0.2, 2.5, 0.1}, {0.3f, 0.1f, 0.7f});
    world.add_impulse_at(cone, {3, 7, 0.1f}, {0.7, 3.1, 0.3});
    for (int step = 0; step < 60; ++step) world.step(0.01f);
    Result<World> loaded = load_snapshot(save_snapshot(world));
    EXPECT_TRUE(loaded);
    for (int step = 0; step < 60; ++step) loaded->step(0.01f);
    const std::uint64_t hash = loaded->hash();
    const double kinetic = loaded->energy().kinetic;
    std::fesetround(FE_TONEAREST);
    return std::pair(hash, kinetic);
  };
  const auto expected = outcome(FE_TONEAREST);
  EXPECT_NE(expected.first, 0u);
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO})
    EXPECT_EQ(expected, outcome(rounding)) << rounding;
}

}  // namespace
}  // namespace gyre::regression_test
