// Frames of a ragdoll's joints, for all that reckons with angles.
#pragma once

#include <gyre/kit/ragdoll.h>

namespace gyre::kit {

// bone_from_joint: the joint's frame on the bone.
Quat joint_frame(const BoneJoint& joint);
// The bone's turn in the joint's frame, out of the rest pose, in the middle of its limits.
Quat middle_turn(const BoneJoint& joint);
// parent_from_bone's orientation when the bone is turned so.
Quat turned_bone(const BoneDef& bone, Quat turn);
// The other way: the turn in the joint's frame of a bone that stands so against its parent.
Quat turn_of(const BoneDef& bone, Quat parent_from_bone);
// The same between two bones' orientations in one frame.
Quat turn_between(const BoneDef& bone, Quat from_parent, Quat from_bone);
// Angle about x of a turn, -pi to pi: a hinge's, and the twist of a cone.
float twist_of(Quat turn);

inline bool is_limited(const BoneJoint& joint) {
  return joint.kind == BoneJointKind::cone || joint.kind == BoneJointKind::hinge;
}

// Mass properties of a bone as a body will have them, bone frame.
MassProperties bone_mass(const BoneDef& bone);

// How many joints lie between two bones.
int joints_between(const RagdollDef& def, int a, int b);

}  // namespace gyre::kit
