// Contacts of soft bodies with each other and with rigid bodies, solved together with the stiffness of the soft bodies and the inertia of the rigid ones. The change of velocity d minimises
//
//   1/2 d.A d - b.d + sum over rows of psi(u + J d)
//
// with A the matrices of the soft bodies' own steps and the mass and inertia of rigid ones, b impulses that they have not answered yet, J d the change of a row's relative velocity u,
// and psi the augmented Lagrangian of a row. The derivative of psi is minus the impulse
//
//   p_n = max(0, l_n + along (target - u_n)),   p_t = l_t - across u_t, at most the friction times l_n
//
// with l the row's impulse at the start of a stage. Of a row that holds, nothing bounds these: it is a bilateral constraint of all three directions. This is convex and piecewise quadratic, and is minimised by nonlinear conjugate gradients
// with exact line searches: each iteration takes one product with A, as one of a linear system does. The preconditioner is the inverse of each vertex's own
// block of A and of the rows that push, and the rigid motion of each body that nothing holds (soft/solver/rigid_correction.h). The impulses where a stage ends begin the next one; what a row misses falls by its resistance in each.
//
// Energy never rises: each iteration lowers what is minimised, which is the energy that d adds to the bodies.
//
// Sources: E. Polak, G. Ribiere, "Note sur la convergence de methodes de directions conjuguees", 1969; M. Hestenes, "Multiplier and Gradient Methods", 1969;
// P. Alart, A. Curnier, "A Mixed Formulation for Frictional Contact Problems Prone to Newton like Solution Methods", 1991; E. Todorov, "Convex and
// Analytically-Invertible Dynamics with Contacts and Constraints", 2014 (conjugate gradients on velocities for contacts).
#pragma once

#include "soft/contact/coupling_row.h"
#include "soft/solver/coupled_rigid.h"
#include "soft/solver/implicit_step.h"

#include <cstdint>
#include <span>

namespace gyre {

// One of the bodies. Its vertices are `first`, first + 1, ..., where the next one's begin.
struct CoupledBody {
  const SoftBody* body = nullptr;
  const ImplicitStep* step = nullptr;  // null: it has an explicit scheme, and answers with its masses
  std::span<const CarriedInertia> carried{};
  std::uint32_t first = 0;
};

// Of all bodies, by vertex.
struct CoupledVertices {
  std::span<const Sym3>
      blocks;  // 1/kg: how a vertex answers an impulse, its neighbours held still; zero where it is held
  std::span<const Vec3> velocities;  // m/s, when the solve begins
  // N s. In: those that the velocities do not have yet. Out: these, and the changes of the rows' impulses.
  std::span<Vec3> impulses;
  std::span<Vec3> change;  // m/s: out
};

struct CoupledSettings {
  int least_stages = 2, most_stages = 8;
  int most_iterations = 300;  // in a stage
  // A stage ends when the energy of the error is so small a share of what vertices have by the speeds that their rows take.
  double tolerance = 1.0e-2;
  float rest_speed = 0.0f;  // m/s: the least of these speeds; what is slower is at rest
};

struct CoupledReport {
  int stages = 0, iterations = 0;
  bool met = true;  // no row misses its target by more than it is allowed to
};

// Finds the change of all velocities and the impulses of the rows. Bodies that nothing holds have exactly the momentum of their impulses. Rigid bodies get theirs from
// the caller, by the impulses.
CoupledReport solve_coupled(std::span<const CoupledBody> bodies, std::span<const RigidInertia> rigid,
                            std::span<CouplingRow> rows, const CoupledVertices& vertices,
                            const CoupledSettings& settings, const SoftKernels& kernels, Arena& arena,
                            TaskSystem& tasks);

}  // namespace gyre
