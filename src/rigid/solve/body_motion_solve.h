// What the stages that move bodies (rigid/solve/motion_stages.h) work on: the bodies of a batch, those that constraints act on as the
// kernels want them.
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
  std::span<MovedBody> moved{};  // the batch's bodies that constraints act on,
  void* blocks = nullptr;        // the same for the kernels,
  std::span<Vec3> pushes{};      // and how overlap turned them
  int measured_blocks = 0;       // the first: of these somebody asks for the velocity change by contacts
  std::span<std::uint32_t> fast_spinning{};         // those whose rotation the kernels leave alone
  std::span<std::uint32_t> fast_spinning_starts{};  // by block of moved bodies: its first; one more
  std::span<std::uint32_t> free_bodies{};           // no constraint acts on them
  FieldSolve fields{};
  bool is_smooth = false;  // free bodies are moved by the schemes of rigid/integrate/smooth_schemes.h
  SmoothMotion smooth{};
};

}  // namespace gyre
