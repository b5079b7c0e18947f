#include "soft/solver/rigid_correction.h"

namespace gyre {

namespace {

// A direction of rotation in which all mass lies on a line has no inertia; it is left out.
constexpr double kMinPivot = 1.0e-9;

}  // namespace

void RigidCorrection::add_mass(double mass, DVec3 place) {
  if (mass_ == 0.0) origin_ = place;
  mass_ += mass;
  first_ += mass * (place - origin_);
}

void RigidCorrection::set_center() {
  if (mass_ > 0.0) center_ = origin_ + first_ / mass_;
  for (int k = 0; k < 3; ++k) own_[k][k] = mass_;
}

void RigidCorrection::add_inertia(double mass, DVec3 place) {
  const DVec3 r = arm_of(place);
  own_[3][3] += mass * (r.y * r.y + r.z * r.z);
  own_[4][4] += mass * (r.x * r.x + r.z * r.z);
  own_[5][5] += mass * (r.x * r.x + r.y * r.y);
  own_[4][3] -= mass * r.x * r.y;
  own_[5][3] -= mass * r.x * r.z;
  own_[5][4] -= mass * r.y * r.z;
}

void RigidCorrection::clear_rotations() {
  for (int i = 3; i < 6; ++i)
    for (int j = 3; j < 6; ++j) own_[i][j] = 0.0;
}

void RigidCorrection::add_rotation(int axis, DVec3 product, DVec3 place) {
  for (int other = axis; other < 3; ++other)
    own_[3 + other][3 + axis] += dot(rotation(other, arm_of(place)), product);
}

void RigidCorrection::clear_rows() {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) sum_[i][j] = own_[i][j];
}

void add_point_inertia(const Sym3& m, double share, DVec3 arm, double (&sum)[6][6]) {
  // The velocity of the point is share V + W x arm; its three components, as rows over V and W:
  const double move[3][6] = {
      {share, 0, 0, 0, arm.z, -arm.y}, {0, share, 0, -arm.z, 0, arm.x}, {0, 0, share, arm.y, -arm.x, 0}};
  const double inertia[3][3] = {{double(m.xx), double(m.xy), double(m.xz)},
                                {double(m.xy), double(m.yy), double(m.yz)},
                                {double(m.xz), double(m.yz), double(m.zz)}};
  for (int i = 0; i < 6; ++i) {
    double pull[3];
    for (int k = 0; k < 3; ++k)
      pull[k] = inertia[k][0] * move[0][i] + inertia[k][1] * move[1][i] + inertia[k][2] * move[2][i];
    for (int j = 0; j <= i; ++j)
      sum[i][j] += pull[0] * move[0][j] + pull[1] * move[1][j] + pull[2] * move[2][j];
  }
}

void RigidCorrection::add_row(const Sym3& inertia, double share, DVec3 arm) {
  add_point_inertia(inertia, share, arm, sum_);
}

void RigidCorrection::add_carried(const Sym3& inertia, DVec3 place) {
  add_point_inertia(inertia, 1.0, arm_of(place), own_);
}

void RigidCorrection::factor_own() { own_factors_ = factor_ldlt(own_, kMinPivot); }
double RigidCorrection::energy_of_residual() const {
  double x[6] = {push_.x, push_.y, push_.z, moment_.x, moment_.y, moment_.z};
  solve_ldlt(own_factors_, x);
  return dot(push_, DVec3{x[0], x[1], x[2]}) + dot(moment_, DVec3{x[3], x[4], x[5]});
}

void RigidCorrection::factor() { factors_ = factor_ldlt(sum_, kMinPivot); }

Sym3 RigidCorrection::compliance(double share, DVec3 arm) const {
  double columns[3][3];
  for (int axis = 0; axis < 3; ++axis) {
    const DVec3 unit{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
    const DVec3 moment = cross(arm, unit);
    double x[6] = {share * unit.x, share * unit.y, share * unit.z, moment.x, moment.y, moment.z};
    solve_ldlt(own_factors_, x);
    const DVec3 moves = DVec3{share * x[0], share * x[1], share * x[2]} + cross(DVec3{x[3], x[4], x[5]}, arm);
    columns[axis][0] = moves.x, columns[axis][1] = moves.y, columns[axis][2] = moves.z;
  }
  return {float(columns[0][0]), float(columns[1][1]), float(columns[2][2]),
          float(columns[0][1]), float(columns[0][2]), float(columns[1][2])};
}

double RigidCorrection::solve() {
  double x[6] = {push_.x, push_.y, push_.z, moment_.x, moment_.y, moment_.z};
  solve_ldlt(factors_, x);
  move_ = {x[0], x[1], x[2]}, turn_ = {x[3], x[4], x[5]};
  return dot(push_, move_) + dot(moment_, turn_);
}

}  // namespace gyre
