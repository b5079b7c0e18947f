// Error-controlled steps, for bodies that contacts or joints act on. A step is solved with n sub-steps and, from the
// same state, with 2 n. The solver is of first order, so the difference of the two results is the error of the second
// (L. F. Richardson). n doubles until the error is within the tolerance. Free bodies have an error estimate of their
// own (rigid/integrate/smooth_motion.h).
//
// Impacts limit the method. An impact in another sub-step leads to other velocities, and more sub-steps do not reduce
// that below the motion of one sub-step. Such a step uses the largest number of sub-steps, and its report states the
// remaining error.
#pragma once

#include "rigid/time/toi_stepping.h"

namespace gyre {

// The largest number of sub-steps that error control uses.
constexpr std::int32_t kMaxPlanned = 64;

// True if a contact or joint acted on an awake body in the last solve.
bool is_anything_constrained(const RigidWorld& w);
// The difference of two results of a step of `seconds`, m: that of the poses, plus that of the velocities times
// `seconds`. The largest over all constrained bodies.
double step_difference(const RigidWorld& w, std::span<const BodyMotion> other, float seconds);

}  // namespace gyre
