// The response of an articulation to impulses along further rows, with the answer of its equations. It comes
// from the factors of the equations (math/block_ldlt.h), so impulses along such rows violate no equation.
//
// With the equations' matrix as L D L^T, the Delassus entry of rows i and j is the one without equations
// minus y_i . D^-1 y_j, where L y is the effect of the impulse on the rows of the equations. Their answer is
// found once for all impulses together.
#pragma once

#include "solver/articulation/articulation.h"
#include "solver/joint/joint_axis.h"

namespace gyre {

// The row of an axis of a joint, with a sign.
struct ResponseRow {
  std::uint32_t node = 0;
  const AxisRow* row = nullptr;
  float sign = 1.0f;
};

// For an impulse of one along a row: y and D^-1 y, plan.rows numbers each.
struct ResponseColumn {
  std::span<double> down, scaled;
};
struct ResponseColumns {
  std::span<double> numbers;  // one column after the other
  ResponseColumn at(std::size_t i, std::size_t rows) const {
    return {numbers.subspan(2 * i * rows, rows), numbers.subspan((2 * i + 1) * rows, rows)};
  }
};
constexpr std::size_t response_room(std::size_t columns, std::size_t rows) { return 2 * columns * rows; }

// Takes the first numbers of a room.
inline std::span<double> take_room(std::span<double>& room, std::size_t count) {
  const std::span<double> taken = room.first(count);
  room = room.subspan(count);
  return taken;
}

void find_response(const Articulation& articulation, const ArticulationSolve& solve, const ResponseRow& row,
                   ResponseColumn column);

// Fills the Delassus matrix: matrix[i * stride + j] is the speed along row i for an impulse of one along row
// j. Entries among rows [0, known) stay.
void compute_delassus(const Articulation& articulation, const ArticulationSolve& solve,
                      std::span<const ResponseRow> rows, const ResponseColumns& columns, std::size_t known,
                      double* matrix, std::size_t stride);

// Applies impulses along rows with the answer of the equations, to the velocities of bodies and the impulses
// of joints. `speeds` is room for six numbers a body.
void apply_row_impulses(const Articulation& articulation, const ArticulationSolve& solve,
                        std::span<const ResponseRow> rows, std::span<const double> impulses,
                        std::span<double> speeds);

// The speed along an axis.
float axis_speed(const ArticulationNode& node, const AxisRow& row, const JointBodies& bodies);

}  // namespace gyre
