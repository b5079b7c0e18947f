// Joints that break, that are switched off, and that are saved: every kind.
#include "laws/any_joint.h"
#include "laws/kit.h"

#include <gyre/replay.h>

namespace gyre::laws::joint_states_test {
namespace {

TEST(EveryKindOfJoint, BreaksAboveItsForceAndSaysSo) {
  for (const JointKind kind : {JointKind::ball, JointKind::hinge, JointKind::slider, JointKind::fixed,
                               JointKind::distance, JointKind::cone, JointKind::universal, JointKind::six_dof,
                               JointKind::wheel, JointKind::path, JointKind::mouse, JointKind::motor}) {
    for (const bool heavy : {false, true}) {
      World world = make_world({.gravity = {0, 0, -10}, .sleeping = false});
      const BodyId body = world.add_body(point_body(heavy ? 1.1 : 0.9, {0.1f, 0.1f, 0.1f}));
      FlatJoint def{.kind = kind, .b = body, .break_force = 10.0f, .path = {{-2, 0, 0}, {2, 0, 0}}};
      if (kind == JointKind::distance) def.anchor = {0, 0, 1};
      def.drive = {.max_force = 1000.0f, .max_torque = 1000.0f};
      const JointId joint = world.add_joint(definition_of(def));
      ASSERT_TRUE(joint) << to_string(kind);
      bool told = false;
      for (int i = 0; i < 120; ++i) {
        world.step(kStep);
        for (const JointBroken& broken : world.events().broken) {
          told = told || broken.joint == joint;
          EXPECT_GT(broken.force, 10.0f);
        }
      }
      EXPECT_EQ(told, heavy) << to_string(kind);
      EXPECT_EQ(world.exists(joint), !heavy) << to_string(kind);
    }
  }
}

TEST(EveryKindOfJoint, BreaksAboveItsTorque) {
  for (const JointKind kind : {JointKind::hinge, JointKind::slider, JointKind::fixed, JointKind::universal,
                               JointKind::six_dof, JointKind::wheel, JointKind::motor}) {
    for (const bool strong : {false, true}) {
      World world = weightless();
      const BodyId body = world.add_body(point_body(1.0, {0.1f, 0.1f, 0.1f}));
      FlatJoint def{.kind = kind, .b = body, .break_torque = 2.0f, .axis_b = Vec3{0, 0, 1}};
      def.drive = {.max_force = 1000.0f, .max_torque = 1000.0f};
      if (kind == JointKind::six_dof) def.angular_x.motion = def.angular_z.motion = AxisMotion::free;
      const JointId joint = world.add_joint(definition_of(def));
      for (int i = 0; i < 30; ++i) {
        world.add_torque(body, {0, strong ? 2.2f : 1.8f, 0});
        world.step(kStep);
      }
      EXPECT_EQ(world.exists(joint), !strong) << to_string(kind);
    }
  }
}

// Gears and racks break by what their teeth bear: a torque about the shaft, a force along the rack.
TEST(EveryKindOfJoint, TeethAndRopesBreak) {
  for (const bool strong : {false, true}) {
    {
      // Inertias 1 and 9, ratio 3: half of the torque goes through the teeth, three times as much of it on the slower wheel.
      World world = weightless();
      const BodyId first = world.add_body(point_body(1.0, {1, 1, 1}));
      const BodyId second = world.add_body(point_body(1.0, {9, 9, 9}, {2, 0, 0}));
      world.add_joint(HingeDef{.b = first, .axis = {0, 0, 1}});
      world.add_joint(HingeDef{.b = second, .anchor = {2, 0, 0}, .axis = {0, 0, 1}});
      const JointId gear = world.add_joint(
          GearDef{.a = first, .b = second, .axis = {0, 0, 1}, .ratio = 3.0f, .break_torque = 3.0f});
      for (int i = 0; i < 30; ++i) {
        world.add_torque(first, {0, 0, strong ? 2.2f : 1.8f});
        world.step(kStep);
      }
      EXPECT_EQ(world.exists(gear), !strong) << "gear";
    }
    {
      World world = weightless();
      const BodyId pinion = world.add_body({.type = BodyType::kinematic});
      const BodyId rack = world.add_body(point_body(1.0, {1, 1, 1}, {0, -0.25, 0}));
      const JointId joint = world.add_joint(RackAndPinionDef{.a = pinion,
                                                             .b = rack,
                                                             .axis = {0, 0, 1},
                                                             .axis_b = Vec3{1, 0, 0},
                                                             .ratio = 0.25f,
                                                             .break_force = 10.0f});
      for (int i = 0; i < 30; ++i) {
        world.add_force(rack, {strong ? 11.0f : 9.0f, 0, 0});
        world.step(kStep);
      }
      EXPECT_EQ(world.exists(joint), !strong) << "rack_and_pinion";
    }
    {
      // Two equal weights: the rope bears one of them.
      World world = make_world({.gravity = {0, -10, 0}, .sleeping = false});
      const BodyId a = world.add_body(point_body(strong ? 1.1 : 0.9, {0.1f, 0.1f, 0.1f}, {-1, -2, 0}));
      const BodyId b = world.add_body(point_body(strong ? 1.1 : 0.9, {0.1f, 0.1f, 0.1f}, {1, -2, 0}));
      const JointId joint = world.add_joint(PulleyDef{.a = a,
                                                      .b = b,
                                                      .anchor = {-1, -2, 0},
                                                      .ground_a = {-1, 0, 0},
                                                      .ground_b = {1, 0, 0},
                                                      .break_force = 10.0f});
      run(world, 0.5);
      EXPECT_EQ(world.exists(joint), !strong) << "pulley";
    }
    {
      World world = make_world({.gravity = {0, -10, 0}, .sleeping = false});
      const BodyId body = world.add_body(point_body(strong ? 1.1 : 0.9, {0.1f, 0.1f, 0.1f}, {0, -2, 0}));
      const JointId joint = world.add_joint(DistanceDef{.b = body, .max_length = 2.0f, .break_force = 10.0f});
      run(world, 0.5);
      EXPECT_EQ(world.exists(joint), !strong) << "rope";
    }
  }
}

TEST(EveryKindOfJoint, DoesNothingWhileItIsOff) {
  World world = make_world({.sleeping = false});
  const BodyId body = world.add_body(point_body(1.0, {0.1f, 0.1f, 0.1f}));
  const JointId joint = world.add_joint(FixedDef{.b = body});
  run(world, 0.5);
  EXPECT_NEAR(world.pose(body).position.y, 0.0, 1e-4);
  EXPECT_TRUE(world.set_joint_enabled(joint, false));
  EXPECT_FALSE(world.joint_enabled(joint));
  run(world, 0.5);
  EXPECT_NEAR(double(world.linear_velocity(body).y), -0.5 * kGravity, 1e-4);
  EXPECT_TRUE(world.set_joint_enabled(joint, true));
  run(world, 2.0);
  EXPECT_NEAR(world.pose(body).position.y, 0.0, 1e-3) << "it takes its body back";
}

// One world with every kind, each doing something.
void add_everything(World& world) {
  const auto body = [&](double x) { return world.add_body(point_body(1.0, {0.2f, 0.3f, 0.25f}, {x, 0, 0})); };
  world.add_joint(ConeDef{.b = body(0),
                          .anchor = {0.3, 0.2, 0},
                          .swing_y = 0.6f,
                          .swing_z = 0.3f,
                          .limits = Limits{-0.5f, 0.5f},
                          .friction = 0.1f});
  world.add_joint(
      UniversalDef{.b = body(2),
                   .anchor = {2.5, 0, 0},
                   .axis_b = Vec3{0, 0.2f, 1},
                   .angular_z = {.motion = AxisMotion::free, .stiffness = 3.0f, .damping = 0.1f}});
  SixDofDef six{.b = body(4), .anchor = {4, 0.5, 0}};
  six.linear_y = {.motion = AxisMotion::limited, .limits = {-0.1f, 0.2f}, .limit_frequency = 3.0f};
  six.angular_x = {.motion = AxisMotion::free, .motor = {.target_velocity = 2.0f, .max_force = 1.0f}};
  six.angular_z = {.motion = AxisMotion::free, .friction = 0.2f};
  world.add_joint(six);
  const BodyId g1 = body(6), g2 = body(7);
  world.add_joint(HingeDef{.b = g1,
                           .anchor = {6, 0, 0},
                           .axis = {0, 0, 1},
                           .motor = {.target_velocity = 5.0f, .max_force = 2.0f},
                           .stiffness = 0.1f,
                           .friction = 0.05f});
  world.add_joint(HingeDef{.b = g2, .anchor = {7, 0, 0}, .axis = {0, 0, 1}});
  world.add_joint(GearDef{.a = g1, .b = g2, .axis = {0, 0, 1}, .ratio = 2.5f});
  const BodyId rack = world.add_body(point_body(1.0, {0.2f, 0.3f, 0.25f}, {7, -0.5, 0}));
  world.add_joint(SliderDef{.b = rack, .anchor = {7, -0.5, 0}});
  world.add_joint(
      RackAndPinionDef{.a = g2, .b = rack, .axis = {0, 0, 1}, .axis_b = Vec3{1, 0, 0}, .ratio = 0.5f});
  const BodyId p1 = body(9), p2 = body(10);
  world.add_joint(PulleyDef{
      .a = p1, .b = p2, .anchor = {9, 0, 0}, .ground_a = {9, 3, 0}, .ground_b = {10, 2, 0.5}, .ratio = 1.5f});
  world.add_joint(WheelDef{.a = p1,
                           .b = body(12),
                           .anchor = {12, 0, 0},
                           .axis = {0, 1, 0},
                           .axis_b = Vec3{0, 0, 1},
                           .limits = Limits{-0.2f, 0.2f},
                           .stiffness = 200.0f,
                           .damping = 10.0f,
                           .motor = {.target_velocity = 3.0f, .max_force = 1.0f},
                           .steering = {.motion = AxisMotion::limited, .limits = {-0.5f, 0.5f}}});
  world.add_joint(PathDef{.b = body(14),
                          .anchor = {14, 0, 0},
                          .points = {{-1, 1, 0}, {0, 0, 0}, {1, 1, 0.5f}, {0, 2, 0}},
                          .closed = true,
                          .orientation = PathOrientation::following});
  world.add_joint(
      PathDef{.b = body(18), .anchor = {18, 0, 0}, .points = {{-1, 1, 0}, {0, 0, 0}, {1, 1, 0.5f}}});
  world.add_joint(MouseDef{.b = body(16),
                           .anchor = {16.2, 0, 0},
                           .drive = {.position = {0.3f, 1, 0}, .frequency = 2.0f, .max_force = 30.0f}});
  world.add_joint(MotorDef{.a = p2,
                           .b = body(20),
                           .anchor = {20, 0, 0},
                           .drive = {.position = {0.3f, 1, 0}, .max_force = 30.0f, .max_torque = 5.0f}});
}

// Snapshot in the middle, rollback, and a recording with changes on the way all lead to the same bits.
TEST(EveryKindOfJoint, IsInSnapshotsAndRecordings) {
  World world = make_world({.sleeping = false});
  add_everything(world);
  ASSERT_TRUE(world.problems().empty()) << world.problems()[0].message;
  run(world, 1.0);
  const std::vector<std::byte> saved = save_snapshot(world);
  Result<World> loaded = load_snapshot(saved);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(loaded->hash(), world.hash());
  for (int i = 0; i < 120; ++i) {
    world.step(kStep);
    loaded->step(kStep);
  }
  EXPECT_EQ(loaded->hash(), world.hash());
  EXPECT_TRUE(is_finite(world.energy().kinetic));
}

}  // namespace
}  // namespace gyre::laws::joint_states_test
