// Stacks at rest, solved directly.
//
// Sweeping over contacts one by one cannot hold a tall tower: the stiffness that a few sweeps give a joint of the tower is
// that of a soft spring, and a slender column of soft springs buckles (docs/decisions/contact-trees.md has the figures). But
// where the contacts of an island form a tree that hangs on the fixed world, it is statically determinate: if everything
// rests, the impulse in each contact is what stops everything beyond it. So: sum momenta from the leaves to the root, and
// ask of every contact whether its points and its friction can bear that wrench (centre of pressure inside the patch, inside
// the friction ellipsoid). If all can, the answer is exact, for any height and any mass ratio, and costs less than a sweep.
// If one cannot, something is about to slide, tip or fly, and the sweeps' result stands.
//
// This is block elimination of welds (R. Featherstone, "Rigid Body Dynamics Algorithms", ch. 8, for constraint trees; here
// every elimination is trivial since the root does not move), used as a guess of the active set that is checked.
#pragma once

#include "base/container/array.h"
#include "solver/contact/contact_block.h"

#include <span>

namespace gyre {

// A body of a tree and the contact through which it hangs on its parent. Parents come before children.
struct TreeNode {
  std::int32_t body = kNoBody;
  std::int32_t parent = -1;       // node of the body below; -1: the fixed world
  std::uint32_t constraint = 0;   // the contact with it
  std::uint32_t block = 0;        // where the kernels hold it
  std::uint32_t lane = 0;
  float sign = 1.0f;              // 1 if the body is the constraint's b
  float rest_speed = 0.0f;             // m/s, rad/s: slower than this nothing is left to solve
  float rest_spin = 0.0f;
  float mass = 0.0f;
  DVec3 center;                   // as the step began, as is
  Quat orientation;
  Sym3 inertia;                   // body frame
};

// Nodes [begin, end) of one island.
struct RestingTree {
  std::uint32_t begin = 0, end = 0;
};

// The twist of the upper body against the lower that takes back the errors of the contact's points: speed along the normal
// at the patch's middle, and a tilt.
struct TreeCorrection {
  Vec3 velocity;  // at the middle of the points
  Vec3 tilt;      // rad/s
  Vec3 middle;    // from B's centre of mass
};

// What a solve needs of a node while it works.
struct TreeScratch {
  DVec3 momentum, spin;      // of the subtree, about the node's contact point
  DVec3 point;               // the contact point, from a common origin near the tree
  ContactImpulse impulse;    // proposed
  TreeCorrection correction;
  Vec3 linear, angular;      // velocity that takes errors of place back
};

struct TreeSolve {
  std::span<const TreeNode> nodes;
  std::span<TreeScratch> work;
  std::span<const ContactConstraint> constraints;
  BodyMotion* motion = nullptr;
  const ContactKernels* kernels = nullptr;
  void* blocks = nullptr;
  float step = 0.0f;  // s
};

// After the last sweep of a step: brings the tree to rest if its contacts can do that, and moves its bodies to take back what errors of place
// there are.
void solve_tree(const RestingTree& tree, const TreeSolve& solve);

}  // namespace gyre
