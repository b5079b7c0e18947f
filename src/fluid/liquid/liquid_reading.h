// Readings of a liquid.
#pragma once

#include "fluid/grid/fluid_frame.h"
#include "fluid/liquid/liquid_grid.h"

namespace gyre {

// m^3: cells within the surface are full, however many particles they have; those at it, and those of drops and films too thin to be
// liquid cells, count as full as the distance from the surface says.
// `solids` are those of the window, null: of all of the box; outside it there is no liquid.
double liquid_volume(const LiquidGrid& grid, const GasSolids& solids, const FluidWindow* window = nullptr);

struct LiquidTotals {
  double mass = 0.0;              // kg
  double kinetic_energy = 0.0;    // J
  double potential_energy = 0.0;  // J, -m g x, x from the origin of the world
  DVec3 momentum{};               // kg m/s
  DVec3 angular_momentum{};       // kg m^2/s, about the origin of the world
};
// Relative to the box and in its axes without a frame.
LiquidTotals liquid_totals(const LiquidGrid& grid, float density, Vec3 gravity,
                           const FluidFrame* frame = nullptr);

struct LiquidProbe {
  Vec3 velocity{};
  float pressure = 0.0f;  // Pa, relative to the open surface; 0 outside
  bool inside = false;
  bool has_surface = false;  // in the column of the point
  double surface = 0.0;      // m, height in the axes of the box of the highest surface in the column
};
// At a point in the axes of the box.
LiquidProbe probe_liquid(const LiquidGrid& grid, DVec3 point, float density);

}  // namespace gyre
