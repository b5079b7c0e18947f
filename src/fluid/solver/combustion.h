// Combustion: fuel in a gas becomes heat.
//
// In: fuel, temperature and smoke of the cells. Out: the same after a sub-step, and the mass of the fuel that burned. One reaction of first
// order above a temperature of ignition (T. Poinsot, D. Veynante, "Theoretical and Numerical Combustion", 2005, with an infinite
// activation energy): dF/dt = -k F, dT/dt = k F q / (rho c), solved exactly within the sub-step.
#pragma once

#include "fluid/solver/gas_pass.h"

namespace gyre {

// kg of fuel that burned.
double burn_fuel(const GasPass& pass, const Combustion& combustion, float gas_density);

}  // namespace gyre
