// Bodies that no contact or joint acts on, where the world's integrator or springs are not the default: they are parted into
// systems that springs couple, and moved by the schemes of rigid/integrate/smooth_schemes.h.
//
// A system that nothing else moves does the whole step at once; where the time plan says so with as many parts as keep the
// estimated error below the tolerance: the step is done with n parts and with 2 n, whose difference tells the error of the latter
// (L. F. Richardson), until that is small enough. A system with a spring to a body that constraints act on moves part by part
// with it; the other end takes the impulse that the scheme made of the spring, with the opposite sign.
//
// In: a batch of islands after constraints were gathered (BodyFlags::touched says who is free). Out: motion of the free bodies,
// velocities of the others, sums of the springs, and Verlet's last moves.
#pragma once

#include "rigid/integrate/smooth_schemes.h"
#include "rigid/batch/solve_batches.h"

namespace gyre {

// Whether the joint is a spring that is a force to the integrator and none of the solver's rows.
bool is_explicit_spring(const RigidWorld& w, std::uint32_t joint);

struct SmoothMotion {
  RigidWorld* world = nullptr;
  MotionSettings settings;
  std::span<SmoothSystem> systems{};
  std::span<SchemeRoom> rooms{};         // of each
  std::span<SchemeRoom> second_rooms{};  // for the same step with twice the parts; empty if parts are fixed
  std::span<std::uint32_t> substeps_used{};
  std::span<double> errors{};       // m, estimated, of the step
  std::span<SmoothSpring> loose{};  // with no end in a system
  int substeps = 0;
  double h = 0.0;     // s, a part
  double time = 0.0;  // s since the step began, of the part at hand
  bool any_carried = false;

  int count() const { return int(systems.size()); }
};

// All free bodies of the batch, also kinematic ones with springs: those are marked as shown to the solver.
SmoothMotion find_smooth_motion(RigidWorld& w, const SolveBatch& batch, std::span<const std::uint32_t> body_indices,
                                int substeps, float h, Arena& arena);

// Stages of the program of sub-steps, a block being a system; the context is the SmoothMotion.
void move_smooth_stage(void* context, int begin, int end, int worker);    // once, before all parts
void move_carried_stage(void* context, int begin, int end, int worker);   // in each part, before its forces
void kick_carriers_stage(void* context, int begin, int end, int worker);  // after that; one block
void finish_smooth_stage(void* context, int begin, int end, int worker);  // once, after all parts

// What springs gave, into their joints; what the plan did, into the report.
void finish_springs(RigidWorld& w, const SmoothMotion& motion, StepReport& report);

}  // namespace gyre
