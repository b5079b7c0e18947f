// The context of the stages that move bodies (rigid/solve/motion_stages.h): the bodies of a batch, and blocks of the constrained ones for
// the kernels.
#pragma once

#include "rigid/field/fields.h"
#include "rigid/integrate/integrators.h"
#include "rigid/integrate/smooth_motion.h"
#include "solver/kernels/solver_kernels.h"

namespace gyre {

struct BodyMotionSolve {
  RigidWorld& w;
  const SolverKernels& kernels;
  Motions motions{};
  MotionArrays arrays{};
  std::span<MovedBody> moved{};                     // the constrained bodies of the batch
  void* blocks = nullptr;                           // the same bodies in blocks for the kernels
  std::span<Vec3> pushes{};                         // rotation of each by pushout
  int measured_blocks = 0;                          // the contact change is measured in the first blocks only
  std::span<std::uint32_t> fast_spinning{};         // bodies that the kernels do not rotate
  std::span<std::uint32_t> fast_spinning_starts{};  // by block of moved bodies: its first; one more
  std::span<std::uint32_t> free_bodies{};           // bodies without constraints
  FieldSolve fields{};
  bool is_smooth = false;  // schemes of rigid/integrate/smooth_schemes.h move free bodies
  SmoothMotion smooth{};
};

}  // namespace gyre
