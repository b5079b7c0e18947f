// Changes of bodies, shapes and joints at run time, and readings of single bodies: each has its effect, comes back from a recording and a
// snapshot to the bit, and is refused with wrong arguments.
#include "laws/kit.h"

#include <gyre/debug.h>
#include <gyre/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace gyre::changes_test {
namespace {

const ShapeDef kGround{.geometry = Plane{}};
const ShapeDef kBox{.geometry = Box{{0.5f, 0.5f, 0.5f}}};
constexpr float kStep = 1.0f / 60.0f;

struct Memory : ByteSink {
  std::vector<std::byte> bytes;
  bool write(std::span<const std::byte> more) override {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  }
};

// A ground, a box at rest on it, a ball that hangs on a hinge, and a kinematic platform far away.
struct Stage {
  World world = *World::create();
  BodyId ground = world.add_body({.type = BodyType::fixed}, kGround);
  BodyId box = world.add_body({.pose = {.position = {0, 0.5, 0}}}, kBox);
  BodyId ball = world.add_body({.pose = {.position = {5, 3, 0}}}, ShapeDef{.geometry = Sphere{0.25f}});
  BodyId platform = world.add_body({.type = BodyType::kinematic, .pose = {.position = {-9, 5, 0}}}, kBox);
  JointId hinge = world.add_joint(HingeDef{.b = ball, .anchor = {5, 4, 0}, .axis = {0, 0, 1}});
  ShapeId shape(BodyId body) const { return world.shapes(body)[0]; }
  void run(int steps) {
    for (int i = 0; i < steps; ++i) ASSERT_TRUE(world.step(kStep));
    ASSERT_TRUE(validate(world).ok()) << validate(world).message;
  }
};

TEST(Changes, MassFollowsDensityFormAndWish) {
  Stage s;
  World& w = s.world;
  EXPECT_NEAR(w.mass_properties(s.box).mass, 1000, 0.01);
  ASSERT_TRUE(w.set_density(s.shape(s.box), 500));
  EXPECT_NEAR(w.mass_properties(s.box).mass, 500, 0.01);
  ASSERT_TRUE(w.set_geometry(s.shape(s.box), Box{{0.5f, 0.25f, 0.5f}}));
  EXPECT_NEAR(w.mass_properties(s.box).mass, 250, 0.01);
  ASSERT_TRUE(w.set_mass(s.box, {.mass = 10.0f, .center_of_mass = Vec3{0, -0.1f, 0}}));
  EXPECT_EQ(w.mass_properties(s.box).mass, 10);
  EXPECT_NEAR(w.center_of_mass(s.box).y, 0.4, 1e-6);
  EXPECT_NEAR(w.pose(s.box).position.y, 0.5, 1e-6) << "the origin stays";
  ASSERT_TRUE(w.set_mass(s.box, {}));
  EXPECT_NEAR(w.mass_properties(s.box).mass, 250, 0.01) << "back to that of the shapes";
  ASSERT_TRUE(w.set_sensor(s.shape(s.box), true));
  EXPECT_EQ(w.mass_properties(s.box).mass, 1) << "a body of sensors alone";
  // Bodies that bear the weight feel the new one.
  ASSERT_TRUE(w.set_sensor(s.shape(s.box), false));
  s.run(120);
  std::vector<ContactPoint> points(w.body_contacts(s.box, {}));
  ASSERT_FALSE(points.empty());
  w.body_contacts(s.box, points);
  double force = 0;
  for (const ContactPoint& point : points) force += double(point.normal_impulse / kStep);
  EXPECT_NEAR(force, 250 * 9.81, 3);
}

TEST(Changes, LockedAxesHold) {
  Stage s;
  ASSERT_TRUE(
      s.world.set_locked_axes(s.box, {.linear = {true, false, false}, .angular = {false, true, false}}));
  EXPECT_TRUE(s.world.locked_axes(s.box).linear[0]);
  s.world.add_impulse(s.box, {5000, 0, 5000});
  s.world.add_angular_impulse(s.box, {0, 800, 0});
  s.run(5);
  EXPECT_NEAR(s.world.pose(s.box).position.x, 0, 1e-6);
  EXPECT_GT(s.world.pose(s.box).position.z, 0.1);
  EXPECT_NEAR(double(s.world.angular_velocity(s.box).y), 0, 1e-6);
}

TEST(Changes, SensorsAndFormsChangeWhatIsTouched) {
  Stage s;
  World& w = s.world;
  s.run(30);
  ASSERT_TRUE(w.set_sensor(s.shape(s.box), true));
  EXPECT_TRUE(w.is_sensor(s.shape(s.box)));
  s.run(60);
  EXPECT_LT(w.pose(s.box).position.y, -2) << "it falls through the ground";
  ASSERT_TRUE(w.set_pose(s.box, {.position = {0, 3, 0}}));
  ASSERT_TRUE(w.set_velocity(s.box, {}, {}));
  ASSERT_TRUE(w.set_sensor(s.shape(s.box), false));
  ASSERT_TRUE(w.set_geometry(s.shape(s.box), Sphere{0.2f}));
  ASSERT_TRUE(w.set_local_transform(s.shape(s.box), {.position = {0, 0.3f, 0}}));
  EXPECT_EQ(w.local_transform(s.shape(s.box)).position, (Vec3{0, 0.3f, 0}));
  EXPECT_NEAR(w.body_bounds(s.box).low.y, 3.1, 1e-5);
  s.run(240);
  EXPECT_NEAR(w.center_of_mass(s.box).y, 0.2, 0.01);
}

TEST(Changes, BodiesThatIgnoreEachOtherPassThrough) {
  Stage s;
  World& w = s.world;
  const BodyId other = w.add_body({.pose = {.position = {0, 1.5, 0}}}, kBox);
  s.run(60);
  EXPECT_NEAR(w.pose(other).position.y, 1.5, 0.01);
  ASSERT_TRUE(w.set_pair_ignored(other, s.box, true));
  EXPECT_TRUE(w.pair_ignored(s.box, other));
  s.run(60);
  EXPECT_NEAR(w.pose(other).position.y, 0.5, 0.01) << "it fell to the ground, through the box";
  EXPECT_NEAR(w.pose(s.box).position.y, 0.5, 0.01);
  // The table is in snapshots and clones.
  World loaded = *load_snapshot(save_snapshot(w));
  World cloned = *clone(w);
  EXPECT_TRUE(cloned.pair_ignored(s.box, other));
  for (int i = 0; i < 30; ++i) w.step(kStep), loaded.step(kStep), cloned.step(kStep);
  EXPECT_EQ(loaded.hash(), w.hash());
  EXPECT_EQ(cloned.hash(), w.hash());
  ASSERT_TRUE(w.set_pair_ignored(s.box, other, false));
  s.run(120);
  EXPECT_GT(length(w.pose(other).position - w.pose(s.box).position), 0.5) << "they push each other apart";
  // A removed body leaves the table, and its successor in the slot collides.
  ASSERT_TRUE(w.set_pair_ignored(other, s.ground, true));
  ASSERT_TRUE(w.remove_body(other));
  const BodyId next = w.add_body({.pose = {.position = {3, 0.5, 0}}}, kBox);
  EXPECT_EQ(next.index, other.index);
  EXPECT_FALSE(w.pair_ignored(next, s.ground));
  s.run(60);
  EXPECT_NEAR(w.pose(next).position.y, 0.5, 0.01);
}

std::uint64_t hash_after(World& w, int steps) {
  for (int i = 0; i < steps; ++i) w.step(kStep);
  return w.hash();
}

TEST(Changes, DisabledBodiesLeaveAndComeBack) {
  Stage s;
  World& w = s.world;
  const BodyId top = w.add_body({.pose = {.position = {0, 1.5, 0}}}, kBox);
  s.run(120);
  ASSERT_FALSE(w.is_awake(top)) << "the pile sleeps";
  const Pose before = w.pose(s.box);
  ASSERT_TRUE(w.set_enabled(s.box, false));
  EXPECT_FALSE(w.enabled(s.box));
  EXPECT_EQ(w.body_contacts(s.box, {}), 0u);
  EXPECT_FALSE(w.cast_ray({0, 0.5, 5}, {0, 0, -10})) << "no query finds it";
  EXPECT_TRUE(w.cast_ray({0, 1.5, 5}, {0, 0, -10}));
  EXPECT_TRUE(w.add_impulse(s.box, {0, 1e6f, 0})) << "ignored";
  s.run(1);
  EXPECT_EQ(w.events().ends.size(), 2u) << "with the ground and with the box above";
  s.run(90);
  EXPECT_NEAR(w.pose(top).position.y, 0.5, 0.01) << "it fell to the ground";
  EXPECT_EQ(w.pose(s.box).position, before.position);
  EXPECT_EQ(explain(w, s.box).reason, AwakeReason::disabled);
  // Snapshots have it, and a changed velocity and pose hold when it is back.
  World loaded = *load_snapshot(save_snapshot(w));
  ASSERT_TRUE(w.set_velocity(s.box, {0, 0, 1}, {}));
  ASSERT_TRUE(w.set_pose(s.box, {.position = {0, 4, 0}}));
  ASSERT_TRUE(w.set_enabled(s.box, true));
  s.run(1);
  EXPECT_NEAR(w.linear_velocity(s.box).z, 1, 1e-6);
  EXPECT_TRUE(w.cast_ray({0, 4, 5}, {0, 0, -10}));
  s.run(180);
  EXPECT_GT(w.pose(s.box).position.y, 0.45);
  EXPECT_GT(w.body_contacts(s.box, {}), 0u);
  World undone = *load_snapshot(save_snapshot(loaded));
  EXPECT_EQ(hash_after(undone, 30), hash_after(loaded, 30));
  EXPECT_FALSE(w.set_enabled({}, true));
}

TEST(Changes, JointsOfDisabledBodiesIdle) {
  Stage s;
  World& w = s.world;
  const BodyId lower = w.add_body({.pose = {.position = {5, 2, 0}}}, ShapeDef{.geometry = Sphere{0.2f}});
  const JointId second = w.add_joint(HingeDef{.a = s.ball, .b = lower, .anchor = {5, 2.5, 0}, .axis = {0, 0, 1}});
  s.run(5);
  ASSERT_TRUE(w.set_enabled(s.ball, false));
  const double energy = w.energy().potential;
  s.run(20);
  EXPECT_LT(w.pose(lower).position.y, 1.6) << "nothing holds it";
  EXPECT_EQ(length(w.joint_state(second).force), 0);
  EXPECT_LT(w.energy().potential, energy) << "of the bodies that are left";
  ASSERT_TRUE(w.set_pose(lower, {.position = {5, 2, 0}}));
  ASSERT_TRUE(w.set_velocity(lower, {}, {}));
  ASSERT_TRUE(w.set_enabled(s.ball, true));
  s.run(60);
  EXPECT_NEAR(w.pose(lower).position.y, 2, 0.01) << "it hangs again";
  // One that begins disabled, of every type.
  for (const BodyType type : {BodyType::fixed, BodyType::kinematic, BodyType::dynamic}) {
    const BodyId off = w.add_body({.type = type, .pose = {.position = {0, 9, 0}}, .enabled = false}, kBox);
    EXPECT_FALSE(w.enabled(off));
    EXPECT_FALSE(w.cast_ray({0, 12, 0}, {0, -5, 0}));
    s.run(3);
    EXPECT_EQ(w.pose(off).position.y, 9);
    ASSERT_TRUE(w.set_enabled(off, true));
    EXPECT_TRUE(w.cast_ray({0, 12, 0}, {0, -5, 0}));
    s.run(3);
    ASSERT_TRUE(w.remove_body(off));
  }
}

TEST(Changes, JointsBreakAtTheNewLoad) {
  Stage s;
  s.run(10);
  ASSERT_TRUE(s.world.set_break_load(s.hinge, 300, 0));
  EXPECT_EQ(s.world.joint_info(s.hinge).break_force, 300);
  s.run(2);
  EXPECT_FALSE(s.world.exists(s.hinge)) << "the ball weighs 642 N";
}

// The same acceleration as by the torque that the load stands for; and nothing on the whole.
TEST(Changes, JointLoadsActAlongTheirAxis) {
  World w = *World::create({.gravity = {}});
  const auto rod = [&](double x) {
    return w.add_body({.pose = {.position = {x, 0, 0}}, .mass = 2.0f}, kBox);
  };
  const BodyId a = rod(0), b = rod(2), c = rod(10);
  const JointId hinge = w.add_joint(HingeDef{.a = a, .b = b, .anchor = {1, 0, 0}, .axis = {0, 0, 1}});
  const JointId slider = w.add_joint(SliderDef{.b = c, .anchor = {10, 0, 0}, .axis = {0, 1, 0}});
  for (int i = 0; i < 10; ++i) {
    ASSERT_TRUE(w.add_joint_load(hinge, JointAxis::angular_x, 0.6f));
    ASSERT_TRUE(w.add_joint_load(slider, JointAxis::linear_x, 4.0f));
    w.step(0.01f);
  }
  const Momentum total = w.momentum();
  EXPECT_NEAR(length(w.linear_velocity(c)), 4.0 / 2.0 * 0.1, 1e-4);
  EXPECT_NEAR(total.linear.y, 2 * 0.2, 1e-3) << "of the slider's body alone";
  EXPECT_GT(w.joint_axis_state(hinge, JointAxis::angular_x).velocity, 0.01f);
  EXPECT_NEAR(double(w.linear_velocity(a).y + w.linear_velocity(b).y), 0, 1e-5);
  EXPECT_FALSE(w.add_joint_load(hinge, JointAxis::linear_x, 1));
  ASSERT_TRUE(w.set_joint_enabled(hinge, false));
  EXPECT_FALSE(w.add_joint_load(hinge, JointAxis::angular_x, 1));
  EXPECT_EQ(w.problems().size(), 2u);
}

TEST(Changes, SleepAndContinuousAndUserData) {
  Stage s;
  ASSERT_TRUE(s.world.set_can_sleep(s.box, false));
  s.run(120);
  EXPECT_TRUE(s.world.is_awake(s.box));
  ASSERT_TRUE(s.world.set_can_sleep(s.box, true));
  s.run(120);
  EXPECT_FALSE(s.world.is_awake(s.box));
  ASSERT_TRUE(s.world.set_continuous(s.box, true));
  EXPECT_TRUE(s.world.continuous(s.box));
  ASSERT_TRUE(s.world.set_user_data(s.box, 77));
  ASSERT_TRUE(s.world.set_user_data(s.shape(s.box), 78));
  EXPECT_EQ(s.world.user_data(s.box), 77u);
  EXPECT_EQ(s.world.user_data(s.shape(s.box)), 78u);
}

TEST(Changes, JointsAndMaterialsTellHowTheyAreSet) {
  Stage s;
  World& w = s.world;
  EXPECT_EQ(w.joint_axis_def(s.hinge, JointAxis::angular_x).motion, AxisMotion::free);
  ASSERT_TRUE(w.set_motor(s.hinge, {.target_velocity = 2, .max_force = 3}));
  EXPECT_EQ(w.motor(s.hinge).max_force, 3);
  EXPECT_EQ(w.joint_axis_def(s.hinge, JointAxis::angular_x).motor.target_velocity, 2);
  ASSERT_TRUE(w.set_joint_axis(s.hinge, JointAxis::angular_x,
                               {.motion = AxisMotion::limited, .limits = {-1, 2}, .stiffness = 5, .friction = 0.5f}));
  const JointAxisDef axis = w.joint_axis_def(s.hinge, JointAxis::angular_x);
  EXPECT_EQ(axis.motion, AxisMotion::limited);
  EXPECT_EQ(axis.limits.high, 2);
  EXPECT_EQ(axis.stiffness, 5);
  EXPECT_EQ(axis.friction, 0.5f);
  EXPECT_EQ(w.joint_axis_def(s.hinge, JointAxis::linear_y).motion, AxisMotion::locked);
  const JointId mouse = w.add_joint(MouseDef{.b = s.box, .anchor = {0, 0.5, 0}});
  ASSERT_TRUE(w.set_drive(mouse, {.position = {0, 1, 0}, .frequency = 4, .max_force = 50}));
  EXPECT_EQ(w.drive(mouse).max_force, 50);
  EXPECT_EQ(w.drive(s.hinge).max_force, 0);
  ASSERT_TRUE(w.set_material_pair({.a = 7, .b = 2, .restitution = 0.5f}));
  ASSERT_TRUE(w.set_surface_rule({.id = 3, .velocity = {1, 0, 0}}));
  EXPECT_EQ(w.material_pair(7, 2).a, 2);
  EXPECT_EQ(w.material_pair(2, 7).restitution, 0.5f);
  EXPECT_EQ(w.material_pair(2, 8).a, 0);
  EXPECT_EQ(w.surface_rule(3).velocity, (Vec3{1, 0, 0}));
  EXPECT_EQ(w.surface_rule(4).id, 0);
}

TEST(Changes, ManyPlatformsMoveAtOnce) {
  Stage s;
  const BodyId second = s.world.add_body({.type = BodyType::kinematic}, ShapeDef{.geometry = Sphere{0.1f}});
  const BodyId bodies[] = {s.platform, second};
  const Pose poses[] = {{.position = {-9, 5.1, 0}}, {.position = {0, 9, 0}}};
  ASSERT_TRUE(s.world.move_kinematics(bodies, poses, kStep));
  s.run(1);
  EXPECT_NEAR(s.world.pose(s.platform).position.y, 5.1, 1e-5);
  EXPECT_NEAR(s.world.pose(second).position.y, 9, 1e-4);
  EXPECT_FALSE(s.world.move_kinematics(bodies, {poses, 1}, kStep));
}

TEST(Changes, OneBodyIsReadAlone) {
  Stage s;
  s.run(30);
  std::vector<ContactPoint> all(s.world.contacts({})), own(s.world.body_contacts(s.box, {}));
  s.world.contacts(all);
  s.world.body_contacts(s.box, own);
  ASSERT_EQ(own.size(), 4u);
  EXPECT_EQ(own.size(), all.size());
  EXPECT_EQ(own[0].position.x, all[0].position.x);
  EXPECT_EQ(s.world.shape_contacts(s.shape(s.box), {}), 4u);
  EXPECT_EQ(s.world.body_contacts(s.ball, {}), 0u);
  const WorldBounds box = s.world.body_bounds(s.box);
  EXPECT_NEAR(box.low.x, -0.5, 1e-5);
  EXPECT_NEAR(box.high.y, 1.0, 1e-3);
  EXPECT_GT(s.world.body_bounds(s.ground).low.x, s.world.body_bounds(s.ground).high.x)
      << "a plane has no bounds";
  // The ball is behind the box.
  const BodyId behind =
      s.world.add_body({.pose = {.position = {0, 0.5, 5}}}, ShapeDef{.geometry = Sphere{0.25f}});
  const auto hit = s.world.cast_ray_body(behind, {0, 0.5, -5}, {0, 0, 20});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->body, behind);
  EXPECT_NEAR(hit->fraction, 9.75 / 20, 1e-6);
  EXPECT_FALSE(s.world.cast_ray_body(s.ball, {0, 0.5, -5}, {0, 0, 20}));
}

