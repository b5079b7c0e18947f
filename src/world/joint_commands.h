// Adds, changes and removes joints and couplings. command_check.cpp has checked the arguments for joints.
#pragma once

#include "rigid/store/rigid_world.h"
#include "world/command.h"
#include "world/flat_joint.h"

namespace gyre {

JointId add_joint(RigidWorld& w, const FlatJoint& def);
void remove_joint(RigidWorld& w, std::uint32_t slot);
void set_motor(RigidWorld& w, std::uint32_t slot, const Motor& motor);
void set_joint_axis(RigidWorld& w, std::uint32_t slot, JointAxis axis, const JointAxisDef& def);
void set_drive(RigidWorld& w, std::uint32_t slot, const PoseDrive& drive);
// Clears the impulses of the last step, and keeps the positions of the axes.
void forget_impulses(RigidWorld& w, std::uint32_t slot);
void set_joint_enabled(RigidWorld& w, std::uint32_t slot, bool enabled);
// Disables the collision of two bodies once more; their contacts are removed. And takes one of these back.
void block_bodies(RigidWorld& w, std::uint32_t a, std::uint32_t b);
void unblock_bodies(RigidWorld& w, std::uint32_t a, std::uint32_t b);
// The centre of mass of a body moved within the body: joints keep their anchors.
void shift_joint_ends(RigidWorld& w, std::uint32_t body, Vec3 by);

// The axes of a kind that limits, motors and springs can act on, one bit each.
std::uint32_t open_axes(JointKind kind);
bool has_pose_drive(JointKind kind);

// Couplings: coupling_commands.cpp.
Error check(const WorldState& state, const AddCoupling& c);
Error check(const WorldState& state, const RemoveCoupling& c);
CommandResult execute(WorldState& state, const AddCoupling& c);
CommandResult execute(WorldState& state, const RemoveCoupling& c);

// True if the coupling of an id exists.
bool is_coupling(const WorldState& state, CouplingId id);
// Why loaded couplings cannot be a state; null if they can.
const char* fault_in_couplings(const RigidWorld& w);

}  // namespace gyre
