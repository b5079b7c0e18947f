// LiquidMemory: arrays that the stages of a step of a liquid share. Nothing in it is state: with a new one the results have the same bits.
// Grids have the cells of a window.
#pragma once

#include "fluid/liquid/liquid_window.h"
#include "fluid/solver/body_coupling.h"
#include "fluid/solver/pressure_matrix.h"

namespace gyre {

// Cells of a liquid's grid.
enum class LiquidCell : std::uint8_t { air, liquid, solid };

struct LiquidMemory {
  // The cells that the arrays hold, and those of the fields that were given to the state last; nothing else in the state differs from air at rest.
  FluidWindow window;
  bool has_stored = false;
  FluidWindow stored;
  Array<float> velocity[3];  // m/s, on faces
  Array<float> surface;      // m, at centres: as in LiquidGrid
  Array<float> pressure;     // m^2/s^2, at centres
  static constexpr int kFields = 8;
  Array<float> field[kFields];
  Array<float> sums[3];   // of faces: pairs of the volume of particles and of its momentum
  Array<float> filled;    // at centres: the fraction of the room around that is full
  Array<float> drift[3];  // m/s, on faces: what moves particles, besides the velocity, to where there is room
  Array<float> before[3];  // velocities on faces, as particles give them
  Array<float> open[3];    // of faces: the fraction through which the liquid passes
  // Of faces: what the gradient of pressure is multiplied by. 1 between cells of liquid, at the surface an edge over the distance from the
  // liquid's centre to it, 0 where pressure does not act.
  Array<float> steepness[3];
  Array<std::uint8_t> wet_row;  // rows of cells with liquid
  // `open` is that of a box without solids, with these sides, so it lasts.
  bool has_open = false;
  GasBoundary open_side[6] = {};
  Array<std::uint8_t> blocked;  // cells without room for liquid
  Array<LiquidCell> cell;
  Array<std::uint8_t> wet;        // of centres: liquid among this and the seven above along the axes
  Array<std::uint8_t> known_row;  // rows of faces of one axis: 0 if none is beside liquid
  Array<std::uint8_t> layer[3];   // of faces: how many from those beside liquid, which are 0
  Array<std::int32_t> beyond[3];  // faces beyond those, layer by layer, and where each layer begins
  Array<std::int32_t> beyond_begin[3];
  Array<std::int32_t> start;  // of the particles of each cell
  Array<std::int32_t> place;  // of each particle in the order of cells, -1: it has left
  Array<float> spare;         // a column of particles while they are sorted
  PressureMatrix matrix;
  BodyCoupling coupling;
};

}  // namespace gyre
