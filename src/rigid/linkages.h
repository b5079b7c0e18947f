// Finds the linkages of a batch (solver/linkage.h): bodies that hang together by joints whose equations can be solved
// directly at a bounded price, and the order of their elimination. The rest stays with the sweeps.
#pragma once

#include "base/arena.h"
#include "rigid/rigid_world.h"
#include "rigid/solve_batches.h"
#include "solver/linkage.h"

namespace gyre {

struct Linkages {
  std::span<Linkage> linkages;
  std::span<const std::uint8_t> swept;  // by place in the batch's list of joints: 1 if it is in no linkage
};

// Of one batch; `places` are those of all (solve_batches.h).
Linkages find_linkages(const RigidWorld& w, const SolveBatch& batch, std::span<const std::uint32_t> places,
                       Arena& arena);

}  // namespace gyre
