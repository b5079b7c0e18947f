// The stages of contacts. Each works on blocks [begin, end) of its kind; blocks of a ContactGroup count from the start of the group.
//
// In: contacts, laid out in colours (rigid/solve/contact_solve.h). Out: velocities of bodies; at the end, impulses in manifolds.
#pragma once

#include "rigid/solve/contact_solve.h"

namespace gyre {

// Both run once in a step: the first computes effective masses and reads the impulses of the last step, the second writes impulses back.
void prepare_contacts(const ContactSolve& s, int begin, int end);
void finish_contacts(const ContactSolve& s, int begin, int end);

void warm_start_contacts(const ContactGroup& group, int begin, int end);
// Solves soft contacts without restitution. Points of rolling contacts advance first; speculative contacts come last.
void solve_contacts(const ContactGroup& group, int begin, int end);
// Another iteration in the same half-step.
void solve_contacts_again(const ContactGroup& group, int begin, int end);
// Solves without springs, so that no velocity from them stays under load.
void relax_contacts(const ContactGroup& group, int begin, int end);
// Removes penetration by pushout. Motion records hold displacements instead of velocities.
void project_contacts(const ContactGroup& group, int begin, int end);

// Restitution, in one block. The first stage records velocities before the forces. The second applies bounces of points that meet within
// the sub-step.
void record_contact_approach(const ContactSolve& s, int begin, int end);
void apply_contact_restitution(const ContactSolve& s, int begin, int end);

// Solves resting trees; each is a block.
void solve_resting_trees(const ContactSolve& s, int begin, int end);
// Solve resting structures one after the other, because they share the step's arena. No other stage uses it meanwhile.
void solve_resting_structures_first(const ContactSolve& s, int begin, int end);
void solve_resting_structures_last(const ContactSolve& s, int begin, int end);

}  // namespace gyre
