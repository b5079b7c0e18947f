// Finds the islands at rest that are no trees of contacts (solver/rest/static_equilibrium.h): they stand on the fixed world, nobody is
// joined to anything, everything is all but still and has friction, and few enough bodies lean on each other
// that solving them directly is cheap.
#pragma once

#include "rigid/rest/resting_islands.h"
#include "solver/rest/static_equilibrium.h"

namespace gyre {

// Of one batch; `pairs` are its constraints' bodies. Large islands that did not hold in the last step are looked at only now and then.
std::span<RestingStructure> find_resting_structures(const RigidWorld& w, std::span<const ColoringPair> pairs,
                                                    const SolveBatch& batch, const RestingIslands& islands,
                                                    Arena& arena);

// Tells the contacts where the kernels of `width` lanes keep them (find_kernel_places()).
void set_structure_positions(std::span<RestingStructure> structures, std::span<const std::uint32_t> positions,
                              int width);

}  // namespace gyre
