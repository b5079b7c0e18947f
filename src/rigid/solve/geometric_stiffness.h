// Bodies that swept joints pull at more than a sub-step resolves: knots of loaded nets that are light for their arms.
//
// Forces at their arms hold them back like springs as they turn; springs that a sub-step does not resolve, h^2 k > I, make them flutter
// ever more, until the net is torn apart. So their inertia is raised towards h^2 k for the step, as if the turning of forces were
// implicit (M. Tournier, M. Nesme, B. Gilles, F. Faure, "Stable Constrained Dynamics", 2015; S. Andrews, M. Teichmann, P. Kry, "Geometric
// Stiffness for Real-Time Constrained Multibody Dynamics", 2017). What nothing pulls like that stays as it is, to the bit.
// Linkages do the same with theirs (solver/articulation/articulation.cpp), axis by axis.
#pragma once

#include "rigid/solve/solve.h"

namespace gyre {

// Of the batch's swept ball joints, by the impulses that they begin with.
std::span<const StiffenedBody> find_stiffened_bodies(const BatchContext& solve, Arena& arena);

// Of the bodies that will be moved these get no gyroscopic torque: joints take it back with an inertia that it knows nothing of, many times
// over.
void disable_gyroscopic_torque(const BatchContext& solve, Arena& arena);
// Raises their inertia, as they are turned now: before joints and contacts read it, and again whenever they have turned.
void stiffen_bodies(const BatchContext& solve);
// Gives it back, after the last part of the step.
void restore_inertia(const BatchContext& solve);

}  // namespace gyre
