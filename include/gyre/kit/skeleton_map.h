// From an animation's skeleton to a ragdoll of fewer bones and back.
//
// Some bones of the ragdoll stand for joints of the skeleton; the map keeps how they lie to each other in the rest poses, so the two
// may have different axes. Plain data and plain functions; nothing here knows a world. docs/ragdolls.md shows the round trip.
#pragma once

#include <gyre/kit/ragdoll.h>

#include <span>
#include <vector>

namespace gyre::kit {

struct SkeletonJoint {
  BoneName name{};
  int parent = -1;    // a joint before this one; -1: a root, of which there may be several
  Transform rest{};   // parent_from_joint in the rest pose; of a root: model_from_joint
};

struct Skeleton {
  std::vector<SkeletonJoint> joints{};
};

// A bone of the ragdoll that goes with a joint of the skeleton.
struct MappedBone {
  int bone = 0;
  int joint = 0;
};

struct SkeletonMap {
  // What moves a joint of the skeleton.
  struct Rule {
    int parent = -1;
    int bone = -1;  // goes with it
    // Else: between two joints that go with bones it shares what the animation's pose lacks to meet the second, `share` of it. Else
    // (-1) it keeps its local pose.
    int end = -1, first = -1;  // that second joint, and the first joint between the two
    float share = 0.0f;
  };
  std::vector<Rule> joints{};
  std::vector<int> joint_of_bone{};
  std::vector<Transform> joint_from_bone{};  // of each bone: in the rest poses
};

// Joins a ragdoll to a skeleton: by the given pairs, or, where there are none, by equal names. Every bone must get a joint, and of two
// bones the one above must get the joint above. The rest poses are taken to stand in one and the same model frame.
Result<SkeletonMap> make_skeleton_map(const RagdollDef& def, const Skeleton& skeleton,
                                      std::span<const MappedBone> pairs = {});

// Poses of a skeleton: parent_from_joint of every joint to model_from_joint, and back. Spans as long as there are joints, may not overlap.
void local_to_model(const Skeleton& skeleton, std::span<const Transform> local, std::span<Transform> model);
void model_to_local(const Skeleton& skeleton, std::span<const Transform> model, std::span<Transform> local);

// The target of a ragdoll from a pose of the skeleton: model_from_joint to model_from_bone. False if a span's length is wrong.
bool ragdoll_from_skeleton(const SkeletonMap& map, std::span<const Transform> model, std::span<Transform> bones);

// The pose of a skeleton from that of a ragdoll: model_from_bone to model_from_joint. `local`: the animation's pose, parent_from_joint,
// for joints without a bone. Fingers keep it. Joints between two that go with bones (a spine of four for one of two) keep it but for what is
// missing to meet the second: the way to it turned and stretched as a whole, its turn in equal shares. False if a span's length is
// wrong.
bool skeleton_from_ragdoll(const SkeletonMap& map, std::span<const Transform> bones,
                           std::span<const Transform> local, std::span<Transform> model);

}  // namespace gyre::kit
