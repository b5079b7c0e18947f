// Geometric stiffness: raises the inertia of bodies that iterative joints pull too hard for a sub-step, as knots of loaded nets are.
//
// Forces at the arms of a rotating body act like springs. Springs with h^2 k > I, which a sub-step does not resolve, make the body flutter
// ever more until the net tears. Inertia raised towards h^2 k for the step acts like an implicit rotation of the forces (M. Tournier, M.
// Nesme, B. Gilles, F. Faure, "Stable Constrained Dynamics", 2015; S. Andrews, M. Teichmann, P. Kry, "Geometric Stiffness for Real-Time
// Constrained Multibody Dynamics", 2017). Other bodies keep their bits. Articulations raise their inertia axis by axis
// (solver/articulation/articulation.cpp).
#pragma once

#include "rigid/solve/joint_solve.h"
#include "solver/motion/motion_block.h"

namespace gyre {

// Finds the bodies from the first impulses of the batch's iterative ball joints.
std::span<const StiffenedBody> find_stiffened_bodies(const JointSolve& solve, Arena& arena);

// Disables the gyroscopic torque of stiffened bodies among `moved`. Joints would take it back many times over, with another inertia.
void disable_gyroscopic_torque(const JointSolve& solve, std::span<MovedBody> moved, Arena& arena);
// Raises the inertia at the present orientations. It runs before joints and contacts read the inertia, and after each rotation. A stage of
// one block.
void stiffen_bodies(const JointSolve& solve, int begin, int end);
// Restores the inertia after the last half-step.
void restore_inertia(const JointSolve& solve);

}  // namespace gyre
