// Contacts of soft surfaces with themselves and each other, in one half step: finds the pairs that may touch, solves impulses that stop them from
// closing, with Coulomb friction, and moves the vertices without a crossing.
//
// A pair with weights w (soft/contact/surface_pairs.h) is one contact: its relative velocity is u = sum w_i v_i, and an impulse p on it gives
// particle i the change of velocity w_i W_i p, with W_i its inverse mass. Rows are solved by projected Gauss-Seidel in the order of
// their keys, forward and backward in turn:
//
//   normal     u.n >= -gap / h while the gap is positive, else u.n >= 0;  impulse >= 0
//   friction   u_t = 0 within the disc of radius mu times the normal impulse
//   pushout    the same rows over displacements remove a share of the overlap, without momentum
//
// The impulse of a pair, equal and opposite on its two closest points, keeps linear momentum exactly, and angular momentum up to the friction times the
// gap. No impulse adds kinetic energy: contacts are inelastic.
//
// W_i is the bare inverse mass, not the inverse of the block of the implicit system: the latter answers one impulse on one particle, and a sheet
// that lands flat, whose springs then do not resist, would be thrown back by the ratio of both (docs/decisions/soft-contact.md).
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/displacement_bounds.h"
#include "soft/contact/soft_surface.h"
#include "soft/contact/surface_pairs.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

// Vertices of all surfaces, in the numbers of PlacedSurface.
struct SurfaceVertices {
  std::span<DVec3> positions;
  std::span<const Vec3> velocities;
  std::span<const float> inverse_mass;  // 1/kg, 0: held, it goes where it is told
};

struct SurfaceContactSettings {
  float step = 0.0f;  // s: of the half step
  int iterations = 4;
  float pushout = 0.25f;  // share of the overlap removed in a half step
  int most_rounds = 4;    // of finding pairs, for vertices that move further than they were looked for
  BoundSettings bounds{};
};

struct SurfaceImpulse {
  float normal = 0.0f;  // N s
  Vec3 friction{};
};

// What persists between half steps; may be dropped between any two.
struct SurfaceContacts {
  Array<SurfacePair> pairs;
  Array<SurfaceImpulse> impulses;  // by pair
  Array<float> limits;             // m, by vertex: how far it may move before pairs are found again
  Array<Vec3> pushes;              // m, by vertex
  Array<Vec3> given;               // N s, by vertex: what is to be given to it now
  int rounds = 0;                  // of finding pairs, in the last half step
  int touching = 0;                // pairs with an impulse
};

// Finds pairs for a half step at these velocities; pairs that were there keep their impulses.
void find_surface_contacts(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                           const SurfaceContactSettings& settings, Arena& arena, SurfaceContacts& contacts);
// Sets what the impulses that were kept from the last half step give to each vertex.
void start_surface_contacts(const SurfaceVertices& vertices, SurfaceContacts& contacts);
// Solves the rows at the present velocities, with all impulses so far given. Sets what the changes of the impulses give to each vertex.
void solve_surface_contacts(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                            Arena& arena, SurfaceContacts& contacts);
// Sets the pushes.
void push_surfaces(const SurfaceVertices& vertices, const SurfaceContactSettings& settings, Arena& arena,
                   SurfaceContacts& contacts);
// Moves the vertices to their targets and by their pushes, as far as the bounds let them. Vertices without inverse mass get to their targets.
BoundReport move_surfaces(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                          std::span<const DVec3> targets, const SurfaceContactSettings& settings,
                          Arena& arena, SurfaceContacts& contacts);

}  // namespace gyre
