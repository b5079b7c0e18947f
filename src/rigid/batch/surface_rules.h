// Applies the world's table of surface rules to a contact: surface velocities of belts, one-way platforms, and materials of mesh triangles.
//
// In: a contact's manifold before the solve. Out: its changed constraint, or false if the two bodies pass through each other. Worlds with
// an empty table skip this unit.
#pragma once

#include "rigid/store/rigid_world.h"
#include "solver/contact/contact_block.h"

namespace gyre {

// Changes friction, restitution and surface velocity of the manifold's constraint by the rules of the two surfaces. False: the two bodies
// pass through each other, and the manifold's impulses are cleared.
//
// A one-way surface stops a body that moves against its direction, with a normal within 60 degrees of it. A body is passing through if it
// is deeper than half its size, or if it overlaps and moves along the direction. No history is stored: a body that turns back half-way
// falls back, and one that is nearly through is lifted out.
bool apply_surface_rules(const RigidWorld& w, const Contact& contact, Manifold& manifold,
                         ContactConstraint& constraint);

// True if the whole shape lets bodies pass that move along `way` (world axes) against it. CCD uses this.
bool lets_pass(const RigidWorld& w, std::uint32_t shape, Vec3 way);

// The number, as the user gave it, of the triangle nearest to a contact point; -1 if neither shape has triangles.
std::int32_t triangle_at(const RigidWorld& w, const Contact& contact, DVec3 place);

}  // namespace gyre
