// CoupledRigid: a rigid body in a coupled solve (soft/solver/coupled_solve.h): its mass and inertia, how it answers impulses together with the rows that push it, and
// its part of the vectors of the iterations.
#pragma once

#include "math/dense.h"

#include <gyre/math.h>

namespace gyre {

struct RigidInertia {
  Vec3 inverse_mass{};     // 1/kg, along each axis of the world; 0: it does not move along it
  Sym3 inverse_inertia{};  // 1/(kg m^2), world axes
};

// A velocity (m/s, rad/s) or an impulse (N s, N m s) of a rigid body.
struct RigidVector {
  DVec3 linear{}, angular{};
};
inline double dot(const RigidVector& a, const RigidVector& b) {
  return dot(a.linear, b.linear) + dot(a.angular, b.angular);
}
inline RigidVector operator*(double scale, const RigidVector& a) {
  return {scale * a.linear, scale * a.angular};
}
inline RigidVector operator+(const RigidVector& a, const RigidVector& b) {
  return {a.linear + b.linear, a.angular + b.angular};
}

class CoupledRigid {
 public:
  RigidVector residual, last, answer, direction, product;

  void set(const RigidInertia& inertia);
  // How a point answers an impulse, 1/kg.
  Sym3 compliance(Vec3 arm) const;
  // Gives it the impulse -p at a point.
  void push(Vec3 arm, Vec3 impulse) {
    residual.linear = residual.linear - DVec3(impulse);
    residual.angular = residual.angular - cross(DVec3(arm), DVec3(impulse));
  }
  // How fast the direction moves a point.
  Vec3 way_of(Vec3 arm) const { return to_float(direction.linear + cross(direction.angular, DVec3(arm))); }
  // Only its own mass and inertia from now on, then those of rows, then the factors.
  void clear_rows();
  void add_row(const Sym3& inertia, Vec3 arm);
  void factor();
  // Sets the answer to the residual; the residual times it.
  double precondition();
  // Sets the product of its mass and inertia and the direction; the direction times it.
  double apply();

 private:
  RigidInertia inertia_;
  double own_[6][6] = {}, sum_[6][6] = {};
  Ldlt<6, double> factors_{};
};

}  // namespace gyre
