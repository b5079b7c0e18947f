// The viscosity of a gas: du/dt = nu laplace u on the faces, by the stabilised explicit scheme RKL2, which is of second order and stable for
// any step: s stages take a step (s^2 + s - 2) / 4 times as long as one explicit stage could (C. Meyer, D. Balsara, T. Aslam, "A Stabilized
// Runge-Kutta-Legendre Method for Explicit Super-Time-Stepping of Parabolic and Mixed Equations", 2014).
//
// All other changes of the step are a constant rate beside it. So a flow in which everything balances stays as it is, however large nu is.
//
// Walls that hold the gas (no_slip) have their velocity half a cell beyond the faces next to them; along the others the gas slips.
#pragma once

#include "fluid/solver/gas_pass.h"

namespace gyre {

// Stages for a step.
int count_viscous_stages(const GasBox& box, float kinematic_viscosity, float step);
// Remembers the velocity at the beginning of the step.
void save_velocity(const GasPass& pass);
// From that, with the changes that have led to the velocity as it is, to the velocity at the end.
void add_viscosity(const GasPass& pass, float kinematic_viscosity);

}  // namespace gyre
