// RigidCorrection: the rigid motion of a piece of a body that answers a residual, the coarse level of a preconditioner. A stiff body moves as a whole at once;
// its vertices' own blocks alone would bring that about over many iterations, and an early end would leave it far from its momentum.
//
// With R the six rigid motions of the piece about its centre of mass, it is R (R^T A R + R^T J^T K J R)^-1 R^T residual. The elements do not
// resist rigid motions, so R^T A R is its mass and inertia; J and K are those of soft/solver/coupled_solve.h.
//
// Source: R. Nicolaides, "Deflation of Conjugate Gradients with Applications to Boundary Value Problems", 1987.
#pragma once

#include "math/dense.h"

#include <gyre/math.h>

namespace gyre {

class RigidCorrection {
 public:
  // The particles of the piece, one after the other; then once more. Without any, the correction does nothing.
  void add_mass(double mass, DVec3 place);
  void set_center();
  void add_inertia(double mass, DVec3 place);
  bool is_on() const { return mass_ > 0.0; }
  DVec3 arm_of(DVec3 place) const { return place - center_; }

  // Only the piece's own mass and inertia from now on, then those of rows, then the factors.
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
  DVec3 motion_at(DVec3 place) const { return move_ + cross(turn_, arm_of(place)); }

 private:
  double mass_ = 0.0;
  DVec3 origin_{}, first_{}, center_{};
  double own_[6][6] = {}, sum_[6][6] = {};  // translation, rotation
  Ldlt<6, double> factors_{};
  DVec3 push_{}, moment_{}, move_{}, turn_{};
};

}  // namespace gyre
