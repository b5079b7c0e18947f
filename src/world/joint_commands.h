// Adds, changes and removes joints. command_check.cpp has checked the arguments.
#pragma once

#include "rigid/store/rigid_world.h"
#include "world/flat_joint.h"

namespace gyre {

JointId add_joint(RigidWorld& w, const FlatJoint& def);
void remove_joint(RigidWorld& w, std::uint32_t slot);
void set_motor(RigidWorld& w, std::uint32_t slot, const Motor& motor);
void set_joint_axis(RigidWorld& w, std::uint32_t slot, JointAxis axis, const JointAxisDef& def);
void set_drive(RigidWorld& w, std::uint32_t slot, const PoseDrive& drive);
void set_joint_enabled(RigidWorld& w, std::uint32_t slot, bool enabled);
// Disables the collision of two bodies once more; their contacts are removed. And takes one of these back.
void block_bodies(RigidWorld& w, std::uint32_t a, std::uint32_t b);
void unblock_bodies(RigidWorld& w, std::uint32_t a, std::uint32_t b);
// The centre of mass of a body moved within the body: joints keep their anchors.
void shift_joint_ends(RigidWorld& w, std::uint32_t body, Vec3 by);

// The axes of a kind that limits, motors and springs can act on, one bit each.
std::uint32_t open_axes(JointKind kind);
bool has_pose_drive(JointKind kind);

}  // namespace gyre
