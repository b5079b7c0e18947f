// Direct solution of stacks at rest.
//
// Iteration over contacts cannot carry a tall tower: after a few iterations its joints are as stiff as a soft
// spring, and a slender column of soft springs buckles (docs/decisions/resting-trees.md has the figures). But
// where the contacts of an island form a tree rooted at the static world, it is statically determinate: at
// rest, the impulse in each contact is the one that stops everything beyond it. So momenta are summed from
// the leaves to the root, and every contact is tested for this wrench (centre of pressure inside the patch,
// inside the friction ellipsoid). If all pass, the answer is exact for any height and mass ratio, and costs
// less than an iteration. If one fails, something is about to slide, tip or fly, and the result of the
// iterations stands.
//
// This is block elimination of welds (R. Featherstone, "Rigid Body Dynamics Algorithms", ch. 8, for
// constraint trees; every elimination is trivial since the root does not move), used as a guess of the active
// set that is checked.
#pragma once

#include "base/container/array.h"
#include "solver/contact/contact_block.h"

#include <span>

namespace gyre {

// A body of a tree and the contact with its parent. Parents come before children.
struct TreeNode {
  std::int32_t body = kNoBody;
  std::int32_t parent = -1;      // node of the body below; -1: the static world
  std::uint32_t constraint = 0;  // the contact with the parent
  std::uint32_t block = 0;       // position in the kernels' blocks
  std::uint32_t lane = 0;
  float sign = 1.0f;              // 1 if the body is the constraint's b
  float rest_speed = 0.0f;        // m/s, rad/s: slower bodies count as at rest
  float rest_spin = 0.0f;
  float mass = 0.0f;
  DVec3 center;  // as are the next, at the beginning of the step
  Quat orientation;
  Sym3 inertia;                   // body frame
};

// Nodes [begin, end) of one island.
struct RestingTree {
  std::uint32_t begin = 0, end = 0;
};

// The velocity of the upper body against the lower that removes the errors of the contact's points: a speed
// along the normal at the patch's middle, and a tilt.
struct TreeCorrection {
  Vec3 velocity;  // at the middle of the points
  Vec3 tilt;      // rad/s
  Vec3 middle;    // from B's centre of mass
};

// Scratch data of a node.
struct TreeScratch {
  DVec3 momentum, spin;      // of the subtree, about the node's contact point
  DVec3 point;               // the contact point, from a common origin near the tree
  ContactImpulse impulse;    // proposed
  TreeCorrection correction;
  Vec3 linear, angular;  // velocity that removes errors of position
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

// After the last iteration of a step: stops the tree if its contacts can do that, and moves its bodies to
// remove errors of position.
void solve_tree(const RestingTree& tree, const TreeSolve& solve);

}  // namespace gyre
