// Finds the resting islands whose contacts form a tree that is rooted in the fixed world
// (solver/rest/resting_tree.h). The number of contacts equals the number of bodies, one contact is with the fixed
// world, every contact has three points or more and friction, there are no joints, and all bodies are slow.
#pragma once

#include "rigid/rest/resting_islands.h"
#include "solver/rest/resting_tree.h"

namespace gyre {

struct RestingTrees {
  std::span<RestingTree> trees;
  std::span<TreeNode> nodes;
  std::span<TreeScratch> work;
};

// Of one batch; `pairs` are the bodies of its constraints. Marks the constraints of trees as rigid.
RestingTrees find_resting_trees(const RigidWorld& w, std::span<ContactConstraint> constraints,
                                std::span<const ColoringPair> pairs, const SolveBatch& batch,
                                const RestingIslands& islands, Arena& arena);

// Stores in each node the block and lane of its contact in the memory of the kernels of `width` lanes
// (find_kernel_positions()).
void set_tree_positions(RestingTrees& trees, std::span<const std::uint32_t> positions, int width);

}  // namespace gyre