TEST(Changes, AreRecordedAndReplayedToTheBit) {
  Stage s;
  Memory file;
  Recorder recorder(s.world, file, {.hash_interval = 1});
  const std::vector<std::function<bool(World&)>> changes = {
      [&](World& w) { return w.set_density(s.shape(s.box), 400); },
      [&](World& w) {
        return w.set_geometry(s.shape(s.box), Capsule{0.3f, 0.2f});
      },
      [&](World& w) {
        return w.set_local_transform(s.shape(s.box), {.position = {0.1f, 0, 0}});
      },
      [&](World& w) {
        return w.set_mass(s.box, {.mass = 3.0f, .inertia = Sym3{1, 1, 1, 0, 0, 0}});
      },
      [&](World& w) {
        return w.set_locked_axes(s.box, {.angular = {true, true, true}});
      },
      [&](World& w) { return w.set_continuous(s.ball, true) && w.set_can_sleep(s.ball, false); },
      [&](World& w) { return w.set_user_data(s.ball, 5) && w.set_user_data(s.shape(s.ball), 6); },
      [&](World& w) { return w.set_break_load(s.hinge, 1e6f, 1e6f); },
      [&](World& w) { return w.set_pair_ignored(s.box, s.ball, true); },
      [&](World& w) { return w.set_enabled(s.box, false); }, [&](World& w) { return w.set_enabled(s.box, true); },
      [&](World& w) { return w.set_sensor(s.shape(s.ball), true); },
      [&](World& w) { return w.add_joint_load(s.hinge, JointAxis::angular_x, 5); }};
  for (const auto& change : changes) {
    ASSERT_TRUE(change(s.world));
    s.run(5);
  }
  ASSERT_TRUE(recorder.finish());
  Result<Replay> replay = Replay::open(file.bytes, {.threads = 2, .simd_width = 1});
  ASSERT_TRUE(replay) << replay.error().message;
  bool matches = true;
  int steps = 0;
  for (; replay->step(&matches); ++steps) ASSERT_TRUE(matches) << "step " << steps;
  EXPECT_EQ(steps, 5 * int(changes.size()));
  EXPECT_EQ(replay->world().hash(), s.world.hash());
}

