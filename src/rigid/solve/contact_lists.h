// Lists of the contacts of a batch, as constraints.
#pragma once

#include "base/container/array.h"
#include "solver/contact/contact_block.h"
#include "solver/contact/impact.h"
#include "task/coloring.h"

#include <cstdint>

namespace gyre {

// The lists persist between steps only to reuse their memory.
struct ContactLists {
  Array<ContactConstraint> constraints;
  Array<std::uint32_t> slots;    // contact of each constraint
  Array<ColoringPair> pairs;     // movable bodies of each: indices in the batch
  Array<ImpactContact> impacts;  // contacts with restitution
  Array<std::uint32_t> order;    // constraints, W in each block
  Array<std::uint32_t> members;  // of a group, while it is laid out
};

}  // namespace gyre
