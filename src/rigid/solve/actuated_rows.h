// Rows of joints that may do work: springs, motors, drives to a pose, stops that give way. What all rows of an island changed of its kinetic
// energy is the sum over them of impulse times mean speed, so what these did can be told from what the rest did, which should do none
// (rigid/solve/energy_limiter.h).
#pragma once

#include "rigid/solve/solve.h"

namespace gyre {

// What a row had given as a stage began, and what it saw. Of an axis the numbers stand in x of the first two; of one that is solved with the
// equations of its linkage (solver/articulation/articulation_drives.h), which knows what it did, in `worked`.
struct RowState {
  Vec3 push, speed;    // N s, m/s (or N m s, rad/s)
  Vec3 turn, turning;  // N m s, rad/s: of drives
  double worked = 0.0;
};

struct ActuatedRow {
  std::uint32_t place = 0;  // of the joint in the batch
  std::int32_t axis = 0;    // in JointConstraint::axes; kDriveRow: the drive
  RowState begun;
};
constexpr std::int32_t kDriveRow = -1;

// Whether any row of a joint may.
bool can_do_work(const JointRecord& joint, const JointDetail* detail);

// How many of a joint's rows may; and these, into as much room.
std::size_t count_actuated_rows(const BatchContext& solve, std::uint32_t place);
void list_actuated_rows(const BatchContext& solve, std::uint32_t place, std::span<ActuatedRow> rows);

// Before and after a stage in which impulses change; is_warm: in which all of each impulse is given once more. The work in J.
void begin_actuated_rows(const BatchContext& solve, std::span<ActuatedRow> rows, bool is_warm);
double actuated_work(const BatchContext& solve, std::span<const ActuatedRow> rows);

}  // namespace gyre
