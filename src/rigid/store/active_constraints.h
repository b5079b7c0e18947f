// Bit sets of the contacts and joints that touch an awake body. Later stages visit only these, so sleeping islands
// cost nothing.
//
// Bits are by slot. Each contact or joint of a simulated body has its bit at any time. Some others have theirs, too:
// contacts of shapes whose boxes changed, since these may have to be removed, and constraints of bodies that fell
// asleep during the step. While few bodies sleep, all bits are set.
#pragma once

#include "base/container/bitset.h"

#include <cstdint>

namespace gyre {

struct RigidWorld;

struct ActiveConstraints {
  Bitset contacts, joints;
  bool all = false;  // all bits are always set; tests compare with that
};

// Finds the sets after the new pairs of the step, while the list of changed shapes still exists.
void find_active_constraints(RigidWorld& w);
// Activates the constraints of a body that has just woken.
void activate_constraints_of(RigidWorld& w, std::uint32_t body);
void activate_joint(RigidWorld& w, std::uint32_t joint);
// Sets all bits. A loaded state begins so.
void activate_all_constraints(RigidWorld& w);

}  // namespace gyre
