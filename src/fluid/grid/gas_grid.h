// GasGrid: the state of a gas in a box of cells. Velocities stand on the faces of cells (F. Harlow, J. Welch, "Numerical Calculation of
// Time-Dependent Viscous Incompressible Flow", 1965), density of smoke, temperature and pressure at the centres. Everything is in the axes
// of the box and relative to its lower corner, so that nothing depends on the distance from the origin of the world.
//
// An axis with one cell is flat: nothing moves or rubs along it, so one cell in z makes a plane flow.
#pragma once

#include "base/container/array.h"
#include "fluid/grid/cell_box.h"
#include "fluid/grid/grid_shape.h"

#include <gyre/fluid.h>
#include <gyre/math.h>

#include <cstdint>

namespace gyre {

using GasBoundary = FluidBoundary;

struct GasBox {
  int cells[3] = {0, 0, 0};
  Vec3 cell{1, 1, 1};  // m, the edges of a cell
  DVec3 corner{};      // m, the lower corner in the world
  // Sides -x, +x, -y, +y, -z, +z, and how they move in their own plane (m/s).
  GasBoundary side[6] = {GasBoundary::open, GasBoundary::open, GasBoundary::open,
                         GasBoundary::open, GasBoundary::open, GasBoundary::open};
  Vec3 wall_velocity[6] = {};

  bool flat(int axis) const { return cells[axis] == 1; }
  bool periodic(int axis) const { return side[2 * axis] == GasBoundary::periodic; }
  bool open(int side_index) const { return side[side_index] == GasBoundary::open && !flat(side_index / 2); }
  bool any_open() const {
    for (int s = 0; s < 6; ++s)
      if (open(s)) return true;
    return false;
  }
};

// A distance along an axis, in metres: on a periodic axis that to the nearest image.
inline double nearest_image(const GasBox& box, int axis, double distance) {
  if (!box.periodic(axis)) return distance;
  const float edge = axis == 0 ? box.cell.x : axis == 1 ? box.cell.y : box.cell.z;
  const double length = box.cells[axis] * double(edge);
  return distance > 0.5 * length    ? distance - length
         : distance < -0.5 * length ? distance + length
                                    : distance;
}
// How far a place of the box is from the image of it that is nearest to a centre: zero but beyond the sides of periodic axes.
inline DVec3 image_shift(const GasBox& box, DVec3 place, DVec3 center) {
  const DVec3 way = place - center;
  return {nearest_image(box, 0, way.x) - way.x, nearest_image(box, 1, way.y) - way.y,
          nearest_image(box, 2, way.z) - way.z};
}

struct GasGrid {
  GasBox whole;  // the box of the gas
  Array<CellBox>
      window;  // of an adaptive domain: the cells of `whole` that the arrays hold, one element; empty: all
  GasBox box;  // of the cells that the arrays hold
  GridShape shape;           // of these
  Array<float> velocity[3];  // m/s, of u on faces across x, of v across y, of w across z
  Array<float> density;      // kg/m^3, of smoke
  Array<float> temperature;  // K
  Array<float> pressure;     // m^2/s^2: over the density of the gas, without what rests on gravity
  Array<float> fuel;         // kg/m^3; empty: nothing burns
  float ambient_temperature = 293.15f;

  // The cell of `whole` that is the first of the arrays.
  int first(int axis) const { return window.empty() ? 0 : window[0].low[axis]; }
  // The cells of `whole` that the arrays hold.
  CellBox cells() const {
    CellBox range;
    for (int axis = 0; axis < 3; ++axis)
      range.low[axis] = first(axis), range.high[axis] = first(axis) + box.cells[axis];
    return range;
  }
};

// A gas at rest, without smoke, at the ambient temperature.
GasGrid make_gas_grid(const GasBox& box, float ambient_temperature);

// The ghost cells of a field of cell centres: of a periodic axis the cells of the opposite side, elsewhere the nearest cell, or `outside`
// beyond open sides.
void fill_ghosts(const GasBox& box, const GridShape& shape, float* field, const float* outside = nullptr);
// The same of a pressure, which is zero in the middle between the last cell and its ghost at an open side.
void fill_pressure_ghosts(const GasBox& box, const GridShape& shape, float* field);
void clear_ghosts(const GridShape& shape, float* field);
// All numbers of the array that are no cell (faces = -1) or face across the axis: kernels leave there what depends on their width.
void clear_outside(const GridShape& shape, int faces, Array<float>& field);
// Copies where ghosts are of use on periodic axes only and are zero elsewhere.
void wrap_ghosts(const GridShape& shape, const bool periodic[3], float* field);
// Faces that stand twice in the array: those of the upper side of a periodic axis are those of the lower side. Ghosts beyond the faces, likewise.
void wrap_faces(const GasBox& box, const GridShape& shape, int axis, float* faces);

// The value of a field at a point of the box, linearly between grid points. `faces`: the axis across whose faces the
// field stands, -1: cell centres. Points outside are moved to the nearest point inside.
float sample_field(const GasBox& box, const GridShape& shape, const float* field, int faces, Vec3 point);

}  // namespace gyre
