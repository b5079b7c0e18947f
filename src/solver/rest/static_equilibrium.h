// Whatever rests on more contacts than it needs: card houses, towers of planks, pyramids, arches of dry stones.
//
// Such a structure is statically indeterminate: many impulses would hold it. By the safe theorem (J. Heyman, "The Stone
// Skeleton", 1966, after the lower bound theorem of plasticity) it stands if there is one that pulls nowhere and asks no contact
// for more friction than it has. So one is looked for: contacts are springs, whose loads are unique, K z = what must be
// borne, with K = J^T D J factored directly; a point that would pull lets go, one that would be pressed comes back, and where
// friction is asked for too much the contact gives way sideways (its secant stiffness falls), until nothing changes. What is found is
// exact: it bears all that acts, for any height and mass ratio. If nothing is found in a few rounds, something is
// about to slide, tip or fall, and the sweeps' result stands.
//
// Trees of contacts need none of this (solver/rest/resting_tree.h).
#pragma once

#include "math/block_ldlt.h"
#include "solver/contact/contact_block.h"

#include <span>

namespace gyre {

// A body of a structure.
struct StructureNode {
  std::int32_t body = kNoBody;
  float mass = 0.0f;
  float rest_speed = 0.0f;  // m/s, rad/s: slower than this nothing is left to solve
  float rest_spin = 0.0f;
  Sym3 inertia;  // world axes, as the step began
};

constexpr std::uint32_t kNoNode = 0xffffffffu;

struct StructureContact {
  std::uint32_t constraint = 0;
  std::uint32_t block = 0, lane = 0;                 // where the kernels hold it
  std::uint32_t node_a = kNoNode, node_b = kNoNode;  // kNoNode: the fixed world
  BlockPlace coupling;  // the block of the two in the matrix, `a` first; while it is solved

  bool is_between() const { return node_a != kNoNode && node_b != kNoNode; }
};

// What a solve needs of a contact while it works; kept from the first part of a step to its last.
struct StructureScratch {
  ContactImpulse before, impulse;          // as it was found, and proposed
  float shear = 0.0f;                      // stiffness sideways over that along the normal
  std::uint8_t touching = 0, loaded = 0;  // bits, by point: may bear, and bears
  double at[kMaxManifoldPoints] = {},
         rate[kMaxManifoldPoints] = {};  // how far pressed, and how that changes along the way
};

// Memory is the arena's.
struct RestingStructure {
  std::span<const StructureNode> nodes;
  std::span<StructureContact> contacts;
  std::span<StructureScratch> work;
  bool is_settling = false;  // it still moved as the step began
  bool was_rigid = false;      // it was solved in the last step
  bool is_new = false;     // its contacts bore nothing in the last step
  bool has_scratch = false;     // `work` is that of this step
  bool is_solved = false;    // in the first part of the step
};

struct StructureSolve {
  std::span<const ContactConstraint> constraints;
  BodyMotion* motion = nullptr;
  const ContactKernels* kernels = nullptr;
  void* blocks = nullptr;
  Arena* arena = nullptr;  // for what a solve needs while it works: one structure after the other
};

// A manifold that is part of a structure solved directly is as old as this (s): no spring.
constexpr float kRigidContactAge = 1.0e4f;

// A structure is solved directly if a factorisation takes no more multiplications than this for each row.
constexpr std::uint64_t kMaxStructureWorkPerRow = 2500;

// After the first sweep of a step: brings the structure to rest if its contacts can do that; and again after the last if the
// first could. What still settles is brought to rest after the last alone: the impulses that stop it are not those that hold it, and
// what follows in the step would begin with them.
void solve_structure_first(RestingStructure& structure, const StructureSolve& solve);
void solve_structure_last(RestingStructure& structure, const StructureSolve& solve);

}  // namespace gyre
