// Speculative contacts: pairs that are apart as a step begins and may meet within it.
//
// A manifold is found once a step. Bodies that pass an edge, or strike off their centres, have other nearest features by the time that they
// meet, and the plane of the first ones would stop bodies that never touch. Two convex shapes stay apart as long as they keep any plane
// between them. So nothing is done until the solver would push along the first plane. Then the shapes are swept over the half-step; slow
// pairs that do not bounce are found at its end instead. If they do not meet, they are not pushed. If they do, the manifold is found anew
// at the time of impact.
//
// In: contacts without load, poses and velocities in the step. Out: manifolds at the time of impact, as if they had been found as the step
// began: separations are the present ones, less the motion since then.
#pragma once

#include "rigid/solve/contact_solve.h"

namespace gyre {

// True if the features of the contact may be found anew within the step: it bears no load and is apart.
bool is_speculative(const RigidWorld& w, const Contact& contact);

// True for a contact that is farther ahead than any but a speculative one counts: its nearest features are not those that will meet.
bool is_far_ahead(const RigidWorld& w, const Contact& contact);

// Finds the manifold of a speculative contact where its shapes meet within the half-step; false if they do not meet.
bool find_meeting(const ContactSolve& s, std::uint32_t constraint);

}  // namespace gyre
