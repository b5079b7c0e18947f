// Ragdolls and finer skeletons: what goes over comes back, whatever axes the two have, and what lies between is shared out.
#include <gyre/gyre.h>
#include <gyre/kit/skeleton_map.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace gyre::kit::skeleton_map_test {
namespace {

float random_in(std::mt19937& random, float low, float high) {
  return low + (high - low) * float(random() % 100001) / 100000.0f;
}
Quat random_turn(std::mt19937& random, float most) {
  return from_rotation_vector(
      {random_in(random, -most, most), random_in(random, -most, most), random_in(random, -most, most)});
}

// A joint for every bone, four more in the back (one of them with a rib), a collar bone and a twisting joint in each arm, fingers and toes;
// every joint with axes of its own.
Skeleton make_skeleton(const RagdollDef& def, std::vector<Transform>& model) {
  Skeleton skeleton;
  std::mt19937 random(3);
  const RagdollPose rest = rest_pose(def);
  model.clear();
  const auto add = [&](const std::string& name, int parent, Vec3 place) {
    const Transform at{place, random_turn(random, 2)};
    SkeletonJoint joint{name.c_str(), parent, parent < 0 ? at : inverse_times(model[std::size_t(parent)], at)};
    skeleton.joints.push_back(joint);
    model.push_back(at);
    return int(model.size()) - 1;
  };
  const auto place = [&](std::size_t bone) { return rest.bones[bone].position; };
  add("floor", -1, {});
  std::vector<int> joint_of(def.bones.size());
  for (std::size_t i = 0; i < def.bones.size(); ++i) {
    const BoneDef& bone = def.bones[i];
    int parent = bone.parent < 0 ? 0 : joint_of[std::size_t(bone.parent)];
    const Vec3 from = bone.parent < 0 ? Vec3{} : place(std::size_t(bone.parent)), to = place(i);
    const std::string bone_name(bone.name);
    const bool back = bone_name == "abdomen" || bone_name == "chest";
    const bool arm = bone_name.find("arm") != std::string::npos;
    if (back) {
      parent = add("lower " + bone_name, parent, lerp(from, to, 0.3f));
      if (bone_name == "chest") add("rib", parent, lerp(from, to, 0.3f) + Vec3{0.1f, 0, 0});
      parent = add("upper " + bone_name, parent, lerp(from, to, 0.7f) + Vec3{0, 0, -0.03f});
    } else if (arm) {
      parent = add("before " + bone_name, parent, lerp(from, to, 0.5f));
    }
    joint_of[i] = add(bone_name, parent, to);
    if (bone_name.find("hand") != std::string::npos) {
      const int finger = add("finger of " + bone_name, joint_of[i], to + Vec3{to.x > 0 ? 0.1f : -0.1f, 0, 0});
      add("tip of " + bone_name, finger, to + Vec3{to.x > 0 ? 0.15f : -0.15f, 0, 0});
    }
  }
  return skeleton;
}

float apart(const Transform& a, const Transform& b) {
  const Quat q = a.orientation * conjugate(b.orientation);
  return std::max(length(a.position - b.position), 2 * length(Vec3{q.x, q.y, q.z}));
}
int find_joint(const Skeleton& skeleton, const std::string& name) {
  for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
    if (std::string_view(skeleton.joints[i].name) == name) return int(i);
  }
  return -1;
}

std::vector<Transform> random_local(const Skeleton& skeleton, std::mt19937& random, float most) {
  std::vector<Transform> local;
  for (const SkeletonJoint& joint : skeleton.joints) {
    local.push_back(joint.rest);
    local.back().orientation = normalized(local.back().orientation * random_turn(random, most));
  }
  return local;
}

