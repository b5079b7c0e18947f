// One sub-step of a soft body by linearised backward Euler:
//
//   (M + s K) d = h (f + M g) - s K v - M d0 ...,   s = h^2 + h beta,   v' = v + d,   x' = x + h v'
//
// with K the stiffness of the elements, projected to be positive semi-definite, and beta the damping; what tension does to its own direction
// has the scale h^2 alone, since turning is not damped. The system is solved by conjugate gradients, preconditioned by the inverse of
// each particle's own block. Sums are taken in a fixed order, so the bits do not depend on the number of threads or the width.
//
// Iterations end when the energy of the error, as the last ones show it, is below the square of `tolerance` times that of the change that gravity
// and the forces ask for; at least `least_iterations` are made and at most `most_iterations`.
//
// A body that is held nowhere and carries nothing keeps its momentum: at the end the change of velocity is made to have exactly the linear and angular momentum
// that the forces from outside give, by a rigid motion. So both are right at any number of iterations. (Backward Euler itself loses angular
// momentum, since it turns along the tangent.)
//
// The implicit midpoint rule is the same system with other scales: s = h^2 / 4 + h beta / 2, and x' = x + h (v + d / 2). It keeps the
// energy of small oscillations.
//
// Sources: D. Baraff, A. Witkin, "Large Steps in Cloth Simulation", 1998; M. Hestenes, E. Stiefel, "Methods of Conjugate Gradients", 1952.
#pragma once

#include "base/arena/arena.h"
#include "soft/body/soft_body.h"
#include "soft/kernels/soft_kernels.h"
#include "task/task_system.h"

namespace gyre {

enum class ImplicitScheme : std::uint8_t { backward_euler, midpoint };

struct ImplicitSettings {
  float step = 0.0f;  // s
  Vec3 gravity{};     // m/s^2
  ImplicitScheme scheme = ImplicitScheme::backward_euler;
  float tolerance = 1.0e-2f;
  int least_iterations = 3;
  int most_iterations = 50;
  // Errors are measured against at least this share of the change that gravity makes in the sub-step.
  float rest_share = 1.0f;
  std::span<const CarriedInertia> carried{};
  // A stage of a scheme of several (soft/solver/sdirk_step.h): the elements give no moment where the stage ends, as they do in truth, so that the scheme keeps
  // its order. Else the moment where the sub-step begins is none, with which backward Euler keeps angular momentum.
  bool is_stage = false;
};

struct ImplicitReport {
  int iterations = 0;
  float residual = 0.0f;  // at the end, over what it was measured against
};

// A sub-step between its parts. Its memory is the arena's.
struct ImplicitStep {
  SoftPass pass;
  std::span<const CarriedInertia> carried{};
  ImplicitReport report;
};

// False if the elements resist a rotation of the whole body: by the linear law, once it has turned.
bool knows_rotations(const SoftBody& body);
// Finds the velocities at the end of the sub-step, as if nothing touched the body.
ImplicitStep begin_implicit(SoftBody& body, const ImplicitSettings& settings, const SoftKernels& kernels,
                            Arena& arena, TaskSystem& tasks);
// How a particle's velocity answers an impulse on it, its neighbours held still: the inverse of its block of A, 1/kg; zero if it is held.
Sym3 inverse_mass(const ImplicitStep& step, int particle);
// Moves the particles with the velocities that they have now.
void finish_implicit(SoftBody& body, const ImplicitStep& step, const SoftKernels& kernels, TaskSystem& tasks);

// All of a sub-step of a body that touches nothing.
ImplicitReport step_implicit(SoftBody& body, const ImplicitSettings& settings, const SoftKernels& kernels,
                             Arena& arena, TaskSystem& tasks);

}  // namespace gyre
