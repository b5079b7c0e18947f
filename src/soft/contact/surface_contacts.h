// Contacts of soft surfaces with themselves and each other, in one sub-step: finds the pairs that may touch, solves impulses that stop them from
// closing, with Coulomb friction, and moves the vertices without a crossing.
//
// A pair with weights w (soft/contact/surface_pairs.h) is one contact: its relative velocity is u = sum w_i v_i, and an impulse p on it gives
// particle i the change of velocity w_i W_i p, with W_i its inverse mass. Rows are solved by projected Gauss-Seidel in the order of
// their keys, forward and backward in turn:
//
//   normal     u.n >= -gap / h while the gap is positive, else u.n >= 0;  impulse >= 0
//   friction   u_t = 0 within the disc of radius mu times the normal impulse
//   pushout    the same rows over displacements remove a share of the overlap, without momentum
//   untangling u.n >= a speed along the way out, of an edge that passes through a triangle: five vertices (soft/contact/surface_tangle.h). Pairs that
//              would hold the surfaces on the wrong sides have no rows and no bounds meanwhile
//
// The impulse of a pair, equal and opposite on its two closest points, keeps linear momentum exactly, and angular momentum up to the friction times the
// gap. No impulse adds kinetic energy, but for untangling: contacts are inelastic.
//
// The bodies answer impulses through their stiffness, with A^-1, A = M + s K (soft/solver/implicit_step.h). In the rows a solid answers by its rigid motion, and each of its vertices
// by the inverse of its own block of A beside that: exact for a stiff solid and for a very soft one. A vertex of a cloth answers by its bare inverse mass. Of what the rows find, the share is
// taken that is best with the true answer of the bodies, so that each round lowers the energy of the coupled system (docs/decisions/soft-contact.md).
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/body/rigid_response.h"
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
  // How a vertex answers an impulse beside what its body does as a whole, 1/kg. None: by the inverse mass.
  std::span<const float> own_response{};
  std::span<const RigidResponse> bodies{};   // none: no body answers as a whole
  std::span<const std::uint32_t> body_of{};  // by vertex

  float own(std::uint32_t v) const { return own_response.empty() ? inverse_mass[v] : own_response[v]; }
};

struct SurfaceContactSettings {
  float step = 0.0f;        // s: of the sub-step
  int iterations = 16;      // sweeps over the rows
  int push_iterations = 4;  // and over those of the pushout
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

constexpr float kAnyShare = 1.0e30f;  // of a change, as a bound that none reaches

// State between sub-steps; it may be cleared between any two.
struct SurfaceContacts {
  Array<SurfacePair> pairs;
  Array<SurfaceImpulse> impulses;  // by pair
  // N s, by vertex: the impulses of all pairs together; those of the last sub-step act as forces in the next, so that the stiffness of the
  // body spreads them exactly. And the part of them that the velocities do not have yet.
  Array<Vec3> totals, owed;
  PairSearch search;
  double aimed =
      0.0;  // J: the work of the change of the impulses in the last solve at the velocities that the rows want
  float most_share = 0.0f;  // of this change, by which no impulse that untangles is more than it may be
  SurfaceTangle tangle;     // when the sub-step began
  Array<DVec3> plan;        // m, by vertex: the moves for which pairs were found, against the mean of all
  Array<float> limits;      // m, by vertex: how far it may end from its plan, or pairs are found again
  Array<Vec3> pushes;       // m, by vertex
  int rounds = 0;           // of finding pairs, in the last sub-step
  int touching = 0;         // pairs with an impulse

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
// Solves the rows at the present velocities, when nothing is owed; then all changes are owed. The caller finds what the bodies answer, each through its stiffness, takes the best share of
// it, and may call this again at the velocities that this makes.
void solve_surface_contacts(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                            Arena& arena, SurfaceContacts& contacts);
// By how much pairs would come into each other in the step at the present velocities, at most, as a share of their thickness.
float worst_closing(const SurfaceVertices& vertices, const SurfaceContactSettings& settings,
                    const SurfaceContacts& contacts);
// How much of the last change of the impulses, since `before`, is best: an exact line search of the dual, whose slope is `aimed` less the work of the change at the velocities before, and whose
// curvature is its work on the `change` of the velocities that it makes. No impulse leaves its bounds, and the share is at most `most_share`. The change of the impulses is then taken by this share.
float take_best_share(std::span<const SurfaceImpulse> before, const SurfaceVertices& vertices,
                      std::span<const Vec3> change, float most_share, SurfaceContacts& contacts);
// Sets the pushes.
void push_surfaces(const SurfaceVertices& vertices, const SurfaceContactSettings& settings, Arena& arena,
                   SurfaceContacts& contacts);
// Moves the vertices to their targets and by their pushes, as far as the bounds let them. Vertices without inverse mass get to their targets.
BoundReport move_surfaces(std::span<const PlacedSurface> surfaces, const SurfaceVertices& vertices,
                          std::span<const DVec3> targets, const SurfaceContactSettings& settings,
                          Arena& arena, TaskSystem& tasks, SurfaceContacts& contacts);

}  // namespace gyre
