// The stages of contacts. Each works on blocks [begin, end) of what it names; those of a ContactGroup are the group's.
//
// In: contacts, laid out in colours (rigid/solve/contact_solve.h). Out: velocities of bodies; at the end impulses in manifolds.
#pragma once

#include "rigid/solve/contact_solve.h"

namespace gyre {

// Once: effective masses and the impulses of the last step; and back into the manifolds.
void prepare_contacts(const ContactSolve& s, int begin, int end);
void finish_contacts(const ContactSolve& s, int begin, int end);

void warm_start_contacts(const ContactGroup& group, int begin, int end);
// Soft, with restitution left out. Those that roll advance their points first.
void solve_contacts(const ContactGroup& group, int begin, int end);
// Without their springs: no speed that came from these stays under load.
void relax_contacts(const ContactGroup& group, int begin, int end);
// Pushes overlap apart; motion records hold displacements in the place of velocities.
void project_contacts(const ContactGroup& group, int begin, int end);

// Restitution, in one block: closing speeds before the forces; bounces of what meets within the sub-step; of what had to be set down first.
void record_contact_approach(const ContactSolve& s, int begin, int end);
void apply_contact_restitution(const ContactSolve& s, int begin, int end);
void apply_delayed_contact_restitution(const ContactSolve& s, int begin, int end);

// Islands that rest as trees, a tree a block.
void solve_resting_trees(const ContactSolve& s, int begin, int end);
// Those that rest with loops, one after the other: they share the step's arena, which nobody else uses meanwhile.
void solve_resting_structures_first(const ContactSolve& s, int begin, int end);
void solve_resting_structures_last(const ContactSolve& s, int begin, int end);

}  // namespace gyre
