// Finds the resting islands with loops of contacts (solver/rest/static_equilibrium.h). Such an island stands on the
// fixed world, has friction at all contacts and no joints, and its bodies are calm. It is small and sparse enough
// that a direct solve is cheap.
#pragma once

#include "rigid/rest/resting_islands.h"
#include "solver/rest/static_equilibrium.h"

namespace gyre {

// Of one batch; `pairs` are the bodies of its constraints. A large island that was not in equilibrium in the last
// step is tried now and then only.
std::span<RestingStructure> find_resting_structures(const RigidWorld& w, std::span<const ColoringPair> pairs,
                                                    const SolveBatch& batch, const RestingIslands& islands,
                                                    Arena& arena);

// Stores in each contact its block and lane in the memory of the kernels of `width` lanes (find_kernel_positions()).
void set_structure_positions(std::span<RestingStructure> structures, std::span<const std::uint32_t> positions,
                             int width);

}  // namespace gyre
