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

// A load of one along an axis as forces on the two bodies: `force` on b and its opposite on a, with torques about the centres of mass.
struct JointLoad {
  BodyId a{}, b{};  // null: the world
  Vec3 force;
  Vec3 torque_a, torque_b;
};
// False if limits and motors cannot act on such an axis.
bool read_joint_load(const RigidWorld& w, std::uint32_t slot, JointAxis axis, float load, JointLoad& out);

// The limits, motors and springs of an axis; the zero value where they cannot act.
JointAxisDef read_joint_axis_def(const RigidWorld& w, std::uint32_t slot, JointAxis axis);
Motor read_motor(const JointRecord& joint);

}  // namespace gyre
