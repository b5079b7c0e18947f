// Maps poses from an animation's skeleton to a ragdoll of fewer bones and back.
//
// Each bone of the ragdoll is paired with a joint of the skeleton. The map has the relative pose of each pair in the rest poses, so the two
// may have different axes. Plain data and plain functions, independent of a world. docs/ragdolls.md shows the round trip.
#pragma once

#include <gyre/kit/ragdoll.h>

#include <span>
#include <vector>

namespace gyre::kit {

struct SkeletonJoint {
  BoneName name{};
  int parent = -1;    // a joint before this one; -1: a root (there may be several)
  Transform rest{};   // parent_from_joint in the rest pose; of a root: model_from_joint
};

struct Skeleton {
  std::vector<SkeletonJoint> joints{};
};

// A bone of the ragdoll paired with a joint of the skeleton.
struct MappedBone {
  int bone = 0;
  int joint = 0;
};

struct SkeletonMap {
  // How a joint of the skeleton gets its pose.
  struct Rule {
    int parent = -1;
    int bone = -1;  // the paired bone
    // A joint without a bone that lies between two paired joints takes `share` of the correction with which the chain between them meets
    // the second one. `end` is that second joint, `first` the first joint of the chain. With end = -1 the joint keeps its local pose.
    int end = -1, first = -1;
    float share = 0.0f;
  };
  std::vector<Rule> joints{};
  std::vector<int> joint_of_bone{};
  std::vector<Transform> joint_from_bone{};  // of each bone, in the rest poses
};

// Maps a ragdoll to a skeleton by the given pairs, or by equal names if there are none. Every bone needs a joint, and the parent of a bone
// needs an ancestor of the bone's joint. Both rest poses are in the same model frame.
Result<SkeletonMap> make_skeleton_map(const RagdollDef& def, const Skeleton& skeleton,
                                      std::span<const MappedBone> pairs = {});

// Converts poses of a skeleton from parent_from_joint to model_from_joint, and back. The spans have one element a joint and do not overlap.
void local_to_model(const Skeleton& skeleton, std::span<const Transform> local, std::span<Transform> model);
void model_to_local(const Skeleton& skeleton, std::span<const Transform> model, std::span<Transform> local);

// Computes the target of a ragdoll from a pose of the skeleton: model_from_joint to model_from_bone. False if a span's length is wrong.
bool ragdoll_from_skeleton(const SkeletonMap& map, std::span<const Transform> model, std::span<Transform> bones);

// Computes the pose of a skeleton from the pose of a ragdoll: model_from_bone to model_from_joint. `local` is the animation's pose,
// parent_from_joint, for joints without a bone. End joints (fingers) keep it. Joints between two paired joints (a spine of four joints for
// two bones) keep it up to a correction: the chain is rotated and stretched as a whole to meet the second joint, whose rotation is shared
// equally. False if a span's length is wrong.
bool skeleton_from_ragdoll(const SkeletonMap& map, std::span<const Transform> bones,
                           std::span<const Transform> local, std::span<Transform> model);

}  // namespace gyre::kit
