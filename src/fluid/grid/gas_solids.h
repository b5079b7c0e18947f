// GasSolids: how solids cut the faces of a grid. The caller finds it from shapes: of each face the fraction that is open and the velocity of
// the solid across the rest of it, and which cells lie within solids (C. Batty, F. Bertails, R. Bridson, "A Fast Variational Framework for
// Accurate Solid-Fluid Coupling", 2007).
#pragma once

#include "base/container/array.h"
#include "fluid/grid/grid_shape.h"

#include <gyre/math.h>

#include <cstdint>

namespace gyre {

struct GasSolids {
  Array<float> open[3];          // of the faces across each axis: 1 free, 0 closed by the solid
  Array<float> velocity[3];      // m/s: of the solid, along that axis
  Array<std::int16_t> label[3];  // of the solid that cuts the face, -1: none
  Array<std::uint8_t> solid;     // cells: 1 within a solid
  // For liquids, whose particles stay outside; gases leave both empty. At centres of cells: the distance from the surface of the nearest
  // solid, m, negative within it, right up to four cells and no less than that beyond, and the label of that solid, -1 beyond.
  Array<float> distance;
  Array<std::int16_t> nearest;
  // Rows of cells, with those of the last faces, cells[1] + 1 along y: 0 where no face is cut and no cell is within a solid. Empty: not known.
  Array<std::uint8_t> near;
  int labels = 0;
  std::uint64_t revision = 1;  // another number whenever `open` or `solid` changes

  bool present() const { return labels > 0; }
  bool may_cut(const GridShape& shape, int j, int k) const {
    return near.empty() || near[j + k * (shape.cells[1] + 1)] != 0;
  }
};

// Free space: no face is cut. Rows that are known to be free already are not written again.
void clear_solids(const GridShape& shape, int labels, GasSolids& solids);

// The impulse and its moment that the pressure of the gas gives to a solid in a step.
struct GasImpulse {
  DVec3 linear{};   // N s
  DVec3 angular{};  // N m s, about the lower corner of the box
};

}  // namespace gyre
