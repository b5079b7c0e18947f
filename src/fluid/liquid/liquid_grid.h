// LiquidGrid: the state of a liquid in a box of cells: particles that carry it, and the field of their velocities on faces of cells. The box is
// that of gases (fluid/grid/gas_grid.h); at an open side the liquid leaves for good. Everything is in the axes of the box and relative to its
// lower corner.
//
// Each particle has the velocity around it to first order (C. Jiang, C. Schroeder, A. Selle, J. Teran, A. Stomakhin, "The Affine
// Particle-In-Cell Method", 2015). A cell that lies half full or more is liquid.
#pragma once

#include "base/container/array.h"
#include "base/function_ref.h"
#include "fluid/grid/gas_grid.h"
#include "fluid/grid/gas_solids.h"

#include <gyre/math.h>

namespace gyre {

struct FluidWindow;

struct LiquidGrid {
  GasBox box;
  GridShape shape;
  // Particles.
  Array<float> position[3];  // m, from the lower corner of the box
  Array<float> motion[3];    // m/s
  Array<float> affine[9];    // 1/s: affine[3 a + b] is how the velocity along a grows along b
  Array<float> volume;       // m^3
  // Fields, of the last step.
  Array<float> velocity[3];  // m/s, on faces
  Array<float>
      surface;  // m, at centres: distance from the surface, negative within; right up to a cell and no less beyond
  Array<float> pressure;  // m^2/s^2, at centres: over density, relative to the air

  int particles() const { return int(volume.size()); }
};

// A box without liquid. Sides are closed unless `box` says otherwise.
LiquidGrid make_liquid_grid(const GasBox& box);
// The volume of a particle where eight fill a cell, or four if an axis is flat.
float particle_volume(const GasBox& box);

// The part of a box or of a ball, given in the world, that lies in the domain is filled with liquid of this velocity, but for places
// that have liquid already and for those within solids. Particles lie on a lattice that fits the region, so their volumes add up to what
// the region has there. Returns how many were added.
int fill_liquid_box(LiquidGrid& grid, DVec3 lower, DVec3 upper, Vec3 velocity, const GasSolids& solids);
int fill_liquid_ball(LiquidGrid& grid, DVec3 center, float radius, Vec3 velocity, const GasSolids& solids);
// True if a point of the box, from its lower corner, lies in it and outside the solids of a window.
bool has_room(const GasBox& box, const FluidWindow& window, const GasSolids& solids, Vec3 point);
void add_particle(LiquidGrid& grid, Vec3 position, Vec3 velocity, float volume);
// Fields from the particles as they are, for probes before the first step. Solids count: `cut` makes them those of a window.
void find_liquid_fields(LiquidGrid& grid, const GasSolids& solids, FunctionRef<void(const FluidWindow&)> cut);

}  // namespace gyre
