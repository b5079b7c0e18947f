// Converts poses of ragdolls: from orientations of bones to angles of joints, and back.
//
// The engine's joint has its zero where its two frames agree. The frame on the parent is that of the rest pose, rotated by `middle_turn` to
// the middle of the joint's limits, and the frame on the bone is fixed. So the engine's limits are even to both sides.
#include "kit/ragdoll_frames.h"

namespace gyre::kit {

Quat joint_frame(const BoneJoint& joint) {
  const Vec3 x = normalized(joint.axis);
  const Vec3 z = normalized(joint.across - dot(joint.across, x) * x, any_perpendicular(x));
  return normalized(from_matrix({x, cross(z, x), z}));
}

Quat middle_turn(const BoneJoint& joint) {
  const auto middle = [](const Limits& l) { return 0.5f * (l.low + l.high); };
  if (!is_limited(joint)) return {};
  const Quat twist = from_rotation_vector({middle(joint.twist), 0, 0});
  if (joint.kind == BoneJointKind::hinge) return twist;
  return from_rotation_vector({0, middle(joint.swing_y), middle(joint.swing_z)}) * twist;
}

Quat turned_bone(const BoneDef& bone, Quat turn) {
  const Quat frame = joint_frame(bone.joint);
  return normalized(bone.rest.orientation * (frame * turn * conjugate(frame)));
}
Quat turn_of(const BoneDef& bone, Quat parent_from_bone) {
  const Quat frame = joint_frame(bone.joint);
  return normalized(conjugate(frame) * (conjugate(bone.rest.orientation) * parent_from_bone) * frame);
}
Quat turn_between(const BoneDef& bone, Quat from_parent, Quat from_bone) {
  return turn_of(bone, conjugate(from_parent) * from_bone);
}

float twist_of(Quat turn) {
  const float angle = 2.0f * atan2(turn.x, turn.w);
  return angle > kPi ? angle - 2.0f * kPi : angle < -kPi ? angle + 2.0f * kPi : angle;
}

namespace {

RagdollPose pose_of_turns(const RagdollDef& def, const Pose& world_from_model, bool middle) {
  RagdollPose pose{world_from_model, {}};
  pose.bones.reserve(def.bones.size());
  for (const BoneDef& bone : def.bones) {
    Transform local = bone.rest;
    if (bone.parent < 0) {
      pose.bones.push_back(local);
      continue;
    }
    if (middle) local.orientation = turned_bone(bone, middle_turn(bone.joint));
    pose.bones.push_back(pose.bones[std::size_t(bone.parent)] * local);
  }
  return pose;
}

}  // namespace

RagdollPose rest_pose(const RagdollDef& def, const Pose& world_from_model) {
  return pose_of_turns(def, world_from_model, false);
}
RagdollPose middle_pose(const RagdollDef& def, const Pose& world_from_model) {
  return pose_of_turns(def, world_from_model, true);
}

void rotate_bone(const RagdollDef& def, RagdollPose& pose, int bone, Vec3 turn) {
  const std::size_t first = std::size_t(bone);
  const Transform before = pose.bones[first];
  const Quat frame = joint_frame(def.bones[first].joint);
  Transform after = before;
  after.orientation =
      normalized(before.orientation * (frame * from_rotation_vector(turn) * conjugate(frame)));
  const Transform moved = after * inverse(before);
  std::vector<bool> hangs(pose.bones.size(), false);
  hangs[first] = true;
  pose.bones[first] = after;
  for (std::size_t i = first + 1; i < pose.bones.size(); ++i) {
    const int parent = def.bones[i].parent;
    hangs[i] = parent >= 0 && hangs[std::size_t(parent)];
    if (!hangs[i]) continue;
    pose.bones[i] = moved * pose.bones[i];
    pose.bones[i].orientation = normalized(pose.bones[i].orientation);
  }
}

Vec3 bone_rotation(const RagdollDef& def, const RagdollPose& pose, int bone) {
  const BoneDef& b = def.bones[std::size_t(bone)];
  if (b.parent < 0) return {};
  return to_rotation_vector(turn_between(b, pose.bones[std::size_t(b.parent)].orientation,
                                         pose.bones[std::size_t(bone)].orientation));
}

float limit_violation(const RagdollDef& def, const RagdollPose& pose, int bone) {
  const BoneDef& b = def.bones[std::size_t(bone)];
  if (b.parent < 0 || !is_limited(b.joint)) return 0.0f;
  const auto half = [](const Limits& l) { return 0.5f * (l.high - l.low); };
  const Quat from_middle =
      conjugate(middle_turn(b.joint)) * turn_between(b, pose.bones[std::size_t(b.parent)].orientation,
                                                     pose.bones[std::size_t(bone)].orientation);
  const float twist = absolute(twist_of(from_middle)) - half(b.joint.twist);
  if (b.joint.kind == BoneJointKind::hinge) return max(twist, 0.0f);
  // The swing is the shortest rotation of x. It is compared with its ellipse along the path to it.
  const Vec3 x = rotate(from_middle, {1, 0, 0});
  const float sine = std::sqrt(x.y * x.y + x.z * x.z), angle = atan2(sine, x.x);
  if (!(sine > 1.0e-6f))
    return max(twist, angle > 1.0f ? kPi - max(half(b.joint.swing_y), half(b.joint.swing_z)) : 0.0f);
  const float about_y = -x.z / sine, about_z = x.y / sine;
  const auto share = [](float part, float most) { return square(part / max(most, 1.0e-3f)); };
  const float most =
      1.0f / std::sqrt(share(about_y, half(b.joint.swing_y)) + share(about_z, half(b.joint.swing_z)));
  return max(max(twist, angle - most), 0.0f);
}

int find_bone(const RagdollDef& def, std::string_view name) {
  for (std::size_t i = 0; i < def.bones.size(); ++i) {
    if (std::string_view(def.bones[i].name) == name) return int(i);
  }
  return -1;
}

int joints_between(const RagdollDef& def, int a, int b) {
  int count = 0;
  while (a != b) {
    // Parents come first, so the later one is never an ancestor of the other.
    int& later = a > b ? a : b;
    later = def.bones[std::size_t(later)].parent;
    ++count;
  }
  return count;
}

}  // namespace gyre::kit