TEST(Changes, WrongOnesAreRefusedAndChangeNothing) {
  Stage s;
  World& w = s.world;
  const std::uint64_t before = w.hash();
  EXPECT_FALSE(w.set_density(s.shape(s.box), -1));
  EXPECT_FALSE(w.set_density({}, 1));
  EXPECT_FALSE(w.set_mass(s.box, {.mass = 0.0f}));
  EXPECT_FALSE(w.set_mass(s.box, {.inertia = Sym3{-1, 1, 1, 0, 0, 0}}));
  EXPECT_FALSE(w.set_geometry(s.shape(s.box), Plane{})) << "a dynamic body cannot be a plane";
  EXPECT_FALSE(w.set_geometry(s.shape(s.box), Sphere{-1}));
  EXPECT_FALSE(w.set_local_transform(s.shape(s.box), {.position = {NAN, 0, 0}}));
  EXPECT_FALSE(w.set_break_load(s.hinge, -1, 0));
  EXPECT_FALSE(w.set_pair_ignored(s.box, s.box, true));
  EXPECT_FALSE(w.set_pair_ignored(s.box, {}, true));
  EXPECT_FALSE(w.set_locked_axes({}, {}));
  EXPECT_EQ(w.problems().size(), 11u);
  EXPECT_EQ(w.hash(), before);
}

