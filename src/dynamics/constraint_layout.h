// Lays constraints out in the order and blocks of the kernels.
//
// In: constraints in colours. Out: groups of blocks that share no bodies.
#pragma once

#include "dynamics/batch_context.h"

namespace gyre {

// Lays coloured constraints out in blocks of W lanes, in at most kMaxGroups groups. Each group starts a new block. Constraints of the
// overflow group get a block each, so that they are solved one after the other at every width.
constexpr std::size_t kMaxGroups = 2 * (ColoringOptions::kMaxColors + 1);
std::span<ContactGroup> lay_out_contacts(BatchContext& batch, std::span<ContactGroup> room);
// Allocates these blocks.
void make_contact_blocks(BatchContext& batch, Arena& arena);
// Lays out the joints of each colour: first those solved in lanes, then the others.
void lay_out_joints(BatchContext& batch, Arena& arena);

}  // namespace gyre
