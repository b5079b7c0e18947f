// LiquidMemory: arrays that the stages of a step of a liquid share. Nothing in it is state: a new one gives the same bits.
#pragma once

#include "fluid/solver/pressure_matrix.h"

namespace gyre {

struct LiquidMemory {
  static constexpr int kFields = 12;
  Array<float> field[kFields];
  Array<float> open[3];          // of faces: the fraction through which pressure acts
  Array<float> before[3];        // velocities of faces before forces
  Array<std::uint8_t> cell;      // kind of each cell
  Array<std::uint8_t> known[3];  // of faces: layers from those whose velocity is given
  Array<std::int32_t> start;     // of the particles of each cell
  Array<std::int32_t> place;     // of each particle in the order of cells
  Array<float> spare;            // a column of particles while they are sorted
  PressureMatrix matrix;
};

}  // namespace gyre
