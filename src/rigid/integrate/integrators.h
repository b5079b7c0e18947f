// Integration of bodies. Free bodies move over the whole step at once. Constrained bodies are moved by the
// motion kernels (solver/motion/motion_kernel.h), sub-step by sub-step between the constraints. This unit
// does what the kernels do not: their input, rotations that are fast or have locked axes, and orientations at
// the end of the step.
//
// Semi-implicit Euler (symplectic: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", I.1):
// velocities change by forces and constraints at the present pose, then the body drifts freely and exactly: x
// += h v, and torque-free rotation for the orientation. The first part changes momentum, the drift conserves
// it.
#pragma once

#include "rigid/store/body_store.h"
#include "solver/motion/motion_block.h"
#include "solver/motion/rotation_block.h"

#include <span>

namespace gyre {

// The sub-steps of a step and the forces that all of them share.
struct Motions {
  int count = 1;
  float substep = 0.0f;
  Vec3 gravity;
};

// The largest rotation in a sub-step (rad) by the kernels. Their error is of order angle^3 / 12 with
// gyroscopic torque: below the resolution of floats. Without it, the error is that of the rotation of the
// axis.
constexpr float kMaxKernelAngle = 0.01f;
constexpr float kMaxKernelAngleIsotropic = 0.1f;

// True if a body spins too fast, or has locked axes, so that rotate_exactly rotates it instead of the motion
// kernels.
inline bool needs_exact_rotation(const BodyStore& bodies, std::uint32_t body, float substep) {
  const BodyFlags& flags = bodies.flags[body];
  if (flags.type != BodyType::dynamic || flags.locked_angular != 0) return true;
  const float max_angle = bodies.masses[body].isotropic != 0 ? kMaxKernelAngleIsotropic : kMaxKernelAngle;
  return !(substep * length(bodies.motion[body].angular_velocity) <= max_angle);
}

// The input of the motion kernels for a constrained body. `pose_read`: its pose is read in each sub-step.
MovedBody describe_motion(const BodyStore& bodies, std::uint32_t body, const Motions& motions,
                          bool pose_read);

// A whole step of free bodies, kinematic ones among them.
void integrate_free_bodies(BodyStore& bodies, std::span<const std::uint32_t> list, const Motions& motions,
                           const RotationKernels& kernels);

// The rotation in a sub-step of bodies that need exact rotation.
void rotate_exactly(BodyStore& bodies, std::span<const std::uint32_t> list, float substep,
                    const RotationKernels& kernels);

// At the end of a step: orientations and world inertia of constrained bodies. `pushes`: rotation vectors of
// pushout, one for each of `moved`.
void apply_rotations(BodyStore& bodies, std::span<const MovedBody> moved, std::span<const Vec3> pushes,
                     const RotationKernels& kernels);

}  // namespace gyre
