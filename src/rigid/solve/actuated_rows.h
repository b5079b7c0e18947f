// Actuated rows may do work: springs, motors, drives to a pose and soft limits. The kinetic energy that all rows of an island add is the
// sum over the rows of impulse times mean speed. So the work of actuated rows is measured apart from that of the passive rows, which should
// do none (rigid/solve/energy_limiter.h).
#pragma once

#include "rigid/solve/joint_solve.h"

namespace gyre {

// The impulse and the speed of a row when a stage begins. An axis uses x of the first two vectors. An axis that is solved with the
// equations of its articulation (solver/articulation/articulation_drives.h) knows its work and stores it in `worked`.
struct RowState {
  Vec3 push, speed;    // N s, m/s (or N m s, rad/s)
  Vec3 turn, turning;  // N m s, rad/s: of drives
  double worked = 0.0;
};

struct ActuatedRow {
  std::uint32_t place = 0;  // index of the joint in the batch
  std::int32_t axis = 0;    // index in JointConstraint::axes; kDriveRow: the drive
  RowState begun;
};
constexpr std::int32_t kDriveRow = -1;

// True if any row of the joint is actuated.
bool can_do_work(const JointRecord& joint, const JointDetail* detail);

// Counts the actuated rows of a joint, and writes them to as many elements of `rows`.
std::size_t count_actuated_rows(const JointSolve& solve, std::uint32_t place);
void list_actuated_rows(const JointSolve& solve, std::uint32_t place, std::span<ActuatedRow> rows);

// J: the sum over all rows, and the sum of the magnitudes over motors.
struct ActuatedWork {
  double net = 0.0, of_motors = 0.0;
};

// Called before and after a stage that changes impulses. `is_warm`: the stage applies the whole of each impulse again.
void begin_actuated_rows(const JointSolve& solve, std::span<ActuatedRow> rows, bool is_warm);
ActuatedWork actuated_work(const JointSolve& solve, std::span<const ActuatedRow> rows);

}  // namespace gyre
