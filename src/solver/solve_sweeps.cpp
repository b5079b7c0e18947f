#include "solver/solve_sweeps.h"

namespace gyre {

namespace {

// The residual is as dear as a sweep: it is looked at this often.
constexpr int kLookEvery = 8;

double row_w(const Row& row, std::span<const RowBody> bodies) {
  return row_speed(row, bodies) - row.wanted + row.give * row.impulse;
}

double change_row(Row& row, double impulse, std::span<RowBody> bodies) {
  const double change = impulse - row.impulse;
  if (change == 0.0) return 0.0;
  push_row(row, change, bodies);
  row.impulse = impulse;
  return row.diagonal * change * change;
}

}  // namespace

void warm_start_rows(std::span<const Row> rows, std::span<RowBody> bodies) {
  for (const Row& row : rows) {
    if (row.impulse != 0.0) push_row(row, row.impulse, bodies);
  }
}

double sweep_rows_once(std::span<Row> rows, std::span<RowBody> bodies, const FrictionSet& friction) {
  double moved = 0.0;
  const auto impulse_of = [&](int j) { return rows[std::size_t(j)].impulse; };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row& row = rows[i];
    if (!(row.diagonal > 0.0)) continue;
    if (row.limits.kind == RowKind::cone) {
      Row& second = rows[i + 1];
      const double rate = max(row.diagonal, second.diagonal);
      const double radius = row.limits.friction * load_of(row.limits, impulse_of);
      const FrictionPoint to = nearest_friction(friction, radius, row.impulse - row_w(row, bodies) / rate,
                                                second.impulse - row_w(second, bodies) / rate);
      moved += change_row(row, to.x, bodies);
      moved += change_row(second, to.y, bodies);
      ++i;
      continue;
    }
    double low = row.limits.low, high = row.limits.high;
    if (row.limits.kind == RowKind::load) {
      high = row.limits.friction * load_of(row.limits, impulse_of);
      low = -high;
    }
    moved += change_row(row, clamp(row.impulse - row_w(row, bodies) / row.diagonal, low, high), bodies);
  }
  return moved;
}

double find_row_residual(std::span<const Row> rows, std::span<const RowBody> bodies,
                         const FrictionSet& friction) {
  double most = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    most =
        max(most, row_residual(
                      int(i), rows[i].limits, friction, [&](int j) { return rows[std::size_t(j)].impulse; },
                      [&](int j) { return row_w(rows[std::size_t(j)], bodies); },
                      [&](int j) { return rows[std::size_t(j)].diagonal; }));
  }
  return most;
}

SweepResult solve_nncg(std::span<Row> rows, std::span<RowBody> bodies, const FrictionSet& friction,
                       double tolerance, int most_sweeps, NumberRoom room) {
  const std::span<double> direction = room.take(rows.size()), before = room.take(rows.size());
  for (double& value : direction) value = 0.0;
  double last = 0.0;
  SweepResult result;
  while (result.sweeps < most_sweeps) {
    for (std::size_t i = 0; i < rows.size(); ++i) before[i] = rows[i].impulse;
    sweep_rows_once(rows, bodies, friction);
    ++result.sweeps;
    // What stands now is a plain sweep's: within its limits.
    if (result.sweeps % kLookEvery == 0 || result.sweeps == most_sweeps) {
      result.residual = find_row_residual(rows, bodies, friction);
      if (result.residual <= tolerance || result.sweeps == most_sweeps) return result;
    }
    double square = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double change = rows[i].impulse - before[i];
      square += rows[i].diagonal * change * change;
    }
    const double share = last > 0.0 ? square / last : 2.0;
    last = square;
    if (share > 1.0) {
      for (std::size_t i = 0; i < rows.size(); ++i) direction[i] = rows[i].impulse - before[i];
      continue;
    }
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double along = share * direction[i];
      direction[i] = along + (rows[i].impulse - before[i]);
      if (along == 0.0) continue;
      push_row(rows[i], along, bodies);
      rows[i].impulse += along;
    }
  }
  return result;
}

}  // namespace gyre
