// A sub-step of any rope, cloth or solid in four parts, so that contacts can act between them: begin() finds the velocities at the end of the
// sub-step as if nothing touched it; what impulses change of them is found by the solvers of contacts (soft/solver/coupled_solve.h; respond_rope()); add_change() adds
// such a change; finish() moves the particles. Ropes are solved exactly (soft/solver/rope_step.h), other implicit bodies by conjugate gradients (implicit_step.h), explicit ones
// answer with their masses alone (explicit_step.h). The scheme of two stages (sdirk_step.h) makes the first of them and all but the moves of
// the second in begin().
#pragma once

#include "soft/solver/implicit_step.h"
#include "soft/solver/rope_step.h"
#include "soft/solver/sdirk_step.h"
#include "soft/store/soft_store.h"

namespace gyre {

enum class SoftMethod : std::uint8_t { conjugate_gradients, rope, explicit_scheme };

struct SoftStepSettings {
  float step = 0.0f;                          // s
  Vec3 gravity{};                             // m/s^2
  std::span<const CarriedInertia> carried{};  // its memory must last as long as the sub-step
  bool touches = false;                 // a shape is near: a sub-step of sdirk2 is one of backward Euler
  bool asks_for_inverse_masses = true;  // false: inverse_mass() is not called in the sub-step
};

// Memory of the sub-step is the arena's.
struct SoftStep {
  SoftMethod method = SoftMethod::conjugate_gradients;
  float h = 0.0f;  // s
  std::span<const CarriedInertia> carried{};
  ImplicitStep implicit;
  RopeStep rope;
  SdirkStages stages;  // of the scheme of two stages
};

SoftStep begin_soft_step(SoftEntry& entry, const SoftStepSettings& settings, const SoftKernels& kernels,
                         Arena& arena, TaskSystem& tasks);
// How a particle's velocity answers an impulse on it, 1/kg; zero if it is held. Of a rope: all of it moves along; else its neighbours are held
// still, which is too little.
Sym3 inverse_mass(const SoftEntry& entry, const SoftStep& step, std::uint32_t particle);
// Adds `scale` times a change of velocity of all particles; of a rope, the one that respond_rope() found last.
void add_change(SoftEntry& entry, SoftStep& step, std::span<const Vec3> change, float scale);
void finish_soft_step(SoftEntry& entry, SoftStep& step, const SoftKernels& kernels, TaskSystem& tasks);

}  // namespace gyre
