// RigidCorrection: the rigid motion of a body that answers a residual, the coarse level of a preconditioner. A stiff body moves as a whole at once;
// its vertices' own blocks alone would bring that about over many iterations, and an early end would leave it far from its momentum.
//
// With R the six rigid motions of the body about its centre of mass, it is R (R^T A R + R^T J^T K J R)^-1 R^T residual. The elements do not
// resist rigid motions, so R^T A R is the body's mass and inertia; J and K are those of soft/solver/coupled_solve.h.
//
// Source: R. Nicolaides, "Deflation of Conjugate Gradients with Applications to Boundary Value Problems", 1987.
#pragma once

#include "math/dense.h"
#include "soft/body/soft_body.h"
#include "soft/kernels/soft_kernels.h"

namespace gyre {

class RigidCorrection {
 public:
  // Before it, and where a body has no mass, the correction does nothing.
  void begin(const Particles& particles);
  bool is_on() const { return is_on_; }
  // Only the body's own mass and inertia from now on, then those of rows, then the factors.
  void clear_rows();
  // A row whose point moves by `share` times the body's translation and by its rotation times `arm`.
  void add_row(Vec3 normal, float along, float across, double share, DVec3 arm);
  void factor();
  // Where a vertex is, from the centre of mass.
  DVec3 arm_of(const Particles& particles, int i) const { return particles.place(i) - center_; }
  // Adds the correction; returns the work of the residual on it.
  double add(const Particles& particles, const VectorRows& residual, const VectorRows& out) const;

 private:
  bool is_on_ = false;
  DVec3 center_{};
  double own_[6][6] = {}, sum_[6][6] = {};  // translation, rotation
  Ldlt<6, double> factors_{};
};

}  // namespace gyre
