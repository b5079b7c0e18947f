// Finds the islands that hang on the fixed world as trees of contacts and rest (solver/contact_tree.h): the number of
// contacts equals the number of bodies, one of them is with the fixed world, every patch has three points or more and
// friction, nobody is joined to anything, and everybody is slow.
#pragma once

#include "base/arena.h"
#include "rigid/rigid_world.h"
#include "rigid/solve_batches.h"
#include "solver/contact_tree.h"

namespace gyre {

struct ContactForest {
  std::span<ContactTree> trees;
  std::span<TreeNode> nodes;
  std::span<TreeWork> work;
};

// Slower than this share of sqrt(gravity * reach) counts as at rest.
constexpr float kTreeRestShare = 0.1f;
// Slower than this share of it a sweep has left nothing to solve.
constexpr float kTreeStillShare = 1.0e-7f;

// Of one batch; `places` are those of all (solve_batches.h). Marks the constraints that are in trees as rigid.
ContactForest find_contact_trees(const RigidWorld& w, std::span<ContactConstraint> constraints, const SolveBatch& batch,
                                 std::span<const std::uint32_t> places, Arena& arena);

// Tells the nodes where the kernels keep their contacts: `order` has `width` constraint indices a block.
void place_tree_nodes(ContactForest& forest, std::span<const std::uint32_t> order, int width, std::size_t constraints,
                      Arena& arena);

}  // namespace gyre
