// Static equilibrium of resting structures with loops: card houses, towers of planks, pyramids, arches of dry
// stones.
//
// Such a structure is statically indeterminate: many sets of impulses would hold it. By the safe theorem (J.
// Heyman, "The Stone Skeleton", 1966, after the lower bound theorem of plasticity) it stands if one set has
// no tension and stays within all friction limits. The solver searches for one. Contacts are springs with
// unique loads, K z = load, with K = J^T D J factored directly. Points with tensile force leave the active
// set; points in compression enter it again. A contact beyond its friction limit is softened sideways (its
// secant stiffness falls), until nothing changes. The result is exact: it carries all loads, for any height
// and mass ratio. If there is none after a few rounds, something is about to slide, tip or fall, and the
// result of the iterations stands.
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
  float rest_speed = 0.0f;  // m/s, rad/s: slower bodies count as at rest
  float rest_spin = 0.0f;
  Sym3 inertia;  // world axes, at the beginning of the step
};

constexpr std::uint32_t kNoNode = 0xffffffffu;

struct StructureContact {
  std::uint32_t constraint = 0;
  std::uint32_t block = 0, lane = 0;                 // position in the kernels' blocks
  std::uint32_t node_a = kNoNode, node_b = kNoNode;  // kNoNode: the static world
  BlockLocation coupling;  // the block of the two in the matrix, `a` first; valid during a solve

  bool is_between() const { return node_a != kNoNode && node_b != kNoNode; }
};

// Scratch data of a contact, valid from the first solve of a step to its last.
struct StructureScratch {
  ContactImpulse before, impulse;         // as found, and proposed
  float shear = 0.0f;                     // tangential over normal stiffness
  std::uint8_t touching = 0, loaded = 0;  // bits, by point: may carry load, and carries it
  double at[kMaxManifoldPoints] = {},
         rate[kMaxManifoldPoints] = {};  // compression, and its rate along the direction
};

// All memory is from the arena.
struct RestingStructure {
  std::span<const StructureNode> nodes;
  std::span<StructureContact> contacts;
  std::span<StructureScratch> work;
  bool is_settling = false;  // it still moved at the beginning of the step
  bool was_rigid = false;    // it was solved in the last step
  bool is_new = false;       // its contacts had no load in the last step
  bool has_scratch = false;  // `work` is that of this step
  bool is_solved = false;    // in the first solve of the step
};

struct StructureSolve {
  std::span<const ContactConstraint> constraints;
  BodyMotion* motion = nullptr;
  const ContactKernels* kernels = nullptr;
  void* blocks = nullptr;
  Arena* arena = nullptr;  // scratch memory of one structure after the other
};

// s: age of manifolds in a structure that is solved directly; their contacts are rigid.
constexpr float kRigidContactAge = 1.0e4f;

// Largest number of multiplications of a factorisation, per row, for a direct solution.
constexpr std::uint64_t kMaxStructureWorkPerRow = 2500;

// Stops the structure after the first iteration of a step if its contacts can do that, and then again after
// the last. A settling structure is stopped after the last only: the impulses that stop it are not those that
// hold it, and the rest of the step would start from them.
void solve_structure_first(RestingStructure& structure, const StructureSolve& solve);
void solve_structure_last(RestingStructure& structure, const StructureSolve& solve);

}  // namespace gyre
