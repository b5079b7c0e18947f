#include "solver/articulation/articulation_drives.h"

#include "solver/articulation/articulation_limits.h"
#include "solver/articulation/linkage_response.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kAxisSweeps = 50;
constexpr float kAxesSettled = 1.0e-5f;  // m/s or rad/s: impulses that change speeds by less stand
// An axis that moves by no more than this share of what it would if its bodies were alone is held by the equations, which give way by half
// of that.
constexpr double kMinAxisShare = 2.0e-4;

// The parts of the room, by axis.
struct AxisRoom {
  ResponseColumns columns;
  std::span<double> matrix, impulses, speeds;
  double way(std::size_t seen, std::size_t pushed) const { return matrix[seen * impulses.size() + pushed]; }
};

AxisRoom room_of(const Articulation& articulation) {
  const std::size_t count = articulation.axes.size();
  std::span<double> room = articulation.axis_room;
  AxisRoom parts;
  parts.columns = {take_room(room, response_room(count, articulation.plan.rows))};
  parts.matrix = take_room(room, count * count);
  parts.impulses = take_room(room, count);
  parts.speeds = take_room(room, 6 * articulation.bodies.size());
  return parts;
}

// The rows of the axes.
class DriveRows {
 public:
  explicit DriveRows(const Articulation& articulation) : count_(articulation.axes.size()) {
    for (std::size_t c = 0; c < count_; ++c)
      rows_[c] = {articulation.axes[c].node, &articulation.axes[c].axis->row};
  }
  std::span<const ResponseRow> list() const { return {rows_, count_}; }

 private:
  std::size_t count_;
  ResponseRow rows_[kMaxDrivenAxes];
};

}  // namespace

bool is_driven_axis(const AxisConstraint& axis) {
  const JointAxisRecord& a = axis.axis;
  return !axis.is_rod && (has_spring(a) || a.motor_force > 0.0f || a.friction > 0.0f ||
                          (a.limit_frequency > 0.0f && (axis.has_low || axis.has_high)));
}

std::size_t drives_room(const Articulation& articulation, std::size_t axes) {
  return response_room(axes, articulation.plan.rows) + axes * (axes + 1) + 6 * articulation.bodies.size();
}

void prepare_drives(const Articulation& articulation, const ArticulationSolve& solve) {
  const std::size_t count = articulation.axes.size();
  if (count == 0) return;
  const AxisRoom room = room_of(articulation);
  const DriveRows rows(articulation);
  for (std::size_t c = 0; c < count; ++c)
    find_response(articulation, solve, rows.list()[c], room.columns.at(c, articulation.plan.rows));
  compute_delassus(articulation, solve, rows.list(), room.columns, 0, room.matrix.data(), count);
  for (std::size_t c = 0; c < count; ++c) {
    AxisConstraint& x = *articulation.axes[c].axis;
    const double k = room.way(c, c);
    if (!(x.mass > 0.0f && k * double(x.mass) > kMinAxisShare)) continue;
    prepare_axis_mass(x, float(1.0 / k), solve.settings);
    // It need not give way as what is swept late must.
    if (x.axis.motor_frequency <= 0.0f)
      x.drive = {solve.settings.softness.bias_rate, 1.0f / (1.0f + kMotorGive),
                 kMotorGive / (1.0f + kMotorGive)};
  }
}

void note_warm_work(const Articulation& articulation, const ArticulationSolve& solve) {
  const std::size_t count = articulation.axes.size();
  if (count == 0) return;
  const AxisRoom room = room_of(articulation);
  for (std::size_t c = 0; c < count; ++c) {
    // Hard stops tie.
    const AxisConstraint& x = *articulation.axes[c].axis;
    room.impulses[c] = double(axis_impulse(x.axis));
    if (has_hard_limit(x)) room.impulses[c] -= double(x.axis.low_impulse - x.axis.high_impulse);
  }
  for (std::size_t c = 0; c < count; ++c) {
    AxisConstraint& x = *articulation.axes[c].axis;
    double energy_gain = 0.0;
    for (std::size_t d = 0; d < count; ++d) energy_gain += room.way(c, d) * room.impulses[d];
    const double before =
        double(axis_speed(articulation.nodes[articulation.axes[c].node], x.row, solve.bodies));
    x.worked += room.impulses[c] * (before + 0.5 * energy_gain);
  }
}

void solve_drives(const Articulation& articulation, const ArticulationSolve& solve, bool soft) {
  const std::size_t count = articulation.axes.size();
  if (count == 0) return;
  const AxisRoom room = room_of(articulation);
  float speeds[kMaxDrivenAxes];
  for (std::size_t c = 0; c < count; ++c) {
    room.impulses[c] = 0.0;
    speeds[c] = axis_speed(articulation.nodes[articulation.axes[c].node], articulation.axes[c].axis->row,
                           solve.bodies);
  }
  float before[kMaxDrivenAxes];
  for (std::size_t c = 0; c < count; ++c) before[c] = speeds[c];
  bool is_any = false;
  for (int sweep = 0; sweep < kAxisSweeps; ++sweep) {
    float most = 0.0f;
    for (std::size_t c = 0; c < count; ++c) {
      const float k = float(room.way(c, c));
      const float impulse = solve_axis(*articulation.axes[c].axis, speeds[c], k, solve.settings, soft);
      if (impulse == 0.0f) continue;
      is_any = true;
      room.impulses[c] += double(impulse);
      for (std::size_t d = 0; d < count; ++d) speeds[d] += float(room.way(d, c)) * impulse;
      most = max(most, std::abs(k * impulse));
    }
    if (most < kAxesSettled) break;
  }
  if (!is_any) return;
  for (std::size_t c = 0; c < count; ++c)
    articulation.axes[c].axis->worked += 0.5 * room.impulses[c] * double(before[c] + speeds[c]);
  push_rows(articulation, solve, DriveRows(articulation).list(), room.impulses, room.speeds);
}

}  // namespace gyre
