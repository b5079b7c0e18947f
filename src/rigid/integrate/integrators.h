// Moving bodies. Those that no constraint acts on fly: the whole step at once. The others are moved by the motion kernels
// (solver/motion/motion_kernel.h), sub-step by sub-step between the constraints; here is what they do not do: the description of a
// body for them, rotations that are fast or bound to axes, and orientations at the end of the step.
//
// Semi-implicit Euler (symplectic: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", I.1): a kick by
// forces and constraints at the present place, then the exact drift of a free body: x += h v, and torque-free rotation
// for the orientation. The kick changes momentum, the drift keeps it.
#pragma once

#include "rigid/store/body_store.h"
#include "solver/motion/motion_block.h"
#include "solver/motion/rotation_block.h"

#include <span>

namespace gyre {

// The sub-steps of a step and what acts in all of them.
struct Motions {
  int count = 1;
  float substep = 0.0f;
  Vec3 gravity;
};

// The fastest turn in a sub-step (rad) that the kernels make. Their error is of order angle^3 / 12 where there is a
// gyroscopic torque: below a float's resolution. Without one it is that of how fast the axis itself turns.
constexpr float kMaxKernelAngle = 0.01f;
constexpr float kMaxKernelAngleIsotropic = 0.1f;

// Whether a body spins so fast, or is so bound, that the motion kernels leave its rotation to rotate_exactly.
inline bool needs_exact_rotation(const BodyStore& bodies, std::uint32_t body, float substep) {
  const BodyFlags& flags = bodies.flags[body];
  if (flags.type != BodyType::dynamic || flags.locked_angular != 0) return true;
  const float max_angle = bodies.masses[body].isotropic != 0 ? kMaxKernelAngleIsotropic : kMaxKernelAngle;
  return !(substep * length(bodies.motion[body].angular_velocity) <= max_angle);
}

// A body of which constraints are made, as the motion kernels want it. `shown`: somebody looks at its place in each sub-step.
MovedBody describe_motion(const BodyStore& bodies, std::uint32_t body, const Motions& motions, bool pose_read);

// A whole step of bodies that no constraint acts on, kinematic ones among them.
void integrate_free_bodies(BodyStore& bodies, std::span<const std::uint32_t> list, const Motions& motions,
                           const RotationKernels& kernels);

// The rotation of a sub-step of bodies that turn alone.
void rotate_exactly(BodyStore& bodies, std::span<const std::uint32_t> list, float substep,
                    const RotationKernels& kernels);

// At the end of a step: orientations and world inertia of the bodies of which constraints were made. `pushes` (rotation
// vectors, one for each of `moved`) are the turns by which overlap was pushed apart.
void apply_rotations(BodyStore& bodies, std::span<const MovedBody> moved, std::span<const Vec3> pushes,
                     const RotationKernels& kernels);

}  // namespace gyre
