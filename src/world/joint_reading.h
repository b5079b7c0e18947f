// What can be read of joints: forces, places and speeds on their axes, energy in their springs.
#pragma once

#include "rigid/store/rigid_world.h"

#include <gyre/world.h>

namespace gyre {

// The places of a joint's two anchors.
struct JointAnchors {
  DVec3 a, b;
};
JointAnchors joint_anchors(const RigidWorld& w, const JointRecord& joint);

JointState read_joint(const RigidWorld& w, std::uint32_t slot);
JointAxisState read_joint_axis(const RigidWorld& w, std::uint32_t slot, JointAxis axis);
// J.
double spring_energy(const RigidWorld& w, std::uint32_t slot);

}  // namespace gyre
