#include "rigid/solve/actuated_rows.h"

#include "solver/joint/joint_axis.h"
#include "solver/joint/joint_blocks.h"
#include "solver/joint/pose_drive.h"

#include <cmath>

namespace gyre {

namespace {

bool can_do_work(const JointAxisRecord& axis) {
  return axis.motor_force > 0.0f || has_spring(axis) || axis.limit_frequency > 0.0f;
}

bool is_listed(const AxisConstraint& x) { return x.in_articulation || can_do_work(x.axis); }

// Dry friction only removes energy, so its impulse is left out.
float worked_impulse(const JointAxisRecord& axis) {
  const float stops = axis.limit_frequency > 0.0f ? axis.low_impulse - axis.high_impulse : 0.0f;
  return axis.spring_impulse + axis.motor_impulse + stops;
}

// The work of a motor is bounded by its force, that of a spring is not.
bool is_motor(const JointSolve& solve, const ActuatedRow& row) {
  if (row.axis == kDriveRow) return false;
  const JointAxisRecord& axis = solve.works.work[row.place].axes[std::size_t(row.axis)].axis;
  return axis.motor_force > 0.0f && !has_spring(axis) && !(axis.limit_frequency > 0.0f);
}

RowState state_of(const JointSolve& solve, const ActuatedRow& row) {
  const JointConstraint& work = solve.works.work[row.place];
  const JointPair pair(solve.w.joints.records[solve.batch.joints[row.place]], solve.bodies);
  if (row.axis != kDriveRow) {
    const AxisConstraint& x = work.axes[std::size_t(row.axis)];
    if (x.in_articulation) return {{}, {}, {}, {}, x.drive_work};
    return {{worked_impulse(x.axis), 0, 0}, {axis_speed(x.row, pair), 0, 0}, {}, {}, 0.0};
  }
  return {work.detail->drive_force_impulse, pair.point_velocity(work.drive->from_a, work.from_b),
          work.detail->drive_torque_impulse, pair.relative_spin(), 0.0};
}

}  // namespace

bool can_do_work(const JointRecord& joint, const JointDetail* detail) {
  if (joint.is_spring || joint.motor_force > 0.0f || joint.stiffness > 0.0f || joint.damping > 0.0f)
    return true;
  if (detail == nullptr) return false;
  if (has_drive(*detail)) return true;
  for (const JointAxisRecord& axis : detail->axes)
    if (can_do_work(axis)) return true;
  return false;
}

std::size_t count_actuated_rows(const JointSolve& solve, std::uint32_t place) {
  const JointConstraint& work = solve.works.work[place];
  std::size_t count = work.drive != nullptr ? 1 : 0;
  for (const AxisConstraint& x : work.axes) count += is_listed(x) ? 1 : 0;
  return count;
}

void list_actuated_rows(const JointSolve& solve, std::uint32_t place, std::span<ActuatedRow> rows) {
  const JointConstraint& work = solve.works.work[place];
  std::size_t count = 0;
  if (work.drive != nullptr) rows[count++] = {place, kDriveRow, {}};
  for (std::size_t i = 0; i < work.axes.size(); ++i)
    if (is_listed(work.axes[i])) rows[count++] = {place, std::int32_t(i), {}};
}

void begin_actuated_rows(const JointSolve& solve, std::span<ActuatedRow> rows, bool is_warm) {
  for (ActuatedRow& row : rows) {
    row.begun = state_of(solve, row);
    if (is_warm) row.begun.push = row.begun.turn = {};
  }
}

ActuatedWork actuated_work(const JointSolve& solve, std::span<const ActuatedRow> rows) {
  ActuatedWork sum;
  for (const ActuatedRow& row : rows) {
    const RowState now = state_of(solve, row);
    const double work = now.worked - row.begun.worked +
                        0.5 * double(dot(now.push - row.begun.push, now.speed + row.begun.speed)) +
                        0.5 * double(dot(now.turn - row.begun.turn, now.turning + row.begun.turning));
    sum.net += work;
    if (is_motor(solve, row)) sum.of_motors += std::abs(work);
  }
  return sum;
}

}  // namespace gyre
