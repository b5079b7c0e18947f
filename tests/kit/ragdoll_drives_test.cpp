// Each way of driving a ragdoll against closed forms: kinematic, keyed, by motors, mixed, and handed over.
#include "kit/ragdoll_scenes.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace gyre::kit::ragdoll_drives_test {
namespace {

using namespace ragdoll_test;

TEST(Ragdoll, KinematicBonesAreWhereTheTargetIs) {
  const RagdollDef def = make_humanoid();
  World world = make_world();
  Ragdoll ragdoll = add(world, def, moving(def, 0));
  const BoneDrive kinematic{.kinematic = true};
  for (int i = 1; i <= 120; ++i) {
    const RagdollPose target = moving(def, i / 60.0);
    drive(world, def, ragdoll, target, {&kinematic, 1});
    // A step from a place of a few metres in floats, and turns of a tenth of a radian.
    ASSERT_LT(farthest(world, ragdoll, target), 1e-5);
    ASSERT_LT(max_turned(world, ragdoll, target), 1e-5);
  }
}

// A key to the world is a spring and damper on each bone's own mass: all sag by g / (2 pi f)^2.
TEST(Ragdoll, KeyedToTheWorldSagsLikeASpring) {
  const RagdollDef def = free_humanoid();
  for (const float frequency : {2.0f, 5.0f}) {
    World world = make_world();
    const RagdollPose target = rest_pose(def, {{0, 3, 0}, {}});
    Ragdoll ragdoll = add(world, def, target);
    const BoneDrive keyed{.key = {.strength = 1, .frequency = frequency}};
    for (int i = 0; i < 180; ++i) drive(world, def, ragdoll, target, {&keyed, 1});
    const double sag = target.world_from_model.position.y + double(target.bones[0].position.y) -
                       world.pose(ragdoll.bones[0].body).position.y;
    const double expected = kGravity / std::pow(2 * kPiDouble * double(frequency), 2);
    EXPECT_TRUE(row("keyed to the world: sag, m", sag, expected, 0.002 * expected));
    EXPECT_LT(max_turned(world, ragdoll, target), 2e-4);
    // Half the strength: half the stiffness.
    const BoneDrive half{.key = {.strength = 0.5f, .frequency = frequency}};
    for (int i = 0; i < 240; ++i) drive(world, def, ragdoll, target, {&half, 1});
    const double more = target.world_from_model.position.y + double(target.bones[0].position.y) -
                        world.pose(ragdoll.bones[0].body).position.y;
    EXPECT_TRUE(row("the same at half strength", more, 2 * expected, 0.004 * expected));
  }
}

// At a steady speed and turning it lags behind by nothing; when swinging, by about acceleration / (2 pi f)^2.
TEST(Ragdoll, KeyedFollowsWithoutLag) {
  const RagdollDef def = free_humanoid();
  for (const bool to_root : {false, true}) {
    World world = make_world({});
    const auto steady = [&](double time) {
      return rest_pose(def, {{2.0 * time, 3, -time}, from_axis_angle({0, 1, 0}, float(0.0 * time))});
    };
    Ragdoll ragdoll = add(world, def, steady(0));
    std::vector<BoneDrive> drives(def.bones.size(),
                                  {.key = {.strength = 1, .frequency = 6}, .key_to_root = to_root});
    drives[0].kinematic = to_root;
    for (int i = 1; i <= 180; ++i) drive(world, def, ragdoll, steady(i / 60.0), drives);
    // Three hundredths of a step's way of 37 mm: what the parts of a step differ by in speed.
    EXPECT_TRUE(row(
        to_root ? "keyed to the root, steady motion: lag, m" : "keyed to the world, steady motion: lag, m",
        farthest(world, ragdoll, steady(3.0)), 0.0, 0.03 * std::sqrt(5.0) / 60));
  }
  World world = make_world({});
  Ragdoll ragdoll = add(world, def, moving(def, 0));
  const BoneDrive stiff{.key = {.strength = 1}};
  double turned = 0, far = 0;
  for (int i = 1; i <= 240; ++i) {
    const RagdollPose target = moving(def, i / 60.0);
    drive(world, def, ragdoll, target, {&stiff, 1});
    if (i < 60) continue;
    turned = std::max(turned, max_turned(world, ragdoll, target));
    far = std::max(far, farthest(world, ragdoll, target));
  }
  std::printf("[row] keyed as stiffly as the step allows, walking: off by %.2f mm and %.2f degrees at most\n",
              1e3 * far, turned / double(kDegree));
  EXPECT_LT(far, 0.01);
  EXPECT_LT(turned, 0.03);
}

// The motor's spring against gravity: k angle = m g l cos(angle), k = (2 pi f)^2 I of the arm about the joint for a hinge.
TEST(Ragdoll, MotorsSagAsTheirFrequencySays) {
  const double m = 2.0, l = 0.3, radius = 0.05, half = 0.25;
  // Capsule about its end: cylinder and two halves of a ball.
  const double cylinder = kPiDouble * radius * radius * 2 * half,
               ball = 4.0 / 3 * kPiDouble * std::pow(radius, 3);
  const double rho = m / (cylinder + ball);
  const double across = rho * cylinder * (radius * radius / 4 + half * half / 3) +
                        rho * ball * (0.4 * radius * radius + half * half + 0.75 * radius * half);
  const double inertia = across + m * l * l;
  for (const float frequency : {1.5f, 4.0f, 10.0f}) {
    const RagdollDef def = arm_def(BoneJointKind::hinge);
    World world = make_world();
    Ragdoll ragdoll = add(world, def, rest_pose(def));
    const BoneDrive drives[] = {{.kinematic = true}, {.motor = {.strength = 1, .frequency = frequency}}};
    for (int i = 0; i < 300; ++i) drive(world, def, ragdoll, rest_pose(def), drives);
    const double k = std::pow(2 * kPiDouble * double(frequency), 2) * inertia;
    double sag = 0;
    for (int i = 0; i < 50; ++i) sag = m * kGravity * l * std::cos(sag) / k;
    const double measured = -double(bone_rotation(def, read_ragdoll(world, def, ragdoll), 1).x);
    EXPECT_TRUE(row("hinge motor: sag, rad", measured, sag, 0.005 * sag + 2e-6));
  }
}

// A cone's motor: the same stiffness for all directions is that of the mean; measured by a torque about the vertical at two
// strengths, and that it holds up to its torque and gives way beyond.
TEST(Ragdoll, MotorsGiveWayAtTheirTorque) {
  for (const BoneJointKind kind : {BoneJointKind::hinge, BoneJointKind::cone, BoneJointKind::ball}) {
    RagdollDef def = arm_def(kind);
    const double weight = 2.0 * kGravity * 0.3;  // N m, held level
    for (const double share : {0.9, 1.1}) {
      def.bones[1].joint.max_torque = float(weight / share);
      World world = make_world();
      Ragdoll ragdoll = add(world, def, rest_pose(def));
      const BoneDrive drives[] = {{.kinematic = true}, {.motor = {.strength = 1, .frequency = 0}}};
      double turned = 0;
      for (int i = 0; i < 120; ++i) {
        drive(world, def, ragdoll, rest_pose(def), drives);
        turned = std::max(turned, double(length(bone_rotation(def, read_ragdoll(world, def, ragdoll), 1))));
      }
      if (share < 1) {
        EXPECT_LT(turned, 2e-3) << int(kind);
      } else {
        EXPECT_GT(turned, 0.3) << int(kind);
      }
    }
  }
}

TEST(Ragdoll, MotorsReachThePose) {
  RagdollDef def = *stabilized(free_humanoid());
  for (BoneDef& bone : def.bones)
    bone.shapes[0].filter.group = -1;  // poses in which limbs cross can be reached then
  std::mt19937 random(11);
  double turned = 0;
  for (int k = 0; k < 10; ++k) {
    World world = make_world({});
    const Pose at{{0, 2, 0}, {}};
    Ragdoll ragdoll = add(world, def, random_pose(def, at, random, 0.8f));
    const RagdollPose target = random_pose(def, at, random, 0.8f);
    const BoneDrive motor{.motor = {.strength = 1}};
    for (int i = 0; i < 240; ++i) drive(world, def, ragdoll, target, {&motor, 1});
    const RagdollPose now = read_ragdoll(world, def, ragdoll);
    for (std::size_t i = 1; i < def.bones.size(); ++i) {
      turned = std::max(turned, double(length(bone_rotation(def, now, int(i)) - bone_rotation(def, target, int(i)))));
    }
  }
  std::printf("[row] motors, no gravity, ten random poses: off by %.4f degrees at most\n",
              turned / double(kDegree));
  EXPECT_LT(turned / double(kDegree), 1.0);
}

// Kinematic, then let go or driven by motors: no velocity changes at the hand-over itself.
TEST(Ragdoll, HandOversKeepVelocities) {
  const RagdollDef def = make_humanoid();
  for (const bool motors : {false, true}) {
    World world = make_world({});
    Ragdoll ragdoll = add(world, def, moving(def, 0));
    const BoneDrive kinematic{.kinematic = true};
    const BoneDrive after{.motor = {.strength = motors ? 1.0f : 0.0f}};
    int i = 1;
    for (; i <= 60; ++i) drive(world, def, ragdoll, moving(def, i / 60.0), {&kinematic, 1});
    // At the bone's origin: a body's centre of mass is another one while it is kinematic.
    const auto velocity = [&](BodyId body) { return world.velocity_at(body, world.pose(body).position); };
    std::vector<Vec3> linear, angular;
    for (const RagdollBone& bone : ragdoll.bones) {
      linear.push_back(velocity(bone.body));
      angular.push_back(world.angular_velocity(bone.body));
    }
    ASSERT_EQ(drive_ragdoll(world, def, ragdoll, moving(def, i / 60.0), {&after, 1}, kStep).code,
              ErrorCode::none);
    for (std::size_t k = 0; k < linear.size(); ++k) {
      EXPECT_LT(length(velocity(ragdoll.bones[k].body) - linear[k]), 1e-6f);
      EXPECT_EQ(world.angular_velocity(ragdoll.bones[k].body), angular[k]);
      EXPECT_EQ(world.type(ragdoll.bones[k].body), BodyType::dynamic);
    }
    // And its momentum is that of what moved: the target's velocities are those of a body that hangs together, but for what the
    // second order in the step adds.
    const DVec3 before = world.momentum().linear;
    world.step(kStep);
    EXPECT_LT(length(world.momentum().linear - before), 1e-4 * length(before));
    double jump = 0;
    for (std::size_t k = 0; k < linear.size(); ++k)
      jump = std::max(jump, double(length(velocity(ragdoll.bones[k].body) - linear[k])));
    std::printf("[row] hand-over to %s: velocities change by %.3f m/s in the first step\n",
                motors ? "motors" : "nothing", jump);
    EXPECT_LT(jump, 0.35) << "accelerations of the pose itself are up to 9 m/s^2 at the hands, a step long";
  }
}

// The upper body kinematic, one arm limp, the legs on motors, a hand keyed: each does its own.
TEST(Ragdoll, BonesAreDrivenEachInItsOwnWay) {
  const RagdollDef def = make_humanoid();
  World world = make_world();
  const RagdollPose target = rest_pose(def, {{0, 3, 0}, {}});
  Ragdoll ragdoll = add(world, def, target);
  std::vector<BoneDrive> drives(def.bones.size(), {.kinematic = true});
  const auto at = [&](const char* name) { return std::size_t(find_bone(def, name)); };
  for (const char* name : {"left upper arm", "left forearm", "left hand"}) drives[at(name)] = {};
  for (const char* name : {"right upper arm", "right forearm"}) drives[at(name)] = {.key = {.strength = 1}};
  for (const char* name : {"left thigh", "left shank", "left foot"})
    drives[at(name)] = {.motor = {.strength = 1, .frequency = 8}};
  for (int i = 0; i < 600; ++i) drive(world, def, ragdoll, target, drives);
  const auto off = [&](const char* name) {
    return length((world.pose(ragdoll.bones[at(name)].body).position -
                   (target.world_from_model * target.bones[at(name)]).position));
  };
  EXPECT_GT(off("left hand"), 0.5) << "limp: it hangs";
  EXPECT_LT(off("right hand"), 5e-3) << "keyed";
  EXPECT_LT(off("left foot"), 0.02) << "on motors";
  EXPECT_LT(off("head"), 1e-5) << "kinematic";
  // The limp arm is drawn back, then left and right change places.
  for (const float frequency : {1.5f, 10.0f}) {
    for (const char* name : {"left upper arm", "left forearm", "left hand"})
      drives[at(name)] = {.key = {.strength = 1, .frequency = frequency}};
    for (int i = 0; i < 120; ++i) drive(world, def, ragdoll, target, drives);
  }
  for (const char* name :
       {"left upper arm", "left forearm", "left hand", "left thigh", "left shank", "left foot"})
    std::swap(drives[at(name)], drives[at((std::string("right") + (name + 4)).c_str())]);
  for (int i = 0; i < 120; ++i) drive(world, def, ragdoll, target, drives);
  EXPECT_LT(off("left hand"), 1e-5) << "kinematic now";
  EXPECT_LT(largest_gap(world, def, ragdoll), 1e-3);
  EXPECT_TRUE(world.problems().empty());
}

}  // namespace
}  // namespace gyre::kit::ragdoll_drives_test
