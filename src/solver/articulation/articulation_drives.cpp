#include "solver/articulation/articulation_drives.h"

#include "solver/articulation/articulation_limits.h"
#include "solver/articulation/articulation_response.h"

#include <cmath>

namespace gyre {

namespace {

constexpr int kDriveIterations = 50;
constexpr float kDriveTolerance = 1.0e-5f;  // m/s or rad/s: smaller changes of speed end the iteration
// Inverse mass of an axis relative to its two bodies alone, below which the equations hold it; their
// compliance is half of that.
constexpr double kMinAxisShare = 2.0e-4;

// Scratch memory, by axis.
struct DriveScratch {
  ResponseColumns columns;
  std::span<double> matrix, impulses, speeds;
  double delassus(std::size_t row, std::size_t pushed) const {
    return matrix[row * impulses.size() + pushed];
  }
};

DriveScratch scratch_of(const Articulation& articulation) {
  const std::size_t count = articulation.axes.size();
  std::span<double> room = articulation.axis_room;
  DriveScratch scratch;
  scratch.columns = {take_room(room, response_room(count, articulation.plan.rows))};
  scratch.matrix = take_room(room, count * count);
  scratch.impulses = take_room(room, count);
  scratch.speeds = take_room(room, 6 * articulation.bodies.size());
  return scratch;
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
  const DriveScratch room = scratch_of(articulation);
  const DriveRows rows(articulation);
  for (std::size_t c = 0; c < count; ++c)
    find_response(articulation, solve, rows.list()[c], room.columns.at(c, articulation.plan.rows));
  compute_delassus(articulation, solve, rows.list(), room.columns, 0, room.matrix.data(), count);
  for (std::size_t c = 0; c < count; ++c) {
    AxisConstraint& x = *articulation.axes[c].axis;
    const double k = room.delassus(c, c);
    if (!(x.mass > 0.0f && k * double(x.mass) > kMinAxisShare)) continue;
    prepare_axis_mass(x, float(1.0 / k), solve.settings);
    // Unlike iterative motors it need not be compliant.
    if (x.axis.motor_frequency <= 0.0f)
      x.drive = {solve.settings.softness.bias_rate, 1.0f / (1.0f + kMotorCompliance),
                 kMotorCompliance / (1.0f + kMotorCompliance)};
  }
}

void add_warm_start_work(const Articulation& articulation, const ArticulationSolve& solve) {
  const std::size_t count = articulation.axes.size();
  if (count == 0) return;
  const DriveScratch room = scratch_of(articulation);
  for (std::size_t c = 0; c < count; ++c) {
    // Hard limits are constraints and count as no work.
    const AxisConstraint& x = *articulation.axes[c].axis;
    room.impulses[c] = double(axis_impulse(x.axis));
    if (has_hard_limit(x)) room.impulses[c] -= double(x.axis.low_impulse - x.axis.high_impulse);
  }
  for (std::size_t c = 0; c < count; ++c) {
    AxisConstraint& x = *articulation.axes[c].axis;
    double speed_change = 0.0;
    for (std::size_t d = 0; d < count; ++d) speed_change += room.delassus(c, d) * room.impulses[d];
    const double before =
        double(axis_speed(articulation.nodes[articulation.axes[c].node], x.row, solve.bodies));
    x.drive_work += room.impulses[c] * (before + 0.5 * speed_change);
  }
}

void solve_drives(const Articulation& articulation, const ArticulationSolve& solve, bool soft) {
  const std::size_t count = articulation.axes.size();
  if (count == 0) return;
  const DriveScratch room = scratch_of(articulation);
  float speeds[kMaxDrivenAxes];
  for (std::size_t c = 0; c < count; ++c) {
    room.impulses[c] = 0.0;
    speeds[c] = axis_speed(articulation.nodes[articulation.axes[c].node], articulation.axes[c].axis->row,
                           solve.bodies);
  }
  float before[kMaxDrivenAxes];
  for (std::size_t c = 0; c < count; ++c) before[c] = speeds[c];
  bool is_any = false;
  for (int iteration = 0; iteration < kDriveIterations; ++iteration) {
    float largest = 0.0f;
    for (std::size_t c = 0; c < count; ++c) {
      const float k = float(room.delassus(c, c));
      const float impulse = solve_axis(*articulation.axes[c].axis, speeds[c], k, solve.settings, soft);
      if (impulse == 0.0f) continue;
      is_any = true;
      room.impulses[c] += double(impulse);
      for (std::size_t d = 0; d < count; ++d) speeds[d] += float(room.delassus(d, c)) * impulse;
      largest = max(largest, std::abs(k * impulse));
    }
    if (largest < kDriveTolerance) break;
  }
  if (!is_any) return;
  for (std::size_t c = 0; c < count; ++c)
    articulation.axes[c].axis->drive_work += 0.5 * room.impulses[c] * double(before[c] + speeds[c]);
  apply_row_impulses(articulation, solve, DriveRows(articulation).list(), room.impulses, room.speeds);
}

}  // namespace gyre
