// The context of the contact stages (rigid/solve/contact_stages.h): the contacts of a batch in blocks, and the resting islands that are
// solved directly.
#pragma once

#include "rigid/rest/resting_structures.h"
#include "rigid/rest/resting_trees.h"
#include "rigid/solve/contact_lists.h"
#include "rigid/solve/held_bodies.h"
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
  void *blocks = nullptr, *cold_blocks = nullptr;  // blocks of contacts
  RollingContacts rolling{};
  std::span<std::uint16_t>
      rolling_lanes{};  // by block of contacts: bits of contacts whose points are yet to be advanced
  std::span<std::uint32_t> rolling_indices{};  // by lane: index of its rolling contact
  bool has_speculative = false;                // among the contacts
  RecycleContacts update_views = nullptr;      // for manifolds that are found within the step
  RestingTrees forest{};
  TreeSolve tree_solve{};
  std::span<RestingStructure> structures{};
  StructureSolve structure_solve{};
  HeldBodies held{};
};

// A range of contact blocks of one colour.
struct ContactGroup {
  const ContactSolve* solve = nullptr;
  std::uint32_t first = 0, count = 0;  // blocks
  bool serial = false;                 // the overflow group, whose members share bodies
  const int* bounds = nullptr;         // bounds of each worker's share: Stage::bounds
  bool held = false;                   // contacts of held bodies
};

}  // namespace gyre
