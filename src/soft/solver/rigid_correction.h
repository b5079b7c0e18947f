// RigidCorrection: the rigid motion of a piece of a body that answers a residual, the coarse level of a preconditioner. A stiff body moves as a whole at once;
// its vertices' own blocks alone would bring that about over many iterations, and an early end would leave it far from its momentum.
//
// With R the six rigid motions of the piece about its centre of mass, it is R (R^T A R + R^T J^T K J R)^-1 R^T residual. The elements do not
// resist rigid motions, so R^T A R is its mass and inertia, but for those of the linear law, which resist rotations when they have turned; J and K are those of soft/solver/coupled_solve.h.
//
// Source: R. Nicolaides, "Deflation of Conjugate Gradients with Applications to Boundary Value Problems", 1987.
#pragma once

#include "math/dense.h"

#include <gyre/math.h>

namespace gyre {

// Adds the inertia m, kg, of a point that moves by `share` V + W x arm to the lower triangle of the matrix of V and W.
void add_point_inertia(const Sym3& m, double share, DVec3 arm, double (&sum)[6][6]);

class RigidCorrection {
 public:
  // The particles of the piece, one after the other; then once more. Without any, the correction does nothing.
  void add_mass(double mass, DVec3 place);
  void set_center();
  void add_inertia(double mass, DVec3 place);
  // The resistance of the elements to a rotation about one of the axes: the answer of a particle to that rotation of all.
  static DVec3 rotation(int axis, DVec3 arm) {
    return cross(DVec3{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0}, arm);
  }
  void clear_rotations();
  void add_rotation(int axis, DVec3 product, DVec3 place);
  bool is_on() const { return mass_ > 0.0; }
  DVec3 arm_of(DVec3 place) const { return place - center_; }

  // How a point that moves by `share` times the piece's translation and by its rotation times `arm` answers an impulse, of the factors that are there, 1/kg.
  Sym3 compliance(double share, DVec3 arm) const;

  // The piece's own mass and inertia are there.
  void factor_own();
  // Only these from now on, then those of rows, then the factors.
  void clear_rows();
  // A row resists by `inertia`, kg, at a point that moves by `share` times the piece's translation and by its rotation times `arm`.
  void add_row(const Sym3& inertia, double share, DVec3 arm);
  // The inertia that a particle carries counts as the piece's own.
  void add_carried(const Sym3& inertia, DVec3 place);
  void factor();

  // The residual of all particles; then the motion that answers it, and its work.
  void clear_residual() { push_ = moment_ = {}; }
  void add_residual(DVec3 residual, DVec3 place) {
    push_ += residual;
    moment_ += cross(arm_of(place), residual);
  }
  double solve();
  // The energy, twice, of the motion that the residual would give the piece without the rows.
  double energy_of_residual() const;
  DVec3 motion_at(DVec3 place) const { return move_ + cross(turn_, arm_of(place)); }

 private:
  double mass_ = 0.0;
  DVec3 origin_{}, first_{}, center_{};
  double own_[6][6] = {}, sum_[6][6] = {};  // translation, rotation
  Ldlt<6, double> factors_{}, own_factors_{};
  DVec3 push_{}, moment_{}, move_{}, turn_{};
};

}  // namespace gyre
