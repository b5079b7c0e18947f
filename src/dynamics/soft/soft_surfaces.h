// Contacts of cloths and solids with themselves, each other and bodies within the sub-steps: gathers their surfaces and vertices for
// soft/contact/surface_contacts.h and soft/solver/coupled_solve.h, gives both sides the impulses, and takes back the moves that would cross.
//
// In: members of a batch, rows of contacts. Out: velocities and positions of their particles, velocities of bodies, impulses.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/surface_contacts.h"
#include "soft/store/soft_store.h"

#include <gyre/math.h>

#include <memory>
#include <vector>

namespace gyre {

struct SoftSolve;

struct SoftSurfaces {
  bool active = false;        // there are surfaces that may touch
  bool has_contacts = false;  // contacts of cloths or solids with shapes
  Array<PlacedSurface> placed;
  // Those of the placed surfaces, so that no other is taken for one of them by its address.
  std::vector<std::shared_ptr<const SoftSurface>> surfaces;
  Array<std::uint32_t> member;    // of each placed surface: its index in SoftSolve::members
  Array<std::int32_t> placed_of;  // by member; -1: it has no surface
  Array<std::uint32_t> others;    // members without such a surface that touch shapes
  Array<std::uint32_t> other_first;
  Array<std::uint8_t>
      near;  // by member: 1 if its surface may touch another one in the step, or pieces of its own
  // By vertex of a surface; positions are those at the start of the sub-step.
  Array<DVec3> positions, targets;
  // By vertex, those of the others behind.
  Array<Vec3> velocities;
  Array<float> inverse_mass;
  Array<Sym3> blocks;          // 1/kg: how a vertex answers an impulse, its neighbours held still
  Array<std::uint32_t> stiff;  // the stiff piece it is of, or kNoStiffPiece
  SurfaceContacts contacts;
  BoundReport report;
  // True if pairs close however often they are solved, as between vertices that are held: their impulses are not remembered, which would grow without bound.
  bool unmet = false;
  // True if surfaces may cross now: they are not where the last sub-step left them, or crossed then, or were held where they cross, or are so far that rounding may do it.
  bool may_cross = true;
  Array<DVec3> left;  // by vertex: where the last step left them
  Arena arena;        // used within a stage
};

// Lists the surfaces of a step. Those that are not as the last step left them are searched for crossings in its first sub-step.
void begin_soft_surfaces(SoftSolve& s);
// Notes where the step leaves them.
void end_soft_surfaces(SoftSolve& s);
// Adds the impulses of the last sub-step to the forces from outside.
void add_forces_of_surfaces(SoftSolve& s, std::uint32_t member);

// Pairs of an edge and a triangle that cross now, of all cloths and solids: exact, and 0 unless they began crossed or were held so. Not for
// every step: it looks at all of them.
long count_soft_crossings(const SoftStore& store, Arena& arena);

// Stages, each of one block.
void solve_soft_contacts(SoftSolve& s, int begin, int end);
void bound_soft_surfaces(SoftSolve& s, int begin, int end);

}  // namespace gyre
