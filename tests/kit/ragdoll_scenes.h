// Ragdolls for tests: worlds and poses to put them in, and how far they are from where they should be.
#pragma once

#include <gyre/gyre.h>
#include <gyre/kit/ragdoll.h>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace gyre::kit::ragdoll_test {

inline constexpr float kStep = 1.0f / 60.0f;
inline constexpr float kDegree = kPi / 180.0f;
inline constexpr double kGravity = 9.81;

inline World make_world(Vec3 gravity = {0, -9.81f, 0}, int threads = 1) {
  WorldDef def;
  def.gravity = gravity;
  def.threads = threads;
  return std::move(*World::create(def));
}
inline void add_ground(World& world) { world.add_body({.type = BodyType::fixed}, {.geometry = Plane{}}); }

inline bool row(const char* name, double measured, double expected, double good) {
  const double error = std::fabs(measured - expected);
  std::printf("[row] %-52s %10.5g expected %10.5g  off by %8.1e  good %8.1e\n", name, measured, expected,
              error, good);
  return error <= good;
}

// The largest gap of a joint (m), and the largest turn beyond limits (rad).
inline double largest_gap(const World& world, const RagdollDef& def, const Ragdoll& ragdoll) {
  double gap = 0;
  for (std::size_t i = 1; i < def.bones.size(); ++i) {
    const Pose parent = world.pose(ragdoll.bones[std::size_t(def.bones[i].parent)].body);
    gap = std::max(gap,
                   length(parent * def.bones[i].rest.position - world.pose(ragdoll.bones[i].body).position));
  }
  return gap;
}
inline double max_beyond(const RagdollDef& def, const RagdollPose& pose) {
  float most = 0;
  for (std::size_t i = 1; i < def.bones.size(); ++i) most = std::max(most, beyond_limits(def, pose, int(i)));
  return double(most);
}
inline double farthest(const World& world, const Ragdoll& ragdoll, const RagdollPose& target) {
  double far = 0;
  for (std::size_t i = 0; i < target.bones.size(); ++i) {
    const Pose wanted = target.world_from_model * target.bones[i];
    far = std::max(far, length(world.pose(ragdoll.bones[i].body).position - wanted.position));
  }
  return far;
}
inline double max_turned(const World& world, const Ragdoll& ragdoll, const RagdollPose& target) {
  float most = 0;
  for (std::size_t i = 0; i < target.bones.size(); ++i) {
    const Quat wanted = (target.world_from_model * target.bones[i]).orientation;
    most = std::max(
        most, length(to_rotation_vector(world.pose(ragdoll.bones[i].body).orientation * conjugate(wanted))));
  }
  return double(most);
}

inline Ragdoll add(World& world, const RagdollDef& def, const RagdollPose& start) {
  Result<Ragdoll> made = add_ragdoll(world, def, start);
  EXPECT_TRUE(made) << made.error().message;
  return made ? *made : Ragdoll{};
}
inline void drive(World& world, const RagdollDef& def, Ragdoll& ragdoll, const RagdollPose& target,
                  std::span<const BoneDrive> drives) {
  const Error e = drive_ragdoll(world, def, ragdoll, target, drives, kStep);
  ASSERT_EQ(e.code, ErrorCode::none) << e.message;
  ASSERT_TRUE(world.step(kStep));
}

inline float random_in(std::mt19937& random, float low, float high) {
  return low + (high - low) * float(random() % 100001) / 100000.0f;
}
inline Quat random_turn(std::mt19937& random) {
  Quat q{};
  do {
    q = {random_in(random, -1, 1), random_in(random, -1, 1), random_in(random, -1, 1),
         random_in(random, -1, 1)};
  } while (dot(q, q) > 1.0f || dot(q, q) < 0.01f);
  return normalized(q);
}
// Every joint somewhere within a share of its limits.
inline RagdollPose random_pose(const RagdollDef& def, const Pose& at, std::mt19937& random, float share) {
  RagdollPose pose = middle_pose(def, at);
  for (std::size_t i = 1; i < def.bones.size(); ++i) {
    const BoneJoint& j = def.bones[i].joint;
    const auto part = [&](const Limits& l) {
      return share * random_in(random, -0.5f, 0.5f) * (l.high - l.low);
    };
    const bool cone = j.kind == BoneJointKind::cone;
    turn_bone(def, pose, int(i),
              {part(j.turn), cone ? 0.7f * part(j.swing_y) : 0, cone ? 0.7f * part(j.swing_z) : 0});
  }
  return pose;
}

// Without friction in its joints: closed forms know none.
inline RagdollDef free_humanoid() {
  RagdollDef def = make_humanoid();
  for (BoneDef& bone : def.bones) bone.joint.friction = 0;
  return def;
}

// One limb on a root that does not move, hanging sideways.
inline RagdollDef arm_def(BoneJointKind kind, float mass = 2.0f, float length = 0.6f) {
  RagdollDef def;
  def.angular_damping = 0;
  BoneDef root;
  root.name = "root";
  root.shapes = {{.geometry = Box{{0.1f, 0.1f, 0.1f}}}};
  BoneDef arm;
  arm.name = "arm";
  arm.parent = 0;
  arm.rest.position = {0.1f, 0, 0};
  arm.shapes = {{.geometry = Capsule{0.05f, 0.5f * length - 0.05f},
                 .local = {{0.5f * length, 0, 0}, from_axis_angle({0, 0, 1}, -0.5f * kPi)}}};
  arm.mass = mass;
  arm.joint.kind = kind;
  arm.joint.axis = kind == BoneJointKind::hinge ? Vec3{0, 0, 1} : Vec3{1, 0, 0};
  arm.joint.turn = {-1.5f, 1.5f};
  arm.joint.swing_y = arm.joint.swing_z = {-1.5f, 1.5f};
  arm.joint.max_torque = 1000;
  def.bones = {root, arm};
  return def;
}

// A humanoid that walks on and turns, 3 m up.
inline RagdollPose moving(const RagdollDef& def, double time) {
  RagdollPose pose = rest_pose(def, {{0.8 * time, 3, 0}, from_axis_angle({0, 1, 0}, float(0.5 * time))});
  const float swing = 0.5f * float(std::sin(3 * time));
  turn_bone(def, pose, find_bone(def, "left thigh"), {0, 0, 0.4f + swing});
  turn_bone(def, pose, find_bone(def, "right thigh"), {0, 0, 0.4f - swing});
  turn_bone(def, pose, find_bone(def, "left shank"), {0.8f + swing, 0, 0});
  turn_bone(def, pose, find_bone(def, "left upper arm"), {0, -0.8f, swing});
  turn_bone(def, pose, find_bone(def, "right upper arm"), {0, 0.8f, -swing});
  turn_bone(def, pose, find_bone(def, "right forearm"), {0.9f + swing, 0, 0});
  turn_bone(def, pose, find_bone(def, "head"), {0.3f, 0.1f, swing});
  return pose;
}

}  // namespace gyre::kit::ragdoll_test
