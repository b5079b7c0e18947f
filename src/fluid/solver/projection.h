// Makes the velocity of a gas free of divergence, solids' motion counted, and gives the pressure that does it.
//
// The pressure of the step before is in the velocity already when this begins, half of it where the gas came from and half where it arrives
// (add_pressure); here only its change is found. So the error in time is of second order, and a flow that hardly changes needs few iterations
// (J. van Kan, "A Second-Order Accurate Pressure-Correction Scheme for Viscous Incompressible Flow", 1986).
#pragma once

#include "fluid/solver/gas_pass.h"
#include "fluid/solver/pressure_solve.h"

#include <span>

namespace gyre {

// Velocity -= step times `share` of the gradient of the pressure as it is. `over_walls`: also at walls, where it then is as at the next face
// inside: the field that moves must not jump there.
void add_pressure(const GasPass& pass, float share, bool over_walls);

// Faces of walls and of closed solids get their velocity.
void set_walls(const GasPass& pass);

// The motions of bodies at the beginning of a step, and the faces that they cut.
void begin_bodies(const GasPass& pass);

struct ProjectionSettings {
  float divergence = 1.0e-4f;  // 1: largest net outflow of a cell within the step, over its volume
  float reduction = 1.0e-2f;   // and over the largest before
  int max_iterations = 60;
};
PressureReport project_velocity(const GasPass& pass, const ProjectionSettings& settings);

// The largest net outflow of a cell over its volume, 1/s.
float largest_divergence(const GasPass& pass);

// Adds to each label what the pressure does to its solid in the step. `density`: of the gas, kg/m^3.
void add_impulses(const GasPass& pass, float density, std::span<GasImpulse> impulses);

}  // namespace gyre