TEST(Clone, GoesOnAlikeAndAlone) {
  Stage s;
  s.run(20);
  World other = *clone(s.world);
  EXPECT_EQ(other.hash(), s.world.hash());
  EXPECT_TRUE(other.exists(s.box)) << "ids name the same objects";
  s.run(20);
  for (int i = 0; i < 20; ++i) other.step(kStep);
  EXPECT_EQ(other.hash(), s.world.hash());
  other.add_impulse(s.box, {0, 9000, 0});
  other.step(kStep);
  s.run(1);
  EXPECT_NE(other.hash(), s.world.hash());
  EXPECT_NEAR(s.world.pose(s.box).position.y, 0.5, 0.01) << "the first is as it was";
}

TEST(Snapshots, CarryBytesOfTheCaller) {
  Stage s;
  const std::string text = "score 42";
  const auto bytes = std::as_bytes(std::span<const char>(text.data(), text.size()));
  std::vector<std::byte> snapshot = save_snapshot_with(s.world, bytes);
  const std::vector<std::byte> back = snapshot_user_bytes(snapshot);
  ASSERT_EQ(back.size(), text.size());
  EXPECT_EQ(std::memcmp(back.data(), text.data(), text.size()), 0);
  Result<World> loaded = load_snapshot(snapshot);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->hash(), s.world.hash());
  ASSERT_TRUE(restore_snapshot(s.world, snapshot).ok());
  EXPECT_TRUE(snapshot_user_bytes(save_snapshot(s.world)).empty());
  snapshot.back() ^= std::byte{1};
  EXPECT_TRUE(snapshot_user_bytes(snapshot).empty());
  EXPECT_FALSE(load_snapshot(snapshot)) << "damaged";
  EXPECT_TRUE(snapshot_user_bytes({}).empty());
}

TEST(Problems, AreHeardAtOnceAndHaveASeverity) {
  Stage s;
  std::vector<Problem> heard;
  s.world.set_problem_hook({[](void* user, const Problem& problem) {
                              static_cast<std::vector<Problem>*>(user)->push_back(problem);
                            },
                            &heard});
  for (int i = 0; i < 300; ++i) s.world.remove_body({});
  EXPECT_EQ(heard.size(), 300u) << "more than are kept";
  EXPECT_EQ(s.world.problems().size(), 256u);
  EXPECT_EQ(heard[0].severity, Severity::error);
  EXPECT_EQ(heard[0].code, ErrorCode::stale_id);
  s.world.set_problem_hook({});
  s.world.remove_body({});
  EXPECT_EQ(heard.size(), 300u);
}

}  // namespace
}  // namespace gyre::changes_test
