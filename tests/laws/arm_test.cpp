// Arms of hinges, and of joints that lanes do not have, which motors or limits hold: what they hold, how still, and what they cannot.
#include "laws/assembly.h"

namespace gyre::laws::arm_test {
namespace {

// An arm of six links of 1 m and 40 kg, level, that gravity pulls down.
enum class Held { by_motors, by_motors_alone, by_limits };  // alone: of joints that lanes do not have
void build_arm(Assembly& arm, Held held, float most_torque) {
  BodyId last{};
  for (int i = 0; i < 6; ++i) {
    const BodyId body = arm.add({.pose = {.position = {i + 0.5, 0, 0}}}, Box{{0.5f, 0.1f, 0.1f}});
    HingeDef hinge{.a = last, .b = body, .anchor = {double(i), 0, 0}, .axis = {0, 0, 1}};
    const Motor motor{.target_position = 0.0f, .max_force = most_torque};
    if (held == Held::by_motors) hinge.motor = motor;
    if (held == Held::by_limits) hinge.limits = Limits{0.0f, 1.0f};
    SixDofDef axes{.a = last, .b = body, .anchor = hinge.anchor, .axis = hinge.axis};
    axes.angular_x = {.motion = AxisMotion::free, .motor = motor};
    arm.joints.push_back(held == Held::by_motors_alone ? arm.world.add_joint(axes)
                                                       : arm.world.add_joint(hinge));
    last = body;
  }
}
constexpr double kArmWeight = 6.0 * 40.0 * kGravity, kArmTorque = 3.0 * kArmWeight;  // N, N m at the root

TEST(Arm, IsHeldLevelByMotorsOrLimits) {
  const char* const names[] = {"sag of a driven arm of 6 m (m)",
                               "sag of a driven arm of 6 m, solved alone (m)",
                               "sag of an arm at its limits (m)"};
  for (const Held held : {Held::by_motors, Held::by_motors_alone, Held::by_limits}) {
    Assembly arm({.sleeping = false});
    build_arm(arm, held, 1.0e5f);
    run(arm.world, 5.0);
    EXPECT_TRUE(limit_row(names[int(held)], -arm.world.pose(arm.bodies.back()).position.y, 1.0e-3, 1e-4));
    const JointState root = arm.world.joint_state(arm.joints[0]);
    EXPECT_TRUE(relative_row("force at its root (N)", double(root.force.y), kArmWeight, 2e-2, 1e-3));
    EXPECT_TRUE(relative_row("torque at its root (N m)", double(root.torque.z), kArmTorque, 5e-2, 1e-3));
  }
}

TEST(Arm, FallsIfItsMotorsAreTooWeak) {
  for (const Held held : {Held::by_motors, Held::by_motors_alone}) {
    for (const float share : {0.98f, 1.02f}) {
      Assembly arm({.sleeping = false});
      build_arm(arm, held, share * float(kArmTorque));
      double lowest = 0.0;
      for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(arm.world.step(kStep));
        lowest = std::min(lowest, arm.world.pose(arm.bodies.back()).position.y);
      }
      if (share > 1.0f) {
        EXPECT_TRUE(limit_row("sag of an arm whose motors just hold it (m)", -lowest, 5.0e-3, 1e-3));
      } else {
        EXPECT_LT(lowest, -0.1) << "its root bears 2 % less than what hangs on it";
        const JointState root = arm.world.joint_state(arm.joints[0]);
        EXPECT_TRUE(relative_row("torque of a motor that gives all it has (N m)", double(root.torque.z),
                                 0.98 * kArmTorque, 1e-3, 1e-4));
      }
    }
  }
}

// What a motor gave as it was stronger it gives no more, and one that may give far more than it needs gives no less.
TEST(Arm, IsDrivenByWhatItsMotorsHaveNow) {
  Assembly arm({.sleeping = false});
  build_arm(arm, Held::by_motors, 1.0e5f);
  run(arm.world, 1.0);
  for (const JointId joint : arm.joints)
    ASSERT_TRUE(arm.world.set_motor(joint, {.target_position = 0.0f, .max_force = 1.0f}));
  run(arm.world, 0.25);
  EXPECT_TRUE(relative_row("torque of a motor that was weakened (N m)",
                           double(arm.world.joint_state(arm.joints[0]).torque.z), 1.0, 1e-3, 1e-5));
  EXPECT_LT(arm.world.pose(arm.bodies.back()).position.y, -0.2) << "it falls";
  for (const float most : {1.0e3f, 1.0e9f, 1.0e30f}) {
    Assembly cube({.sleeping = false});
    const BodyId body = cube.add({.pose = {.position = {0.05, 0, 0}}}, Box{{0.05f, 0.05f, 0.05f}});
    ASSERT_TRUE(cube.world.add_joint(
        HingeDef{.b = body, .axis = {0, 0, 1}, .motor = {.target_velocity = 2.0f, .max_force = most}}));
    run(cube.world, 2.0);
    EXPECT_TRUE(relative_row("speed of a small driven cube (rad/s)",
                             double(cube.world.angular_velocity(body).z), 2.0, 1e-3, 1e-4));
  }
}

// Two motors on one axis that want places 10 mrad apart: it rests in between, whatever they may give, and what bears the link is their difference.
TEST(Arm, RestsBetweenMotorsInConflict) {
  for (const float most : {1.0e3f, 1.0e5f}) {
    Assembly arm({.sleeping = false});
    const BodyId body = arm.add({.pose = {.position = {0.5, 0, 0}}}, Box{{0.5f, 0.1f, 0.1f}});
    for (const float place : {0.0f, 0.01f})
      arm.joints.push_back(
          arm.world.add_joint(HingeDef{.b = body,
                                       .anchor = {0, 0, place > 0.0f ? 0.1 : -0.1},
                                       .axis = {0, 0, 1},
                                       .motor = {.target_position = place, .max_force = most}}));
    run(arm.world, 5.0);
    EXPECT_TRUE(row("a link between two motors (rad)",
                    double(arm.world.joint_state(arm.joints[0]).position), 0.005, 0.0055, 0.001));
    EXPECT_TRUE(
        limit_row("its turning (rad/s)", double(length(arm.world.angular_velocity(body))), 1.0e-3, 1e-5));
    const double torque = double(arm.world.joint_state(arm.joints[0]).torque.z) +
                          double(arm.world.joint_state(arm.joints[1]).torque.z);
    EXPECT_TRUE(relative_row("torque of both (N m)", torque, 0.5 * 40.0 * kGravity, 2e-2, 1e-3));
  }
}

// Neither at its bound, they press as hard as the share says by which they give way: rate d / 2 over what an impulse of one changes, over that
// share, in each part of a step.
TEST(Arm, MotorsInConflictGiveWayByAThousandth) {
  constexpr double kApart = 1.0e-3, kRate = 40.0, kGives = 1.0e-3, kPart = 1.0 / 480.0;
  Assembly arm({.gravity = {0, 0, 0}, .sleeping = false});
  const BodyId body = arm.add({.pose = {.position = {0.5, 0, 0}}}, Box{{0.5f, 0.1f, 0.1f}});
  for (const float place : {0.0f, float(kApart)})
    arm.joints.push_back(
        arm.world.add_joint(HingeDef{.b = body,
                                     .anchor = {0, 0, place > 0.0f ? 0.1 : -0.1},
                                     .axis = {0, 0, 1},
                                     .motor = {.target_position = place, .max_force = 1.0e9f}}));
  run(arm.world, 2.0);
  const double inertia = 40.0 * ((1.0 + 0.04) / 12.0 + 0.25);
  EXPECT_TRUE(relative_row("place between two motors (rad)",
                           double(arm.world.joint_state(arm.joints[0]).position), 0.5 * kApart, 2e-2,
                           1e-3));
  EXPECT_TRUE(relative_row("torque of motors in conflict (N m)",
                           double(arm.world.joint_state(arm.joints[1]).torque.z),
                           kRate * 0.5 * kApart * inertia / (kGives * kPart), 2e-2, 1e-3));
}

// Motors that press a chain against all its limits: the limits hold.
TEST(Arm, IsNotPressedThroughItsLimits) {
  for (const float most : {1.0e2f, 1.0e4f, 1.0e6f}) {
    Assembly arm({.sleeping = false});
    BodyId last{};
    for (int i = 0; i < 6; ++i) {
      const BodyId body = arm.add({.pose = {.position = {0.3 * i + 0.15, 0, 0}}}, Box{{0.15f, 0.03f, 0.03f}});
      arm.joints.push_back(
          arm.world.add_joint(HingeDef{.a = last,
                                       .b = body,
                                       .anchor = {0.3 * i, 0, 0},
                                       .axis = {0, 0, 1},
                                       .limits = Limits{-0.5f, 0.5f},
                                       .motor = {.target_position = 3.0f, .max_force = most}}));
      last = body;
    }
    double beyond = 0.0;
    for (int i = 0; i < 240; ++i) {
      ASSERT_TRUE(arm.world.step(kStep));
      for (const JointId joint : arm.joints)
        beyond = std::max(beyond, std::abs(double(arm.world.joint_state(joint).position)) - 0.5);
    }
    EXPECT_TRUE(limit_row("a chain pressed beyond its limits (rad)", beyond, 5.0e-3, 1e-3));
    EXPECT_TRUE(limit_row("speed of its end then (m/s)", double(length(arm.world.linear_velocity(last))),
                          1e-2, 1e-3));
  }
}

// One that turns the whole arm keeps its speed, whatever hangs on it.
TEST(Arm, IsTurnedAtTheSpeedOfItsMotor) {
  for (const Held held : {Held::by_motors, Held::by_motors_alone}) {
    Assembly arm({.sleeping = false});
    build_arm(arm, held, 1.0e5f);
    const Motor turning{.target_velocity = 0.5f, .max_force = 1.0e5f};
    if (held == Held::by_motors) {
      ASSERT_TRUE(arm.world.set_motor(arm.joints[0], turning));
    } else {
      ASSERT_TRUE(arm.world.set_joint_axis(arm.joints[0], JointAxis::angular_x,
                                           {.motion = AxisMotion::free, .motor = turning}));
    }
    run(arm.world, 2.0);
    const double turned = double(arm.world.joint_axis_state(arm.joints[0], JointAxis::angular_x).position);
    EXPECT_TRUE(relative_row("turned in 2 s at 0.5 rad/s (rad)", turned, 1.0, 5e-3, 1e-3));
    const DVec3 end = arm.world.pose(arm.bodies.back()).position;
    EXPECT_TRUE(relative_row("reach of an arm that turns as one (m)", length(end), 5.5, 1e-3, 1e-4));
  }
}

}  // namespace
}  // namespace gyre::laws::arm_test
