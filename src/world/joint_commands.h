// How joints are added, changed and taken away. What is asked was checked before (command_check.cpp).
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
// A body's centre of mass has moved in it: its joints hold it where they held it before.
void shift_joint_ends(RigidWorld& w, std::uint32_t body, Vec3 by);

// Which axes a kind has that something may act on: a bit each.
std::uint32_t open_axes(JointKind kind);
bool has_pose_drive(JointKind kind);

}  // namespace gyre
