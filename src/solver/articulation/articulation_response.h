// What impulses along further rows make of a linkage: of its bodies' velocities, after the equations have answered. Found from the
// factors that are there anyway (math/block_ldlt.h), so what is pushed along such rows keeps to all equations.
//
// With the equations' matrix as L D L^T, the way of row i under an impulse along row j is what it would be without equations less
// y_i . D^-1 y_j, where L y is what the impulse makes of the equations' rows. What they answer is found once for all impulses together.
#pragma once

#include "solver/articulation/articulation.h"
#include "solver/joint/joint_axis.h"

namespace gyre {

// The row of an axis of a linkage's joint; it sees and is pushed by `sign` times what the axis is.
struct ResponseRow {
  std::uint32_t node = 0;
  const AxisRow* row = nullptr;
  float sign = 1.0f;
};

// Of an impulse of one along a row: y and D^-1 y, plan.rows numbers each.
struct ResponseColumn {
  std::span<double> down, scaled;
};
struct ResponseColumns {
  std::span<double> numbers;  // of one column after the other
  ResponseColumn at(std::size_t i, std::size_t rows) const {
    return {numbers.subspan(2 * i * rows, rows), numbers.subspan((2 * i + 1) * rows, rows)};
  }
};
constexpr std::size_t response_room(std::size_t columns, std::size_t rows) { return 2 * columns * rows; }

// Takes the first numbers of a room for one purpose.
inline std::span<double> take_room(std::span<double>& room, std::size_t count) {
  const std::span<double> taken = room.first(count);
  room = room.subspan(count);
  return taken;
}

void find_response(const Articulation& articulation, const ArticulationSolve& solve, const ResponseRow& row,
                   ResponseColumn column);

// Ways among rows from, to, ...: matrix[i * stride + j] is the speed that row i has of an impulse of one along row j. Those of [0, known) among
// each other are left as they are.
void compute_delassus(const Articulation& articulation, const ArticulationSolve& solve,
                      std::span<const ResponseRow> rows, const ResponseColumns& columns, std::size_t known,
                      double* matrix, std::size_t stride);

// Adds impulses along rows, and what the equations answer: to the bodies' velocities and to what joints keep. `speeds` is room for six
// numbers a body.
void apply_row_impulses(const Articulation& articulation, const ArticulationSolve& solve,
               std::span<const ResponseRow> rows, std::span<const double> impulses, std::span<double> speeds);

// What an axis sees of the bodies' velocities.
float axis_speed(const ArticulationNode& node, const AxisRow& row, const JointBodies& bodies);

}  // namespace gyre
