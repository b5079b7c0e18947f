// Finds the islands that hang on the fixed world as trees of contacts and rest (solver/rest/resting_tree.h): the number of
// contacts equals the number of bodies, one of them is with the fixed world, every patch has three points or more and
// friction, nobody is joined to anything, and everybody is slow.
#pragma once

#include "rigid/rest/resting_islands.h"
#include "solver/rest/resting_tree.h"

namespace gyre {

struct RestingTrees {
  std::span<RestingTree> trees;
  std::span<TreeNode> nodes;
  std::span<TreeScratch> work;
};

// Of one batch; `pairs` are its constraints' bodies. Marks the constraints that are in trees as rigid.
RestingTrees find_resting_trees(const RigidWorld& w, std::span<ContactConstraint> constraints,
                                std::span<const ColoringPair> pairs, const SolveBatch& batch,
                                const RestingIslands& islands, Arena& arena);

// Tells the nodes where the kernels of `width` lanes keep their contacts (find_kernel_places()).
void set_tree_positions(RestingTrees& trees, std::span<const std::uint32_t> positions, int width);

}  // namespace gyre
