// Contacts of soft surfaces with themselves and each other, in one sub-step: finds the pairs that may touch, makes rows that stop them from
// closing, with Coulomb friction, and moves the vertices without a crossing.
//
// A pair with weights w (soft/contact/surface_pairs.h) is one row: its relative velocity is u = sum w_i v_i, and an impulse p on it gives
// particle i the impulse w_i p. The rows of all pairs are solved together with the stiffness of the bodies (soft/solver/coupled_solve.h):
//
//   normal     u.n >= -gap / h while the gap is positive, else u.n >= 0;  impulse >= 0
//   friction   u_t = 0 within the disc of radius mu times the normal impulse
//   pushout    the same rows over displacements remove a share of the overlap, without momentum, with the bare masses of vertices
//   untangling u.n >= a speed along the way out, of an edge that passes through a triangle: five vertices (soft/contact/surface_tangle.h). Pairs that
//              would hold the surfaces on the wrong sides have no rows and no bounds meanwhile
//
// The impulse of a pair, equal and opposite on its two closest points, keeps linear momentum exactly, and angular momentum up to the friction times the
// gap. No impulse adds kinetic energy, but for untangling: contacts are inelastic.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/coupling_row.h"
#include "soft/contact/displacement_bounds.h"
#include "soft/contact/soft_surface.h"
#include "soft/contact/surface_pairs.h"
#include "soft/contact/surface_tangle.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

// Vertices of all surfaces, in the numbers of PlacedSurface.
struct SurfaceVertices {
  std::span<DVec3> positions;
  std::span<const Vec3> velocities;
  std::span<const float> inverse_mass;  // 1/kg, 0: held, it goes where it is told
  std::span<const Sym3> blocks{};       // 1/kg: how a vertex answers an impulse, its neighbours held still
  // The piece of a solid that is rigid within a sub-step, or kNoStiffPiece; none: there are no such pieces. Its moves are cut as a whole, and it does not meet itself.
  std::span<const std::uint32_t> stiff{};
};

struct SurfaceContactSettings {
  float step = 0.0f;        // s: of the sub-step
  float closing = 0.1f;     // share of the thickness by which a pair may close in the step
  int push_iterations = 4;  // sweeps of the pushout
  float pushout = 0.25f;    // share of the overlap removed in a sub-step
  int most_rounds =
      4;  // of finding pairs, for vertices that end farther from their plan than they were looked for
  float gravity = 9.81f;  // m/s^2, by which the speed of untangling goes
  BoundSettings bounds{};
};

struct SurfaceImpulse {
  float normal = 0.0f;  // N s
  Vec3 friction{};
};

// State between sub-steps; it may be cleared between any two.
struct SurfaceContacts {
  Array<SurfacePair> pairs;
  Array<SurfaceImpulse> impulses;  // by pair
  // N s, by vertex: the impulses of all pairs together; those of the last sub-step act as forces in the next, so that the stiffness of the
  // body spreads them exactly. And the part of them that the velocities do not have yet.
  Array<Vec3> totals, owed;
  Array<CouplingRow> rows;         // those of pairs, then those of tangled edges
  Array<std::uint32_t> row_pairs;  // by row: its pair
  PairSearch search;
  SurfaceTangle tangle;  // when the sub-step began
  Array<DVec3> plan;     // m, by vertex: the moves for which pairs were found, against the mean of all
  Array<float> limits;   // m, by vertex: how far it may end from its plan, or pairs are found again
  Array<Vec3> pushes;    // m, by vertex
  int rounds = 0;        // of finding pairs, in the last sub-step
  int touching = 0;      // pairs with an impulse

  void clear(std::size_t vertices) {
    pairs.clear(), impulses.clear();
    totals.assign(vertices, Vec3{}), owed.assign(vertices, Vec3{});
  }
};

// Finds pairs for a sub-step at these velocities, which have the totals of the last. Pairs that were there keep their impulses; what the totals
// change by, since pairs are gone and normals turn, is owed.
void find_surface_contacts(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                           const SurfaceContactSettings& settings, Arena& arena, TaskSystem& tasks,
                           SurfaceContacts& contacts);
// Makes a row for each pair at which forces may act, and for each tangled edge, with what they resist by. solve_coupled()
// (soft/solver/coupled_solve.h) solves them.
void make_coupling_rows(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                        SurfaceContacts& contacts);
// Takes the impulses of the rows after that. Nothing is owed then.
void take_impulses(std::span<const float> inverse_mass, SurfaceContacts& contacts);
// Sets the pushes.
void push_surfaces(const SurfaceVertices& vertices, const SurfaceContactSettings& settings, Arena& arena,
                   SurfaceContacts& contacts);
// Moves the vertices to their targets and by their pushes, as far as the bounds let them. Vertices without inverse mass get to their targets.
BoundReport move_surfaces(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                          std::span<const DVec3> targets, const SurfaceContactSettings& settings,
                          Arena& arena, TaskSystem& tasks, SurfaceContacts& contacts);

}  // namespace gyre