TEST(SkeletonMap, TheRestPosesAreEachOthers) {
  const RagdollDef def = make_humanoid();
  std::vector<Transform> rest;
  const Skeleton skeleton = make_skeleton(def, rest);
  const Result<SkeletonMap> map = make_skeleton_map(def, skeleton);
  ASSERT_TRUE(map) << map.error().message;
  std::vector<Transform> bones(def.bones.size()), back(rest.size()), local(rest.size()), again(rest.size());
  ASSERT_TRUE(ragdoll_from_skeleton(*map, rest, bones));
  const RagdollPose pose = rest_pose(def);
  for (std::size_t i = 0; i < bones.size(); ++i) EXPECT_LT(apart(bones[i], pose.bones[i]), 2e-6f);
  model_to_local(skeleton, rest, local);
  ASSERT_TRUE(skeleton_from_ragdoll(*map, pose.bones, local, back));
  local_to_model(skeleton, local, again);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    EXPECT_LT(apart(back[i], rest[i]), 2e-6f) << skeleton.joints[i].name.c_str();
    EXPECT_LT(apart(again[i], rest[i]), 2e-6f);
  }
}

// To a millionth, of metres and of radians: 1e-6 for places within 2 m is eight roundings of a float.
TEST(SkeletonMap, WhatGoesOverComesBack) {
  const RagdollDef def = make_humanoid();
  std::vector<Transform> rest;
  const Skeleton skeleton = make_skeleton(def, rest);
  const SkeletonMap map = *make_skeleton_map(def, skeleton);
  std::mt19937 random(8);
  float worst_skeleton = 0, worst_bones = 0;
  for (int k = 0; k < 200; ++k) {
    const std::vector<Transform> local = random_local(skeleton, random, 0.6f);
    std::vector<Transform> model(rest.size()), back(rest.size()), bones(def.bones.size()),
        again(def.bones.size());
    local_to_model(skeleton, local, model);
    ASSERT_TRUE(ragdoll_from_skeleton(map, model, bones));
    ASSERT_TRUE(skeleton_from_ragdoll(map, bones, local, back));
    for (std::size_t i = 0; i < model.size(); ++i)
      worst_skeleton = std::max(worst_skeleton, apart(back[i], model[i]));
    // A ragdoll that was thrown about, against the animation at rest.
    for (Transform& bone : bones)
      bone = {bone.position + Vec3{0, random_in(random, -0.01f, 0.01f), 0},
              normalized(bone.orientation * random_turn(random, 1))};
    ASSERT_TRUE(skeleton_from_ragdoll(map, bones, random_local(skeleton, random, 0.3f), back));
    ASSERT_TRUE(ragdoll_from_skeleton(map, back, again));
    for (std::size_t i = 0; i < bones.size(); ++i)
      worst_bones = std::max(worst_bones, apart(again[i], bones[i]));
  }
  std::printf("[row] there and back: skeleton %.1e, ragdoll %.1e (m, rad)\n", double(worst_skeleton),
              double(worst_bones));
  EXPECT_LT(worst_bones, 1e-6f);
  EXPECT_LT(worst_skeleton, 4e-6f)
      << "joints without a bone are reckoned anew from their parents: some roundings each";
}

