// Steps cut by their error, for bodies that contacts or joints act on: a step is solved with n sub-steps and, from the same state, with
// 2 n; how far the ends are apart is the error of the latter, since the solver is of first order (L. F. Richardson). Until that is
// within the tolerance n doubles. Who moves freely tells its own error (rigid/integrate/smooth_motion.h).
//
// Blows are where this ends: one that falls into another sub-step leaves other velocities, and more sub-steps do not make that less than
// what the bodies move in one. Such a step has as many as there may be, and its report says what error is left.
#pragma once

#include "rigid/time/toi_stepping.h"

namespace gyre {

// Sub-steps that a step is cut into for the sake of its error, at most.
constexpr std::int32_t kMaxPlanned = 64;

// Whether a contact or joint acted on any awake body in the step that was solved last.
bool is_anything_constrained(const RigidWorld& w);
// m: how far the ends of the step of `seconds` are from those of the same step in `other`, places and what velocities make of
// themselves in as much time again; the largest of all bodies that constraints act on.
double step_difference(const RigidWorld& w, std::span<const BodyMotion> other, float seconds);

}  // namespace gyre
