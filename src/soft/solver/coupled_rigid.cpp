#include "soft/solver/coupled_rigid.h"

#include "soft/solver/rigid_correction.h"

namespace gyre {

namespace {

// The compliance of an axis that is locked, as a share of the largest one: below what rounding of the others shows.
constexpr double kLockedShare = 1.0e-9;

// The inverse of a compliance that may have locked axes. Without any it is one of which nothing moves.
void invert(double (&m)[3][3]) {
  double largest = m[0][0] + m[1][1] + m[2][2];
  if (!(largest > 0.0)) largest = kLockedShare;
  for (int k = 0; k < 3; ++k) m[k][k] += kLockedShare * largest;
  const Ldlt<3, double> factors = factor_ldlt(m);
  for (int column = 0; column < 3; ++column) {
    double unit[3] = {column == 0 ? 1.0 : 0.0, column == 1 ? 1.0 : 0.0, column == 2 ? 1.0 : 0.0};
    solve_ldlt(factors, unit);
    for (int row = 0; row < 3; ++row) m[row][column] = unit[row];
  }
}

}  // namespace

void CoupledRigid::set(const RigidInertia& inertia) {
  inertia_ = inertia;
  double mass[3][3] = {{double(inertia.inverse_mass.x), 0.0, 0.0},
                       {0.0, double(inertia.inverse_mass.y), 0.0},
                       {0.0, 0.0, double(inertia.inverse_mass.z)}};
  const Sym3& turn = inertia.inverse_inertia;
  double turning[3][3] = {{double(turn.xx), double(turn.xy), double(turn.xz)},
                          {double(turn.xy), double(turn.yy), double(turn.yz)},
                          {double(turn.xz), double(turn.yz), double(turn.zz)}};
  invert(mass), invert(turning);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      own_[i][j] = mass[i][j], own_[i + 3][j + 3] = turning[i][j];
      own_[i][j + 3] = own_[i + 3][j] = 0.0;
    }
  }
}

Sym3 CoupledRigid::compliance(Vec3 arm) const {
  const auto turning = [&](Vec3 axis) { return cross(inertia_.inverse_inertia * cross(arm, axis), arm); };
  const Vec3 x = turning({1, 0, 0}), y = turning({0, 1, 0}), z = turning({0, 0, 1});
  const Vec3& m = inertia_.inverse_mass;
  return {m.x + x.x, m.y + y.y, m.z + z.z, x.y, x.z, y.z};
}

void CoupledRigid::clear_rows() {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) sum_[i][j] = own_[i][j];
}

void CoupledRigid::add_row(const Sym3& inertia, Vec3 arm) {
  add_point_inertia(inertia, 1.0, DVec3(arm), sum_);
}

void CoupledRigid::factor() { factors_ = factor_ldlt(sum_); }

double CoupledRigid::precondition() {
  double x[6] = {residual.linear.x,  residual.linear.y,  residual.linear.z,
                 residual.angular.x, residual.angular.y, residual.angular.z};
  solve_ldlt(factors_, x);
  answer = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}};
  return dot(residual, answer);
}

double CoupledRigid::apply() {
  const double x[6] = {direction.linear.x,  direction.linear.y,  direction.linear.z,
                       direction.angular.x, direction.angular.y, direction.angular.z};
  double out[6] = {};
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) out[i] += own_[i][j] * x[j];
  product = {{out[0], out[1], out[2]}, {out[3], out[4], out[5]}};
  return dot(direction, product);
}

}  // namespace gyre