// The chest turned by 90 degrees on a back of two joints between: each turns by its share; the rib goes with its joint, fingers keep their pose.
TEST(SkeletonMap, SharesATurnAmongTheJointsBetween) {
  const RagdollDef def = make_humanoid();
  std::vector<Transform> rest;
  const Skeleton skeleton = make_skeleton(def, rest);
  const SkeletonMap map = *make_skeleton_map(def, skeleton);
  std::vector<Transform> local(rest.size()), model(rest.size());
  model_to_local(skeleton, rest, local);
  RagdollPose pose = rest_pose(def);
  rotate_bone(def, pose, find_bone(def, "chest"), {0.9f, 0, 0});
  ASSERT_TRUE(skeleton_from_ragdoll(map, pose.bones, local, model));
  const auto turned = [&](const char* name) {
    const std::size_t i = std::size_t(find_joint(skeleton, name));
    return to_rotation_vector(model[i].orientation * conjugate(rest[i].orientation));
  };
  EXPECT_LT(length(turned("abdomen")), 1e-5f);
  EXPECT_LT(length(turned("lower chest") - Vec3{0, 0.3f, 0}), 1e-5f);
  EXPECT_LT(length(turned("upper chest") - Vec3{0, 0.6f, 0}), 1e-5f);
  EXPECT_LT(length(turned("rib") - Vec3{0, 0.3f, 0}), 1e-5f);
  EXPECT_LT(length(turned("chest") - Vec3{0, 0.9f, 0}), 1e-5f);
  EXPECT_LT(length(turned("tip of left hand") - Vec3{0, 0.9f, 0}), 1e-5f);
  // Places stay: the end is where it was.
  const std::size_t upper = std::size_t(find_joint(skeleton, "upper chest"));
  EXPECT_LT(length(model[upper].position - rest[upper].position), 1e-6f);
  // An end that has moved: the chain is turned and stretched to it as a whole.
  pose = rest_pose(def);
  const std::size_t chest = std::size_t(find_bone(def, "chest"));
  for (std::size_t i = chest; i < 10; ++i) pose.bones[i].position += Vec3{0, 0.02f, 0};
  ASSERT_TRUE(skeleton_from_ragdoll(map, pose.bones, local, model));
  const std::size_t lower = std::size_t(find_joint(skeleton, "lower chest")),
                    top = std::size_t(find_joint(skeleton, "chest"));
  EXPECT_LT(length(model[lower].position - rest[lower].position), 1e-6f)
      << "its place is its parent's to say";
  const float before =
      length(rest[upper].position - rest[lower].position) / length(rest[top].position - rest[lower].position);
  const float after = length(model[upper].position - model[lower].position) /
                      length(model[top].position - model[lower].position);
  EXPECT_NEAR(before, after, 1e-5f);
}

TEST(SkeletonMap, SaysWhatIsWrong) {
  const RagdollDef def = make_humanoid();
  std::vector<Transform> rest;
  Skeleton skeleton = make_skeleton(def, rest);
  const auto refused = [&](std::span<const MappedBone> pairs, const char* words) {
    const Result<SkeletonMap> map = make_skeleton_map(def, skeleton, pairs);
    EXPECT_FALSE(map);
    EXPECT_NE(std::string(map.error().message).find(words), std::string::npos) << map.error().message;
  };
  std::vector<MappedBone> pairs;
  for (int i = 0; i < int(def.bones.size()); ++i)
    pairs.push_back({i, find_joint(skeleton, def.bones[std::size_t(i)].name.c_str())});
  EXPECT_TRUE(make_skeleton_map(def, skeleton, pairs));
  std::vector<MappedBone> odd = pairs;
  odd[2].joint = 999;
  refused(odd, "joint 999");
  odd = pairs;
  odd[2].bone = 1;
  refused(odd, "in two pairs");
  odd = pairs;
  odd[2].joint = odd[1].joint;
  refused(odd, "goes with two bones");
  odd = pairs;
  std::swap(odd[1].joint, odd[2].joint);
  refused(odd, "not its parent bone");
  odd = pairs;
  odd.pop_back();
  refused(odd, "no joint for bone 'right foot'");
  skeleton.joints[3].parent = 3;
  refused({}, "parents stand before");
  skeleton.joints[3].parent = 2;
  skeleton.joints[3].rest.orientation = {0, 0, 0, 2};
  refused({}, "length 1");
  const SkeletonMap map = *make_skeleton_map(def, make_skeleton(def, rest));
  std::vector<Transform> bones(3);
  EXPECT_FALSE(ragdoll_from_skeleton(map, rest, bones));
  EXPECT_FALSE(skeleton_from_ragdoll(map, bones, rest, rest));
}

}  // namespace
}  // namespace gyre::kit::skeleton_map_test
