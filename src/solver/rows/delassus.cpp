#include "solver/rows/delassus.h"

namespace gyre {

namespace {

// Sides of rows have numbers: 2 i is the side of row i on a, 2 i + 1 that on b.
struct Side {
  std::int32_t body;
  DVec3 linear, angular, gain_linear, gain_angular;
};
Side side_of(const Row& row, bool is_b) {
  if (is_b) return {row.body_b, row.linear_b, row.angular_b, row.gain_linear_b, row.gain_angular_b};
  return {row.body_a, row.linear_a, row.angular_a, row.gain_linear_a, row.gain_angular_a};
}

}  // namespace

void fill_delassus(std::span<const Row> rows, std::size_t bodies, std::span<double> matrix,
                   std::span<std::int32_t> first, std::span<std::int32_t> next) {
  const std::size_t n = rows.size();
  for (std::size_t i = 0; i < n * n; ++i) matrix[i] = 0.0;
  for (std::size_t b = 0; b < bodies; ++b) first[b] = -1;
  for (std::size_t i = 0; i < n; ++i) {
    double* const row = &matrix[i * n];
    row[i] = rows[i].compliance;
    for (int s = 0; s < 2; ++s) {
      const Side side = side_of(rows[i], s == 1);
      if (side.body == kNoRowBody) continue;
      std::int32_t& head = first[std::size_t(side.body)];
      next[2 * i + std::size_t(s)] = head;
      head = std::int32_t(2 * i) + s;
      // First the row itself, then earlier rows on the same body.
      for (std::int32_t other = head; other >= 0; other = next[std::size_t(other)]) {
        const std::size_t j = std::size_t(other) / 2;
        const Side by = side_of(rows[j], (other & 1) != 0);
        const double k = dot(side.linear, by.gain_linear) + dot(side.angular, by.gain_angular);
        row[j] += k;
        if (j != i) matrix[j * n + i] += k;
      }
    }
  }
}

}  // namespace gyre
