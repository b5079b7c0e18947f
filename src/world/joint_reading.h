// Readings of joints: forces, positions and speeds of their axes, energy of their springs.
#pragma once

#include "rigid/store/rigid_world.h"

#include <gyre/world.h>

namespace gyre {

// The positions of the two anchors of a joint.
struct JointAnchors {
  DVec3 a, b;
};
JointAnchors joint_anchors(const RigidWorld& w, const JointRecord& joint);

JointState read_joint(const RigidWorld& w, std::uint32_t slot);
JointAxisState read_joint_axis(const RigidWorld& w, std::uint32_t slot, JointAxis axis);
// J.
double spring_energy(const RigidWorld& w, std::uint32_t slot);

}  // namespace gyre
