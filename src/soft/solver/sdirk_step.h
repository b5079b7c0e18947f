// The two stages of a sub-step by the singly diagonally implicit scheme of second order that damps stiff oscillations as backward Euler does and
// slow ones hardly at all. Each stage is a backward Euler step of c h from a start that moves on between them, c = 1 - 1 / sqrt(2):
//
//   y1 = x + c h k1,   y2 = x + (1 - c) h k1 + c h k2,   x' = y2,   k = what the time derivative is at the end of a stage
//
// A mode of angular frequency w keeps sqrt(1 - (c w h)^4 / (1 + (c w h)^2)^2) of its amplitude in a sub-step: with w h = 0.1 it loses
// 3.7e-7 where backward Euler loses 5e-3. The scheme has no memory of steps before, so contacts, pins and steps of any length leave its order.
//
// In: particles as a sub-step finds them. Out: particles as the second stage finds them, with all that it needs told.
//
// Source: R. Alexander, "Diagonally Implicit Runge-Kutta Methods for Stiff O.D.E.'s", SIAM J. Numer. Anal. 14, 1977.
#pragma once

#include "base/arena/arena.h"
#include "soft/body/soft_body.h"

#include <span>

namespace gyre {

constexpr double kSdirkShare = 0.29289321881345248;  // c

// Results of the stages for the end of the sub-step. Their memory is the arena's.
struct SdirkStages {
  std::span<DVec3> place;             // m, when the sub-step began; empty: there are no stages
  std::span<Vec3> velocity;           // m/s, when the sub-step began
  std::span<DVec3> told;              // m, of held particles in their order: where they are at the end
  std::span<Vec3> found;              // m/s, after the second stage, before impulses
  std::span<CarriedInertia> carried;  // for the second stage
  std::span<Vec3> outside;            // N, by carried inertia: the force on its particle from outside

  bool empty() const { return place.empty(); }
};

// Begins a sub-step: held particles go the share of the first stage of their way.
SdirkStages begin_sdirk(SoftBody& body, std::span<const CarriedInertia> carried, Arena& arena);
// After the first stage has moved the particles: where the second one starts.
void turn_sdirk(SoftBody& body, SdirkStages& stages);
// After the second stage has found its velocities.
void end_sdirk(const SoftBody& body, SdirkStages& stages);
// Impulses since then act for the whole sub-step. The stage has moved the particles by its own share of it; this is the rest. `step`: of the sub-step, s.
// (Of ropes RopeStep::move says it.)
void move_by_impulses(SoftBody& body, const SdirkStages& stages, double step);

}  // namespace gyre
