// Free bodies in worlds whose integrator or springs are not the default: they are divided into systems that
// springs connect, and moved by the schemes of rigid/integrate/smooth_schemes.h.
//
// A system that nothing else moves takes the whole step at once. With error control it uses as many sub-steps
// as keep the estimated error below the tolerance: the difference between n and 2 n sub-steps gives the error
// of the latter (L. F. Richardson). A system with a spring to a constrained body moves sub-step by sub-step
// with it; the other end gets the scheme's impulse of the spring, with the opposite sign.
//
// In: a batch of islands after constraints were gathered (BodyFlags::touched marks constrained bodies). Out:
// motion of the free bodies, velocities of the others, sums of the springs, and Verlet's last moves.
#pragma once

#include "rigid/integrate/smooth_schemes.h"
#include "rigid/batch/solve_batch.h"

namespace gyre {

// True if the joint is a spring that is a force of the integrator instead of a solver row.
bool is_explicit_spring(const RigidWorld& w, std::uint32_t joint);

struct SmoothMotion {
  RigidWorld* world = nullptr;
  MotionSettings settings;
  std::span<SmoothSystem> systems{};
  std::span<SchemeRoom> rooms{};         // of each
  std::span<SchemeRoom> second_rooms{};  // for the same step with twice the sub-steps; empty without error
                                         // control
  std::span<std::uint32_t> substeps_used{};
  std::span<double> errors{};       // m, estimated, of the step
  std::span<SmoothSpring> loose{};  // with no end in a system
  int substeps = 0;
  double h = 0.0;     // s, a sub-step
  double time = 0.0;  // s since the step began, of the present sub-step
  bool any_carried = false;

  int count() const { return int(systems.size()); }
};

// All free bodies of the batch, also kinematic ones with springs: these are marked as read in each sub-step.
SmoothMotion find_smooth_motion(RigidWorld& w, const SolveBatch& batch,
                                std::span<const std::uint32_t> body_indices, int substeps, float h,
                                Arena& arena);

// Stages of the sub-step program; a block is a system.
// Once, before all sub-steps, and after them.
void move_spring_systems(const SmoothMotion& motion, int begin, int end);
void finish_spring_systems(const SmoothMotion& motion, int begin, int end);
// In each sub-step, before its forces: the systems with a spring to what constraints act on; then the impulses of those springs on the
// other ends, in one block.
void move_coupled_spring_systems(const SmoothMotion& motion, int begin, int end);
void apply_spring_impulses(SmoothMotion& motion, int begin, int end);

// Stores the impulses of springs in their joints, and the error control in the report.
void finish_springs(RigidWorld& w, const SmoothMotion& motion, StepStats& report);

}  // namespace gyre
