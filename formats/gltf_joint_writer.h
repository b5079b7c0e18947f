// Joints as limits and drives of KHR_physics_rigid_bodies.
#pragma once

#include "scene/json_document.h"

#include <gyre/joints.h>

#include <optional>

namespace gyre {

struct GltfJoint {
  Json description;  // limits and drives
  DVec3 anchor_a{}, anchor_b{};
  Quat orientation{};       // of both frames
  bool is_complete = true;  // false: the joint has more than glTF can say
};

// None: glTF has no such joint.
std::optional<GltfJoint> gltf_joint(const JointDef& def);

// The frame with x along `axis` and z along the part of `axis_b` across it.
Quat joint_frame(Vec3 axis, const std::optional<Vec3>& axis_b);

}  // namespace gyre
