#include "solver/linkage_axes.h"

#include "solver/linkage_response.h"
#include "solver/linkage_stops.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kAxisSweeps = 50;
constexpr float kAxesSettled = 1.0e-5f;  // m/s or rad/s: impulses that change speeds by less stand
// An axis that moves by no more than this share of what it would if its bodies were alone is held by the equations, which give way by half
// of that.
constexpr double kLeastAxisShare = 2.0e-4;

// The parts of the room, by axis.
struct AxisRoom {
  ResponseColumns columns;
  std::span<double> matrix, impulses, sum;
};

AxisRoom room_of(const Linkage& linkage) {
  const std::size_t count = linkage.axes.size(), speeds = response_speeds(linkage);
  std::span<double> room = linkage.axis_room;
  AxisRoom parts;
  parts.columns = {take_room(room, count * speeds), take_room(room, count * linkage.plan.rows)};
  parts.matrix = take_room(room, count * count);
  parts.impulses = take_room(room, count);
  parts.sum = take_room(room, speeds);
  return parts;
}

}  // namespace

bool acts_softly(const AxisWork& axis) {
  const JointAxisRecord& a = axis.axis;
  return !axis.is_rod && (has_spring(a) || a.motor_force > 0.0f || a.friction > 0.0f ||
                          (a.limit_frequency > 0.0f && (axis.has_low || axis.has_high)));
}

std::size_t linked_axes_room(const Linkage& linkage, std::size_t axes) {
  const std::size_t speeds = response_speeds(linkage);
  return axes * (speeds + linkage.plan.rows + axes + 1) + speeds;
}

void place_linked_axes(const Linkage& linkage, const LinkageSolve& solve) {
  const std::size_t count = linkage.axes.size();
  if (count == 0) return;
  const AxisRoom room = room_of(linkage);
  const auto column = [&](std::size_t c) {
    return room.columns.at(c, response_speeds(linkage), linkage.plan.rows);
  };
  for (std::size_t c = 0; c < count; ++c)
    find_response(linkage, solve, linkage.axes[c].node, linkage.axes[c].axis->row, 1.0f, column(c));
  for (std::size_t c = 0; c < count; ++c) {
    AxisWork& x = *linkage.axes[c].axis;
    for (std::size_t d = 0; d < count; ++d)
      room.matrix[c * count + d] =
          axis_speed(linkage.nodes[linkage.axes[c].node], x.row, column(d).speeds);
    const double k = room.matrix[c * count + c];
    if (x.mass > 0.0f && k * double(x.mass) > kLeastAxisShare)
      prepare_axis_mass(x, float(1.0 / k), solve.settings);
  }
}

void note_warm_work(const Linkage& linkage, const LinkageSolve& solve) {
  const std::size_t count = linkage.axes.size();
  if (count == 0) return;
  const AxisRoom room = room_of(linkage);
  for (std::size_t c = 0; c < count; ++c) {
    // Hard stops tie.
    const AxisWork& x = *linkage.axes[c].axis;
    room.impulses[c] = double(axis_impulse(x.axis));
    if (has_hard_stop(x)) room.impulses[c] -= double(x.axis.low_impulse - x.axis.high_impulse);
  }
  for (std::size_t c = 0; c < count; ++c) {
    AxisWork& x = *linkage.axes[c].axis;
    double gained = 0.0;
    for (std::size_t d = 0; d < count; ++d) gained += room.matrix[c * count + d] * room.impulses[d];
    const double before = double(axis_speed(linkage.nodes[linkage.axes[c].node], x.row, solve.bodies));
    x.worked += room.impulses[c] * (before + 0.5 * gained);
  }
}

void solve_linked_axes(const Linkage& linkage, const LinkageSolve& solve, bool soft) {
  const std::size_t count = linkage.axes.size();
  if (count == 0) return;
  const AxisRoom room = room_of(linkage);
  float speeds[kMostLinkedAxes];
  for (std::size_t c = 0; c < count; ++c) {
    room.impulses[c] = 0.0;
    speeds[c] = axis_speed(linkage.nodes[linkage.axes[c].node], linkage.axes[c].axis->row, solve.bodies);
  }
  float before[kMostLinkedAxes];
  for (std::size_t c = 0; c < count; ++c) before[c] = speeds[c];
  bool is_any = false;
  for (int sweep = 0; sweep < kAxisSweeps; ++sweep) {
    float most = 0.0f;
    for (std::size_t c = 0; c < count; ++c) {
      const float k = float(room.matrix[c * count + c]);
      const float impulse = solve_axis(*linkage.axes[c].axis, speeds[c], k, solve.settings, soft);
      if (impulse == 0.0f) continue;
      is_any = true;
      room.impulses[c] += double(impulse);
      for (std::size_t d = 0; d < count; ++d) speeds[d] += float(room.matrix[d * count + c]) * impulse;
      most = max(most, std::abs(k * impulse));
    }
    if (most < kAxesSettled) break;
  }
  if (!is_any) return;
  for (std::size_t c = 0; c < count; ++c)
    linkage.axes[c].axis->worked += 0.5 * room.impulses[c] * double(before[c] + speeds[c]);
  push_columns(linkage, solve, room.impulses, room.columns, room.sum);
}

}  // namespace gyre
