// Islands of bodies and contacts for the tests of the row solvers, by hand or from a seed.
#pragma once

#include "math/block_lu.h"
#include "solver/rows/complementarity.h"
#include "solver/rows/delassus.h"
#include "solver/rows/gauss_seidel.h"
#include "solver/rows/solve_direct.h"

#include <cstdint>
#include <vector>

namespace gyre {

class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed * 2654435761u + 88172645463325252u) {}
  // Within [low, high].
  double in(double low, double high) {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return low + (high - low) * double(state_ >> 11) / 9007199254740992.0;
  }
  int below(int count) { return int(in(0.0, double(count) - 1.0e-9)); }
  DVec3 vector(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }

 private:
  std::uint64_t state_;
};

inline std::int32_t add_body(std::vector<RowBody>& bodies, double mass, double size, DVec3 velocity) {
  const double inertia = 6.0 / (mass * size * size), w = 1.0 / mass;
  bodies.push_back({velocity, {}, {w, w, w}, {inertia, inertia, inertia, 0, 0, 0}});
  return std::int32_t(bodies.size()) - 1;
}

// A contact point of a and b; the normal is from a to b.
inline void add_contact(std::vector<Row>& rows, std::span<const RowBody> bodies, std::int32_t a,
                        std::int32_t b, DVec3 from_a, DVec3 from_b, DVec3 normal, double friction,
                        double gap_speed = 0.0) {
  const DVec3 helper = normal.y * normal.y < 0.5 ? DVec3{0, 1, 0} : DVec3{1, 0, 0};
  DVec3 t1 = cross(normal, helper);
  t1 = t1 / length(t1);
  const DVec3 axes[3] = {normal, t1, cross(normal, t1)};
  const std::int32_t first = std::int32_t(rows.size());
  for (int k = 0; k < 3; ++k) {
    Row row;
    row.body_a = a, row.body_b = b;
    row.linear_a = -axes[k], row.angular_a = -cross(from_a, axes[k]);
    row.linear_b = axes[k], row.angular_b = cross(from_b, axes[k]);
    if (k == 0) row.limits.low = 0.0, row.target_speed = -gap_speed;
    if (k == 1) row.limits = {RowKind::cone, 0, 0, friction, first, 1};
    if (k == 2) row.limits = {RowKind::cone_second, 0, 0, friction, first, 1};
    finish_row(row, bodies);
    rows.push_back(row);
  }
}

inline void add_equation(std::vector<Row>& rows, std::span<const RowBody> bodies, std::int32_t a,
                         std::int32_t b, DVec3 from_a, DVec3 from_b, DVec3 axis) {
  Row row;
  row.body_a = a, row.body_b = b;
  row.linear_a = -axis, row.angular_a = -cross(from_a, axis);
  row.linear_b = axis, row.angular_b = cross(from_b, axis);
  finish_row(row, bodies);
  rows.push_back(row);
}

// The four lower corners of a box of `size` on the body below.
inline void add_corners(std::vector<Row>& rows, std::span<const RowBody> bodies, std::int32_t below,
                        std::int32_t box, double size, double friction) {
  const double h = 0.5 * size;
  for (int k = 0; k < 4; ++k) {
    const DVec3 corner{k & 1 ? h : -h, -h, k & 2 ? h : -h};
    add_contact(rows, bodies, below, box, corner + DVec3{0, size, 0}, corner, {0, 1, 0}, friction);
  }
}

struct Island {
  std::vector<RowBody> bodies;
  std::vector<Row> rows;
};

// Boxes on each other, the lowest on static ground, after a step of gravity.
inline Island make_stack(const std::vector<double>& masses, double kick) {
  Island island;
  for (const double mass : masses) add_body(island.bodies, mass, 1.0, {0, -kick, 0});
  for (std::size_t i = 0; i < masses.size(); ++i)
    add_corners(island.rows, island.bodies, std::int32_t(i) - 1, std::int32_t(i), 1.0, 0.5);
  return island;
}

// Bodies with random contacts among each other and with the ground, some joined.
inline Island make_heap(std::uint64_t seed, int bodies, int contacts, int joints, double friction) {
  Chance chance(seed);
  Island island;
  for (int i = 0; i < bodies; ++i)
    add_body(island.bodies, chance.in(0.2, 5.0), chance.in(0.3, 1.0), chance.vector(1.0) + DVec3{0, -1, 0});
  for (int i = 0; i < contacts; ++i) {
    const int b = i < bodies ? i : chance.below(bodies);
    const int a = i < bodies ? -1 : (b + 1 + chance.below(bodies)) % (bodies + 1) - 1;
    if (a == b) continue;
    DVec3 normal = chance.vector(1.0) + DVec3{0, a < 0 ? 2.0 : 0.0, 0};
    normal = normal / length(normal);
    add_contact(island.rows, island.bodies, a, b, chance.vector(0.5), chance.vector(0.5), normal,
                chance.in(0.0, friction));
  }
  for (int i = 0; i < joints; ++i) {
    const int b = chance.below(bodies), a = b - 1;
    const DVec3 from_a = chance.vector(0.5), from_b = chance.vector(0.5);
    for (const DVec3 axis : {DVec3{1, 0, 0}, DVec3{0, 1, 0}, DVec3{0, 0, 1}})
      add_equation(island.rows, island.bodies, a, b, from_a, from_b, axis);
  }
  return island;
}

struct Dense {
  std::vector<double> a, q;
  std::vector<RowLimits> limits;
  DenseProblem problem;

  Dense(const Island& island, const FrictionSet& friction) {
    const std::size_t n = island.rows.size();
    a.resize(n * n);
    std::vector<std::int32_t> first(island.bodies.size()), next(2 * n);
    fill_delassus(island.rows, island.bodies.size(), a, first, next);
    for (const Row& row : island.rows) {
      q.push_back(row_speed(row, island.bodies) - row.target_speed);
      limits.push_back(row.limits);
    }
    problem = {int(n), a, q, limits, &friction};
  }
};

// The plan of an island's bodies for solver/rows/body_newton.h.
inline BlockPlan plan_of(const Island& island, Arena& arena) {
  const std::vector<std::uint8_t> sizes(island.bodies.size(), kLuBlock);
  std::vector<BlockEdge> edges;
  for (const Row& row : island.rows) {
    if (row.body_a >= 0 && row.body_b >= 0)
      edges.push_back({std::uint32_t(row.body_a), std::uint32_t(row.body_b)});
  }
  BlockPlan plan;
  plan_blocks(sizes, edges, std::uint64_t{1} << 40, arena, plan);
  return plan;
}

inline std::vector<RowBody> pushed(const Island& island, std::span<const double> x) {
  std::vector<RowBody> bodies = island.bodies;
  for (std::size_t i = 0; i < x.size(); ++i) apply_row_impulse(island.rows[i], x[i], bodies);
  return bodies;
}

inline double apart(const std::vector<RowBody>& a, const std::vector<RowBody>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
    largest = max(largest, max(length(a[i].linear - b[i].linear), length(a[i].angular - b[i].angular)));
  return largest;
}

}  // namespace gyre
