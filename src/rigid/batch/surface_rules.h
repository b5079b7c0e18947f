// What the world's table of surface rules makes of a contact: belts that run, platforms that hold from one side only,
// triangles of a mesh with materials of their own.
//
// In: a contact's manifold, before it is solved. Out: its constraint changed, or word that the two pass through each other.
// Nothing here is asked in worlds whose table is empty.
#pragma once

#include "rigid/store/rigid_world.h"
#include "solver/contact/contact_block.h"

namespace gyre {

// Changes friction, restitution and surface velocity of the manifold's constraint as the rules of the two surfaces say. False:
// the two pass through each other here; the manifold's impulses are gone then.
//
// A one-way surface holds what comes against its direction with a normal within 60 degrees of it. What lies deeper than half of
// its own size, or overlaps and moves along the direction, is on its way through. No memory of the way is kept: a body that
// turns round half-way falls back, one that is nearly through is lifted out.
bool apply_surface_rules(const RigidWorld& w, const Contact& contact, Manifold& manifold,
                         ContactConstraint& constraint);

// Whether a shape as a whole lets pass what moves along `way` (world axes) against it: for sweeps of fast bodies.
bool lets_pass(const RigidWorld& w, std::uint32_t shape, Vec3 way);

// The number, as the user gave it, of the triangle that lies nearest to a contact's point; -1 if neither shape has triangles.
std::int32_t triangle_at(const RigidWorld& w, const Contact& contact, DVec3 place);

}  // namespace gyre
