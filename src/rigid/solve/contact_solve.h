// What the stages of contacts (rigid/solve/contact_stages.h) work on: the contacts of a batch as the kernels want them, and the islands
// at rest that are solved directly.
#pragma once

#include "rigid/rest/resting_structures.h"
#include "rigid/rest/resting_trees.h"
#include "rigid/solve/contact_lists.h"
#include "rigid/solve/rolling_contacts.h"
#include "solver/kernels/solver_kernels.h"

namespace gyre {

struct ContactSolve {
  RigidWorld& w;
  ContactLists& lists;
  const SolverKernels& kernels;
  ContactSettings settings{};
  ImpactSettings impact_settings{};
  ContactBodies bodies{};
  void *blocks = nullptr, *cold_blocks = nullptr;  // of contacts
  RollingContacts rolling{};
  std::span<std::uint16_t>
      rolling_lanes{};  // by block of contacts: bits of those whose points are still to be advanced
  std::span<std::uint32_t> rolling_indices{};  // by lane: which of those that roll it is
  RestingTrees forest{};
  TreeSolve tree_solve{};
  std::span<RestingStructure> structures{};
  StructureSolve structure_solve{};
};

// Blocks of contacts of one colour.
struct ContactGroup {
  const ContactSolve* solve = nullptr;
  std::uint32_t first = 0, count = 0;  // blocks
  bool serial = false;          // what is left over when the colours are used up: its members share bodies
  const int* bounds = nullptr;  // of each worker's share: Stage::bounds
};

}  // namespace gyre
