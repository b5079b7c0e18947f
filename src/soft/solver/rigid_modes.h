// Rigid modes keep the momentum of a body that nothing holds.
#pragma once

#include "soft/body/soft_body.h"
#include "soft/kernels/soft_kernels.h"

namespace gyre {

// Adds to the changes of velocity the rigid motion with which they have the linear and the angular momentum, about the centre of mass, of the
// impulses from outside, and of `moment` (N m s). Arms are those `ahead` seconds later, at the velocities with these changes.
void keep_momentum(const Particles& particles, const VectorRows& impulses, const VectorRows& change,
                   double ahead = 0.0, DVec3 moment = {});
// The same for the linear momentum of particles and of what they carry, by a translation.
void keep_linear_momentum(const Particles& particles, std::span<const CarriedInertia> carried,
                          const VectorRows& impulses, const VectorRows& change);

}  // namespace gyre
