// What an impulse along one more row makes of a linkage: of its bodies' velocities, after the equations have answered. Found from the
// factors that are there anyway (math/block_ldlt.h), so what is pushed along such columns keeps to all equations.
#pragma once

#include "solver/joint_axis.h"
#include "solver/linkage.h"

namespace gyre {

// Velocities of a linkage's bodies are six numbers each, one body after the other.
std::size_t response_speeds(const Linkage& linkage);

// Takes the first numbers of a room for one purpose.
inline std::span<double> take_room(std::span<double>& room, std::size_t count) {
  const std::span<double> part = room.first(count);
  room = room.subspan(count);
  return part;
}

// The column of an impulse of `sign` along the row of an axis of node `node`: by `speeds` what it changes of velocities, by `answers` what
// the equations give (as many as plan.rows).
struct ResponseColumn {
  std::span<double> speeds, answers;
};
void find_response(const Linkage& linkage, const LinkageSolve& solve, std::uint32_t node, const AxisRow& row, float sign,
                   ResponseColumn column);

// What a row sees of such velocities, and of the bodies' own.
double axis_speed(const LinkageNode& node, const AxisRow& row, std::span<const double> speeds);
float axis_speed(const LinkageNode& node, const AxisRow& row, const JointBodies& bodies);

// Adds impulses along `columns`, which lie one after the other: to the bodies' velocities and to what joints keep. `sum` is room for
// velocities.
struct ResponseColumns {
  std::span<double> speeds, answers;
  ResponseColumn at(std::size_t i, std::size_t speeds_each, std::size_t rows) const {
    return {speeds.subspan(i * speeds_each, speeds_each), answers.subspan(i * rows, rows)};
  }
};
void push_columns(const Linkage& linkage, const LinkageSolve& solve, std::span<const double> impulses,
                  const ResponseColumns& columns, std::span<double> sum);

}  // namespace gyre
