#include "soft/solver/rigid_modes.h"

#include "math/dense.h"

namespace gyre {

namespace {

DVec3 row_of(const VectorRows& rows, int i) {
  return {double(rows.x[i]), double(rows.y[i]), double(rows.z[i])};
}

// The angular velocity that gives the angular momentum `momentum` with the inertia [xx, yy, zz, xy, xz, yz]. About an axis in which all
// mass lies there is none.
DVec3 turn_of(const double (&inertia)[6], DVec3 momentum) {
  const double matrix[3][3] = {{inertia[0], inertia[3], inertia[4]},
                               {inertia[3], inertia[1], inertia[5]},
                               {inertia[4], inertia[5], inertia[2]}};
  const Ldlt<3, double> factors = factor_ldlt(matrix, 1.0e-9);
  double turn[3] = {momentum.x, momentum.y, momentum.z};
  solve_ldlt(factors, turn);
  return {turn[0], turn[1], turn[2]};
}

}  // namespace

void keep_momentum(const Particles& particles, const VectorRows& impulses, const VectorRows& change,
                   double ahead, DVec3 moment) {
  double mass = 0.0;
  DVec3 first{}, linear{};
  const DVec3 origin = particles.count > 0 ? particles.place(0) : DVec3{};
  const auto place = [&](int i) {
    return ahead == 0.0 ? particles.place(i)
                        : particles.place(i) + ahead * (DVec3(particles.velocity(i)) + row_of(change, i));
  };
  for (int i = 0; i < particles.count; ++i) {
    const double m = double(particles.mass[i]);
    mass += m;
    first += m * (place(i) - origin);
    linear += row_of(impulses, i) - m * row_of(change, i);
  }
  if (!(mass > 0.0)) return;
  const DVec3 center = origin + first / mass;
  double inertia[6] = {};
  DVec3 angular = moment;
  for (int i = 0; i < particles.count; ++i) {
    const double m = double(particles.mass[i]);
    const DVec3 arm = place(i) - center;
    inertia[0] += m * (arm.y * arm.y + arm.z * arm.z);
    inertia[1] += m * (arm.x * arm.x + arm.z * arm.z);
    inertia[2] += m * (arm.x * arm.x + arm.y * arm.y);
    inertia[3] -= m * arm.x * arm.y;
    inertia[4] -= m * arm.x * arm.z;
    inertia[5] -= m * arm.y * arm.z;
    angular += cross(arm, row_of(impulses, i) - m * row_of(change, i));
  }
  const DVec3 push = linear / mass, turn = turn_of(inertia, angular);
  for (int i = 0; i < particles.count; ++i) {
    const DVec3 more = push + cross(turn, place(i) - center);
    change.x[i] = float(double(change.x[i]) + more.x);
    change.y[i] = float(double(change.y[i]) + more.y);
    change.z[i] = float(double(change.z[i]) + more.z);
  }
}

void keep_linear_momentum(const Particles& particles, std::span<const CarriedInertia> carried,
                          const VectorRows& impulses, const VectorRows& change) {
  double mass[3][3] = {};
  DVec3 linear{};
  for (int i = 0; i < particles.count; ++i) {
    const double m = double(particles.mass[i]);
    for (int k = 0; k < 3; ++k) mass[k][k] += m;
    linear += row_of(impulses, i) - m * row_of(change, i);
  }
  for (const CarriedInertia& one : carried) {
    const Sym3& m = one.inertia;
    const float rows[3][3] = {{m.xx, m.xy, m.xz}, {m.xy, m.yy, m.yz}, {m.xz, m.yz, m.zz}};
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) mass[r][c] += double(rows[r][c]);
    linear = linear - DVec3(m * to_float(row_of(change, one.particle)));
  }
  double push[3] = {linear.x, linear.y, linear.z};
  solve_ldlt(factor_ldlt(mass), push);
  for (int i = 0; i < particles.count; ++i) {
    change.x[i] = float(double(change.x[i]) + push[0]);
    change.y[i] = float(double(change.y[i]) + push[1]);
    change.z[i] = float(double(change.z[i]) + push[2]);
  }
}

}  // namespace gyre
