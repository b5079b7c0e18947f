// Rigid modes of the pieces of a body that nothing holds: they keep its momentum and turn it along arcs. A solid that is broken has several pieces.
#pragma once

#include "soft/body/soft_body.h"
#include "soft/kernels/soft_kernels.h"

#include <span>

namespace gyre {

// Adds to the changes of velocity the rigid motion of each piece with which they have the linear and the angular momentum, about its centre of mass, of the
// impulses from outside, and of `moments` (N m s). Arms are those `ahead` seconds later, at the velocities with these changes.
void keep_momentum(const SoftBody& body, const VectorRows& impulses, const VectorRows& change,
                   double ahead = 0.0, const ByPiece<DVec3>& moments = ByPiece<DVec3>());
// The same for the linear momentum of particles and of what they carry, by a translation.
void keep_linear_momentum(const Particles& particles, std::span<const CarriedInertia> carried,
                          const VectorRows& impulses, const VectorRows& change);

// The motion of all particles of a piece together, as a rigid body has it.
struct RigidMotion {
  DVec3 center{};    // m
  DVec3 velocity{};  // m/s, of the centre of mass
  DVec3 momentum{};  // N m s, angular, about the centre of mass
  DVec3 spin{};      // rad/s, which has this momentum
  DVec3 turn{};      // rad, in the time to come: by the spin that the momentum gives in the middle of it
};
ByPiece<RigidMotion> rigid_motions(const SoftBody& body, double seconds = 0.0);
// Adds the forces of inertia in the frame that turns with a piece: the centrifugal force, and Euler's force of a free rotation. Their sum and their moment are zero.
void add_turning_forces(SoftBody& body);
// Particles have moved along their tangents, with these motions. They go on to where the motions turn them in `seconds`, along arcs about the centre of mass of their piece, and their
// velocities turn too. The linear and the angular momentum stay.
void turn_along_arcs(SoftBody& body, const ByPiece<RigidMotion>& motions, double seconds);

}  // namespace gyre
