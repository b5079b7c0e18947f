#include "soft/solver/rigid_correction.h"

namespace gyre {

namespace {

// A direction of rotation in which all mass lies on a line has no inertia; it is left out.
constexpr double kLeastPivot = 1.0e-9;

DVec3 row_at(const VectorRows& rows, int i) {
  return {double(rows.x[i]), double(rows.y[i]), double(rows.z[i])};
}

}  // namespace

void RigidCorrection::begin(const Particles& particles) {
  double mass = 0.0;
  DVec3 first{};
  const DVec3 origin = particles.count > 0 ? particles.place(0) : DVec3{};
  for (int i = 0; i < particles.count; ++i) {
    mass += double(particles.mass[i]);
    first += double(particles.mass[i]) * (particles.place(i) - origin);
  }
  if (!(mass > 0.0)) return;
  is_on_ = true;
  center_ = origin + first / mass;
  for (int i = 0; i < particles.count; ++i) {
    const double m = double(particles.mass[i]);
    const DVec3 r = arm_of(particles, i);
    own_[3][3] += m * (r.y * r.y + r.z * r.z);
    own_[4][4] += m * (r.x * r.x + r.z * r.z);
    own_[5][5] += m * (r.x * r.x + r.y * r.y);
    own_[4][3] -= m * r.x * r.y;
    own_[5][3] -= m * r.x * r.z;
    own_[5][4] -= m * r.y * r.z;
  }
  for (int k = 0; k < 3; ++k) own_[k][k] = mass;
}

void RigidCorrection::clear_rows() {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) sum_[i][j] = own_[i][j];
}

void RigidCorrection::add_row(Vec3 normal, float along, float across, double share, DVec3 arm) {
  // The velocity of the row's point is share V + W x arm; its three components, as rows over V and W:
  const double move[3][6] = {
      {share, 0, 0, 0, arm.z, -arm.y}, {0, share, 0, -arm.z, 0, arm.x}, {0, 0, share, arm.y, -arm.x, 0}};
  double normal_move[6];
  for (int j = 0; j < 6; ++j)
    normal_move[j] =
        double(normal.x) * move[0][j] + double(normal.y) * move[1][j] + double(normal.z) * move[2][j];
  const double more = double(along) - double(across);
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j <= i; ++j) {
      const double even = move[0][i] * move[0][j] + move[1][i] * move[1][j] + move[2][i] * move[2][j];
      sum_[i][j] += double(across) * even + more * normal_move[i] * normal_move[j];
    }
  }
}

void RigidCorrection::factor() { factors_ = factor_ldlt(sum_, kLeastPivot); }

double RigidCorrection::add(const Particles& particles, const VectorRows& residual,
                            const VectorRows& out) const {
  DVec3 push{}, moment{};
  for (int i = 0; i < particles.count; ++i) {
    const DVec3 r = row_at(residual, i);
    push += r;
    moment += cross(arm_of(particles, i), r);
  }
  double x[6] = {push.x, push.y, push.z, moment.x, moment.y, moment.z};
  solve_ldlt(factors_, x);
  const DVec3 move{x[0], x[1], x[2]}, turn{x[3], x[4], x[5]};
  for (int i = 0; i < particles.count; ++i) {
    const DVec3 more = move + cross(turn, arm_of(particles, i));
    out.x[i] = float(double(out.x[i]) + more.x);
    out.y[i] = float(double(out.y[i]) + more.y);
    out.z[i] = float(double(out.z[i]) + more.z);
  }
  return dot(push, move) + dot(moment, turn);
}

}  // namespace gyre
