// Readings of a gas.
#pragma once

#include "fluid/grid/gas_grid.h"
#include "fluid/grid/gas_solids.h"
#include "task/task_system.h"

namespace gyre {

// 1/2 density u^2 of the gas outside solids, each face with the cells beside it: J.
double gas_kinetic_energy(const GasGrid& grid, const GasSolids& solids, float density, TaskSystem& tasks);
// The integral of the density of smoke outside solids: kg.
double smoke_mass(const GasGrid& grid, const GasSolids& solids, TaskSystem& tasks);
// The same of any field in kg/m^3.
double field_mass(const GasGrid& grid, const Array<float>& field, const GasSolids& solids, TaskSystem& tasks);

// m/s at a point of the world, between faces linearly.
Vec3 gas_velocity(const GasGrid& grid, DVec3 point);

struct GasProbe {
  Vec3 velocity{};           // m/s, between faces linearly
  float pressure = 0.0f;     // Pa, relative to the air outside at that height, or to the mean of a closed box
  float density = 0.0f;      // kg/m^3, of smoke
  float temperature = 0.0f;  // K
  float fuel = 0.0f;         // kg/m^3
};
// At a point of the world. `density`: of the gas, `gravity`: its weight adds to the pressure in a closed box.
GasProbe probe_gas(const GasGrid& grid, DVec3 point, float density, Vec3 gravity);

}  // namespace gyre
