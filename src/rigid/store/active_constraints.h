// Contacts and joints of bodies that go along in a step: whoever works on these asks no others, so that what sleeps costs nothing,
// however much there is of it.
//
// Bits by slot. A contact or joint of a body that goes along has its bit at any time; others may have theirs: contacts of shapes whose
// boxes changed, for they may be gone, and whatever had a body that has fallen asleep since the step began. While few bodies sleep
// all have theirs.
#pragma once

#include "base/container/bitset.h"

#include <cstdint>

namespace gyre {

struct RigidWorld;

struct ActiveConstraints {
  Bitset contacts, joints;
  bool all = false;  // all have theirs, always: tests compare with that
};

// Finds them anew, after the step's new pairs and before the list of changed shapes is forgotten.
void find_active_constraints(RigidWorld& w);
// Those of a body that has just woken, and a joint that is new.
void activate_constraints_of(RigidWorld& w, std::uint32_t body);
void activate_joint(RigidWorld& w, std::uint32_t joint);
// All of them: as a state begins of which nothing is known yet.
void activate_all_constraints(RigidWorld& w);

}  // namespace gyre
