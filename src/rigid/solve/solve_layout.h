// Lays constraints out as the kernels want them.
//
// In: constraints in colours. Out: groups, each of blocks that do not share bodies.
#pragma once

#include "rigid/solve/solve.h"

namespace gyre {

// Lays the coloured constraints out in blocks of W lanes, in groups of which there is room for kMaxGroups. A group starts a new
// block; constraints of the overflow group get a block each, so that they are solved one after the other at every width.
constexpr std::size_t kMaxGroups = ColoringOptions::kMaxColors + 1;
std::span<Group> lay_out_contacts(BatchContext& solve, std::span<Group> room);
// Memory for these blocks.
void make_contact_blocks(BatchContext& solve, std::span<const Group> groups, Arena& arena);
// Of each colour first those joints that are solved side by side, then the others.
std::span<Group> lay_out_joints(BatchContext& solve, Arena& arena);

}  // namespace gyre
