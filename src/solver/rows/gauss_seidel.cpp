#include "solver/rows/gauss_seidel.h"

#include "math/dense.h"

namespace gyre {

namespace {

// The residual costs as much as an iteration, so it is computed this rarely.
constexpr int kIterationsPerCheck = 8;

double row_w(const Row& row, std::span<const RowBody> bodies) {
  return row_speed(row, bodies) - row.target_speed + row.compliance * row.impulse;
}

double change_row(Row& row, double impulse, std::span<RowBody> bodies) {
  const double change = impulse - row.impulse;
  if (change == 0.0) return 0.0;
  apply_row_impulse(row, change, bodies);
  row.impulse = impulse;
  return row.diagonal * change * change;
}

// J_i M^-1 J_j^T of two rows between the same bodies.
double coupling(const Row& i, const Row& j) {
  return dot(i.linear_a, j.gain_linear_a) + dot(i.angular_a, j.gain_angular_a) +
         dot(i.linear_b, j.gain_linear_b) + dot(i.angular_b, j.gain_angular_b);
}

// Solves the equations of a joint exactly. Returns the sum of squared changes.
double solve_block(std::span<Row> rows, std::span<RowBody> bodies) {
  const std::size_t n = rows.size();
  double k[kMaxRowBlock * kMaxRowBlock], x[kMaxRowBlock];
  for (std::size_t i = 0; i < n; ++i) {
    x[i] = -row_w(rows[i], bodies);
    for (std::size_t j = 0; j <= i; ++j) k[i * n + j] = coupling(rows[i], rows[j]);
    k[i * n + i] = rows[i].diagonal;
  }
  factor_ldlt(std::span<double>(k, n * n), int(n));
  solve_ldlt(std::span<const double>(k, n * n), int(n), std::span<double>(x, n));
  double change_sum = 0.0;
  for (std::size_t i = 0; i < n; ++i) change_sum += change_row(rows[i], rows[i].impulse + x[i], bodies);
  return change_sum;
}

}  // namespace

void warm_start_rows(std::span<const Row> rows, std::span<RowBody> bodies) {
  for (const Row& row : rows) {
    if (row.impulse != 0.0) apply_row_impulse(row, row.impulse, bodies);
  }
}

double iterate_rows_once(std::span<Row> rows, std::span<RowBody> bodies, const FrictionSet& friction) {
  double change_sum = 0.0;
  const auto impulse_of = [&](int j) { return rows[std::size_t(j)].impulse; };
  for (std::size_t i = 0; i < rows.size(); ++i) {
    Row& row = rows[i];
    if (row.block > 1) {
      change_sum += solve_block(rows.subspan(i, std::size_t(row.block)), bodies);
      i += std::size_t(row.block) - 1;
      continue;
    }
    if (!(row.diagonal > 0.0)) continue;
    if (row.limits.kind == RowKind::cone) {
      Row& second = rows[i + 1];
      const double rate = max(row.diagonal, second.diagonal);
      const double radius = row.limits.friction * load_of(row.limits, impulse_of);
      const FrictionPoint to = nearest_friction(friction, radius, row.impulse - row_w(row, bodies) / rate,
                                                second.impulse - row_w(second, bodies) / rate);
      change_sum += change_row(row, to.x, bodies);
      change_sum += change_row(second, to.y, bodies);
      ++i;
      continue;
    }
    double low = row.limits.low, high = row.limits.high;
    if (row.limits.kind == RowKind::load) {
      high = row.limits.friction * load_of(row.limits, impulse_of);
      low = -high;
    }
    change_sum += change_row(row, clamp(row.impulse - row_w(row, bodies) / row.diagonal, low, high), bodies);
  }
  return change_sum;
}

double find_row_residual(std::span<const Row> rows, std::span<const RowBody> bodies,
                         const FrictionSet& friction) {
  double largest = 0.0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    largest = max(largest,
                  row_residual(
                      int(i), rows[i].limits, friction, [&](int j) { return rows[std::size_t(j)].impulse; },
                      [&](int j) { return row_w(rows[std::size_t(j)], bodies); },
                      [&](int j) { return rows[std::size_t(j)].diagonal; }));
  }
  return largest;
}

GaussSeidelResult solve_nncg(std::span<Row> rows, std::span<RowBody> bodies, const FrictionSet& friction,
                             double tolerance, int max_iterations, NumberRoom room) {
  const std::span<double> direction = room.take(rows.size()), before = room.take(rows.size());
  for (double& value : direction) value = 0.0;
  double last = 0.0;
  GaussSeidelResult result;
  while (result.iterations < max_iterations) {
    for (std::size_t i = 0; i < rows.size(); ++i) before[i] = rows[i].impulse;
    iterate_rows_once(rows, bodies, friction);
    ++result.iterations;
    // The impulses are those of a plain iteration here, within their bounds.
    if (result.iterations % kIterationsPerCheck == 0 || result.iterations == max_iterations) {
      result.residual = find_row_residual(rows, bodies, friction);
      if (result.residual <= tolerance || result.iterations == max_iterations) return result;
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
      apply_row_impulse(rows[i], along, bodies);
      rows[i].impulse += along;
    }
  }
  return result;
}

}  // namespace gyre
