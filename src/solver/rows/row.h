// Scalar constraint rows: one equation or inequality between two bodies along or about a direction. The
// solvers of whole islands (sequential impulses over rows, and the complementarity problem) use rows; the
// default solver does not.
//
// For the speed J v of a row, w = J v - target + compliance x is complementary to its impulse x within its
// limits: x at its lower limit: w >= 0; x at its upper limit: w <= 0; between: w = 0. Units: N s and m/s, or
// N m s and rad/s for angular rows. Everything is double: the rows of an island may span mass ratios beyond
// single precision.
//
// Sources: D. E. Stewart, J. C. Trinkle, "An implicit time-stepping scheme for rigid body dynamics with
// inelastic collisions and Coulomb friction", 1996; R. W. Cottle, J.-S. Pang, R. E. Stone, "The Linear
// Complementarity Problem", 1992.
#pragma once

#include "solver/rows/friction_set.h"

#include <gyre/math.h>

#include <cstddef>
#include <cstdint>
#include <span>

namespace gyre {

constexpr double kNoLimit = 1.0e300;  // N s; of rows without a bound

enum class RowKind : std::uint8_t {
  box,          // low <= x <= high; without either bound it is an equation
  cone,         // first tangent of a point: (x, next x) lies within friction times the load, see FrictionSet
  cone_second,  // second tangent
  load,         // |x| <= friction times the load
};

struct RowLimits {
  RowKind kind = RowKind::box;
  double low = -kNoLimit, high = kNoLimit;
  double friction = 0.0;  // per N s of load: 1, or m for angular rows
  // The load is the sum of the impulses of these rows, whose lower limit is 0.
  std::int32_t load_first = 0, load_count = 0;
};

inline bool is_equation(const RowLimits& l) {
  return l.kind == RowKind::box && l.low <= -kNoLimit && l.high >= kNoLimit;
}

// A body as rows see it: its velocities and its inverse inertia.
struct RowBody {
  DVec3 linear, angular;
  DVec3 inverse_mass;         // along the world's axes: 0 along locked ones
  double inverse_inertia[6];  // xx yy zz xy xz yz, world axes
};

constexpr std::int32_t kNoRowBody = -1;
constexpr int kMaxRowBlock = 6;

struct Row {
  std::int32_t body_a = kNoRowBody, body_b = kNoRowBody;  // indices in the list of the island
  // In the first of several equations between the same two bodies, as of a joint: their number. Iterations
  // solve them together.
  std::int32_t block = 1;
  RowLimits limits;
  // J, signs included.
  DVec3 linear_a, angular_a, linear_b, angular_b;
  // M^-1 J^T: velocity changes for an impulse of one.
  DVec3 gain_linear_a, gain_angular_a, gain_linear_b, gain_angular_b;
  double target_speed = 0.0;
  double compliance = 0.0;
  double diagonal = 0.0;  // J M^-1 J^T + compliance
  double impulse = 0.0;
};

// The velocities of a body are six numbers in a row; J and M^-1 J^T are twelve each.
static_assert(offsetof(RowBody, angular) == offsetof(RowBody, linear) + 3 * sizeof(double));
static_assert(offsetof(Row, angular_b) == offsetof(Row, linear_a) + 9 * sizeof(double));
static_assert(offsetof(Row, gain_angular_b) == offsetof(Row, gain_linear_a) + 9 * sizeof(double));
inline const double* velocities_of(const RowBody& body) { return &body.linear.x; }
inline const double* jacobian_of(const Row& row) { return &row.linear_a.x; }
inline const double* gains_of(const Row& row) { return &row.gain_linear_a.x; }

inline DVec3 along_inertia(const RowBody& body, DVec3 v) {
  const double* m = body.inverse_inertia;
  return {m[0] * v.x + m[3] * v.y + m[4] * v.z, m[3] * v.x + m[1] * v.y + m[5] * v.z,
          m[4] * v.x + m[5] * v.y + m[2] * v.z};
}
inline DVec3 along_mass(const RowBody& body, DVec3 v) {
  return {body.inverse_mass.x * v.x, body.inverse_mass.y * v.y, body.inverse_mass.z * v.z};
}

// Computes gains and diagonal from J, compliance and the bodies.
inline void finish_row(Row& row, std::span<const RowBody> bodies) {
  row.diagonal = row.compliance;
  row.gain_linear_a = row.gain_angular_a = row.gain_linear_b = row.gain_angular_b = {};
  if (row.body_a != kNoRowBody) {
    const RowBody& a = bodies[std::size_t(row.body_a)];
    row.gain_linear_a = along_mass(a, row.linear_a);
    row.gain_angular_a = along_inertia(a, row.angular_a);
    row.diagonal += dot(row.linear_a, row.gain_linear_a) + dot(row.angular_a, row.gain_angular_a);
  }
  if (row.body_b != kNoRowBody) {
    const RowBody& b = bodies[std::size_t(row.body_b)];
    row.gain_linear_b = along_mass(b, row.linear_b);
    row.gain_angular_b = along_inertia(b, row.angular_b);
    row.diagonal += dot(row.linear_b, row.gain_linear_b) + dot(row.angular_b, row.gain_angular_b);
  }
}

// J v.
inline double row_speed(const Row& row, std::span<const RowBody> bodies) {
  double speed = 0.0;
  if (row.body_a != kNoRowBody) {
    const RowBody& a = bodies[std::size_t(row.body_a)];
    speed += dot(row.linear_a, a.linear) + dot(row.angular_a, a.angular);
  }
  if (row.body_b != kNoRowBody) {
    const RowBody& b = bodies[std::size_t(row.body_b)];
    speed += dot(row.linear_b, b.linear) + dot(row.angular_b, b.angular);
  }
  return speed;
}

inline void apply_row_impulse(const Row& row, double impulse, std::span<RowBody> bodies) {
  if (row.body_a != kNoRowBody) {
    RowBody& a = bodies[std::size_t(row.body_a)];
    a.linear += impulse * row.gain_linear_a;
    a.angular += impulse * row.gain_angular_a;
  }
  if (row.body_b != kNoRowBody) {
    RowBody& b = bodies[std::size_t(row.body_b)];
    b.linear += impulse * row.gain_linear_b;
    b.angular += impulse * row.gain_angular_b;
  }
}

}  // namespace gyre
