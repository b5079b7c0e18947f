// Settings while a world runs: each is read back, is kept by recordings and snapshots if it matters for what happens, and is
// no part of either if it does not.
#include "determinism/scenes.h"
#include "laws/kit.h"
#include "memory_sink.h"

#include <gyre/debug.h>

namespace gyre::laws::settings_test {
namespace {

void expect_equal(const WorldDef& a, const WorldDef& b) {
  EXPECT_EQ(a.gravity, b.gravity);
  EXPECT_EQ(a.sleeping, b.sleeping);
  EXPECT_EQ(a.friction_rule, b.friction_rule);
  EXPECT_EQ(a.restitution_rule, b.restitution_rule);
  EXPECT_EQ(a.stepping.substeps, b.stepping.substeps);
  EXPECT_EQ(a.stepping.broad_phase, b.stepping.broad_phase);
  EXPECT_EQ(a.threads, b.threads);
  EXPECT_EQ(a.simd_width, b.simd_width);
}

TEST(Settings, AreReadBackAsTheyWereMade) {
  const WorldDef def{.gravity = {1, 2, 3},
                     .threads = 2,
                     .simd_width = 4,
                     .stepping = {.substeps = 7, .broad_phase = BroadPhaseKind::brute_force},
                     .sleeping = false,
                     .friction_rule = CombineRule::average,
                     .restitution_rule = CombineRule::minimum};
  expect_equal(make_world(def).def(), def);
  expect_equal(make_world().def(), WorldDef{});
}

TEST(Settings, AreReadBackAsTheyWereChanged) {
  World world = make_world();
  EXPECT_TRUE(world.set_gravity({0, -1.6f, 0}));
  EXPECT_TRUE(world.set_substeps(9));
  EXPECT_TRUE(world.set_sleeping(false));
  EXPECT_TRUE(world.set_combine_rules(CombineRule::product, CombineRule::average));
  EXPECT_TRUE(world.set_threads(3));
  EXPECT_TRUE(world.set_broad_phase(BroadPhaseKind::brute_force));
  expect_equal(world.def(), {.gravity = {0, -1.6f, 0},
                             .threads = 3,
                             .stepping = {.substeps = 9, .broad_phase = BroadPhaseKind::brute_force},
                             .sleeping = false,
                             .friction_rule = CombineRule::product,
                             .restitution_rule = CombineRule::average});
  world.step(kStep);
  // A world of that def and this one's snapshot goes on with the same bits.
  Result<World> other = load_snapshot(save_snapshot(world), world.def());
  ASSERT_TRUE(other);
  expect_equal(other->def(), world.def());
}

TEST(Settings, OfBodiesShapesAndJointsAreReadBack) {
  World world = *World::create();
  const BodyDef def{.pose = {.position = {1, 2, 3}},
                    .linear_damping = 0.25f,
                    .angular_damping = 0.5f,
                    .gravity_scale = -2.0f,
                    .continuous = true,
                    .can_sleep = false,
                    .locked = {.linear = {false, true, false}, .angular = {true, false, true}},
                    .user_data = 11};
  const Filter filter{.layer = 4, .collides_with = 6, .group = -3};
  const BodyId body =
      world.add_body(def, {.geometry = Sphere{0.2f}, .density = 300.0f, .filter = filter, .user_data = 22});
  const BodyId plain = world.add_body({}, {.geometry = Box{}, .sensor = true});
  EXPECT_EQ(world.linear_damping(body), 0.25f);
  EXPECT_EQ(world.angular_damping(body), 0.5f);
  EXPECT_EQ(world.gravity_scale(body), -2.0f);
  EXPECT_TRUE(world.continuous(body) && !world.can_sleep(body));
  EXPECT_FALSE(world.continuous(plain) || !world.can_sleep(plain));
  EXPECT_EQ(world.locked_axes(body), def.locked);
  EXPECT_EQ(world.locked_axes(plain), LockedAxes{});
  const ShapeId shape = world.shapes(body)[0], other = world.shapes(plain)[0];
  EXPECT_EQ(world.filter(shape), filter);
  EXPECT_EQ(world.density(shape), 300.0f);
  EXPECT_EQ(world.user_data(shape), 22u);
  EXPECT_TRUE(world.is_sensor(other) && !world.is_sensor(shape));

  const JointId first = world.add_joint(
      HingeDef{.a = body, .b = plain, .anchor = {1, 2, 3.5}, .break_force = 9.0f, .collide_connected = true});
  const JointId second =
      world.add_joint(DistanceDef{.b = body, .anchor = {0, 5, 0}, .anchor_b = DVec3{1, 2, 3}});
  const JointInfo hinge = world.joint_info(first), rod = world.joint_info(second);
  EXPECT_TRUE(hinge.kind == JointKind::hinge && hinge.a == body && hinge.b == plain &&
              hinge.collide_connected && hinge.enabled);
  EXPECT_NEAR(length(difference(hinge.anchor_a, DVec3{1, 2, 3.5})), 0.0, 1e-6);
  EXPECT_EQ(hinge.break_force, 9.0f);
  EXPECT_EQ(hinge.break_torque, 0.0f);
  EXPECT_TRUE(rod.kind == JointKind::distance && !rod.a && rod.b == body);
  EXPECT_NEAR(length(difference(rod.anchor_a, DVec3{0, 5, 0})), 0.0, 1e-6);
  EXPECT_NEAR(length(difference(rod.anchor_b, DVec3{1, 2, 3})), 0.0, 1e-6);
  JointId joints[3];
  ASSERT_EQ(world.joints(body, joints), 2u);
  EXPECT_TRUE(joints[0] == first && joints[1] == second);
  EXPECT_EQ(world.joints(plain, {}), 1u);
  world.set_joint_enabled(first, false);
  EXPECT_FALSE(world.joint_info(first).enabled);

  // All of it comes along with a snapshot, and nothing is left of what is gone.
  const World loaded = *load_snapshot(save_snapshot(world));
  const BodyId again = loaded.bodies().ids[0];
  EXPECT_EQ(loaded.locked_axes(again), def.locked);
  EXPECT_EQ(loaded.filter(loaded.shapes(again)[0]), filter);
  world.remove_body(body);
  EXPECT_EQ(world.gravity_scale(body), 0.0f);
  EXPECT_EQ(world.user_data(shape), 0u);
  EXPECT_EQ(world.joints(body, joints), 0u);
  EXPECT_EQ(world.joint_info(first).kind, JointInfo{}.kind);
  EXPECT_FALSE(world.joint_info(first).b);
}

TEST(Settings, RefusesWhatIsOutOfRange) {
  World world = make_world();
  const WorldDef before = world.def();
  EXPECT_FALSE(world.set_threads(-1));
  EXPECT_FALSE(world.set_threads(1000000));
  EXPECT_FALSE(world.set_broad_phase(BroadPhaseKind(77)));
  EXPECT_FALSE(world.set_combine_rules(CombineRule(9), CombineRule::maximum));
  EXPECT_EQ(world.problems().size(), 4u);
  for (const Problem& problem : world.problems())
    EXPECT_EQ(problem.code, ErrorCode::invalid_argument) << problem.message;
  expect_equal(world.def(), before);
  const HostTasks host{[](void*, int count, void (*task)(void*, int), void* context) {
                         for (int i = 0; i < count; ++i) task(context, i);
                       },
                       1, nullptr};
  World guest = make_world({.host_tasks = host});
  EXPECT_FALSE(guest.set_threads(2));
  ASSERT_EQ(guest.problems().size(), 1u);
  EXPECT_EQ(guest.problems()[0].code, ErrorCode::unsupported);
}

// Threads and broad phase, changed again and again while bodies come and go: no bit differs from a world left alone.
TEST(Settings, ThreadsAndBroadPhaseChangeNothing) {
  for (const scenes::Scene& scene : scenes::kScenes) {
    World changed = make_world(), alone = make_world();
    scene.build(changed);
    scene.build(alone);
    for (int step = 0; step < 120; ++step) {
      if (step % 15 == 7) {
        EXPECT_TRUE(changed.set_broad_phase(BroadPhaseKind((1 + step / 15) % kBroadPhaseKindCount)));
      }
      if (step % 20 == 3) {
        EXPECT_TRUE(changed.set_threads(1 + step / 20 % 3));
      }
      scenes::step_scene(scene, changed, step);
      scenes::step_scene(scene, alone, step);
      ASSERT_EQ(changed.hash(), alone.hash()) << scene.name << ", step " << step;
    }
    EXPECT_EQ(validate(changed).code, ErrorCode::none) << validate(changed).message;
  }
}

// A slider on a slope holds or slides by the rule that mixes its friction with the slope's.
TEST(Settings, CombineRulesActAtOnce) {
  World world = make_world({.friction_rule = CombineRule::maximum});
  const float tilt = 20 * kDegree;  // holds above a friction of 0.364
  world.add_body({.type = BodyType::fixed, .pose = {.orientation = from_axis_angle({0, 0, 1}, tilt)}},
                 {.geometry = Plane{}, .material = surface(0.8f)});
  const SinCos t = sin_cos(tilt);
  const BodyId box = world.add_body({.pose = {.position = {-0.5 * double(t.sin), 0.5 * double(t.cos), 0},
                                              .orientation = from_axis_angle({0, 0, 1}, tilt)}},
                                    {.geometry = Box{}, .material = surface(0.1f)});
  run(world, 2.0);
  EXPECT_FALSE(world.is_awake(box)) << "0.8 holds it";
  EXPECT_TRUE(world.set_combine_rules(CombineRule::minimum, CombineRule::maximum));
  EXPECT_TRUE(world.is_awake(box));
  run(world, 1.0);
  // g (sin - mu cos) for a second.
  const double expected = kGravity * (double(t.sin) - 0.1 * double(t.cos));
  EXPECT_NEAR(double(length(world.linear_velocity(box))), expected, 0.02 * expected);
}

// Every setting that is state is in a recording, as a command; who plays it back sees the same and ends with the same.
TEST(Settings, RecordingsKeepEachChange) {
  World world = make_world();
  add_ground(world);
  for (int i = 0; i < 6; ++i) {
    world.add_body({.pose = {.position = {0.1 * i, 0.6 + 1.1 * i, 0}}},
                   {.geometry = Box{}, .material = surface(0.5f, 0.4f)});
  }
  MemorySink sink;
  {
    Recorder recorder(world, sink);
    for (int step = 0; step < 100; ++step) {
      if (step == 20) world.set_gravity({1, -9, 0});
      if (step == 30) world.set_substeps(6);
      if (step == 40) world.set_combine_rules(CombineRule::minimum, CombineRule::average);
      if (step == 50) world.set_sleeping(false);
      if (step == 60) world.set_threads(2);
      if (step == 70) world.set_broad_phase(BroadPhaseKind::brute_force);
      world.step(kStep);
    }
  }
  Result<Replay> replay = Replay::open(sink.bytes);
  ASSERT_TRUE(replay);
  bool matches = true;
  while (replay->step(&matches)) ASSERT_TRUE(matches) << replay->position();
  EXPECT_EQ(replay->position(), 100u);
  EXPECT_EQ(replay->world().hash(), world.hash());
  WorldDef expected = world.def();
  expected.threads = 1;
  expected.stepping.broad_phase = BroadPhaseKind::bvh;
  expect_equal(replay->world().def(), expected);
}

// What a world is computed with, and cannot be changed in place, is changed by its snapshot and another def.
TEST(Settings, ASnapshotGoesOnUnderAnotherDef) {
  World world = make_world({.gravity = {0, -5, 0}, .stepping = {.substeps = 3}, .sleeping = false});
  scenes::build_pile(world);
  for (int step = 0; step < 30; ++step) world.step(kStep);
  const std::vector<std::byte> snapshot = save_snapshot(world);
  std::vector<World> others;
  for (const int width : {1, 4, 8, 16}) {
    // Gravity and the like are state: the snapshot's hold, not the def's.
    const WorldDef def{
        .gravity = {9, 9, 9},
        .threads = width == 4 ? 3 : 1,
        .simd_width = width,
        .stepping = {.substeps = 1,
                     .broad_phase = width == 8 ? BroadPhaseKind::brute_force : BroadPhaseKind::bvh}};
    Result<World> other = load_snapshot(snapshot, def);
    ASSERT_TRUE(other) << width;
    EXPECT_EQ(other->def().simd_width, width);
    EXPECT_EQ(other->def().gravity, (Vec3{0, -5, 0}));
    EXPECT_EQ(other->def().stepping.substeps, 3);
    EXPECT_FALSE(other->def().sleeping);
    others.push_back(std::move(*other));
  }
  for (int step = 0; step < 60; ++step) {
    world.step(kStep);
    for (World& other : others) {
      other.step(kStep);
      ASSERT_EQ(other.hash(), world.hash()) << "width " << other.def().simd_width << ", step " << step;
    }
  }
}

}  // namespace
}  // namespace gyre::laws::settings_test
