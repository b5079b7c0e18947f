// The contacts of a batch as constraints.
#pragma once

#include "base/container/array.h"
#include "solver/contact/contact_block.h"
#include "solver/contact/impact.h"
#include "task/coloring.h"

#include <cstdint>

namespace gyre {

// Kept from step to step only for its memory.
struct ContactLists {
  Array<ContactConstraint> constraints;
  Array<std::uint32_t> slots;    // contact of each constraint
  Array<ColoringPair> pairs;     // between which bodies each is: indices in the batch, as far as they move
  Array<ImpactContact> impacts;  // of those with restitution
  Array<std::uint32_t> order;    // constraints, W a block
};

}  // namespace gyre
