// Adaptive steps: finds the first impact in a tried step and resolves impacts at their times.
//
// In adaptive steps a contact acts only while its shapes touch and do not separate. Other contacts are inactive:
// their shapes are apart or separating. The step is tried without inactive contacts. The motion of the bodies then
// gives the time of the first impact, and the step is repeated with that length. Shapes that touch and close get
// impulses at that moment (solver/contact/impact.h), one contact after the other until none closes, so an impact
// propagates through a row of touching balls.
//
// The time of impact is found by conservative advancement on the linear motion of the tried step
// (collision/continuous/time_of_impact.h), then corrected by the deviation of bodies under constant acceleration from
// it. A contact that separates and returns within the step ends the piece at its turning point; after that it is
// apart like any other pair.
// Meshes and height fields are excluded: their contacts act as in a fixed step.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"
#include "solver/contact/impact.h"

namespace gyre {

// A copy of all that a tried step changes.
class StepCheckpoint {
 public:
  void save(const RigidWorld& w);
  void restore(RigidWorld& w) const;
  const BodyMotion& motion(std::uint32_t body) const { return motion_[body]; }

 private:
  Array<BodyMotion> motion_;
  Array<BodyInertia> inertia_;
  Array<Quat> orientations_;
  Array<BodyFlags> flags_;
  Array<LastMove> moves_;
  PagedArray<Manifold, 64> manifolds_;
  Array<JointRecord> joints_;
  Array<JointDetail> details_;
  RigidSettings settings_;
};

struct ImpactScratch {
  StepCheckpoint before;
  Array<BodyMotion> other;  // the result with half the sub-steps
  Array<ImpactContact> impacts;
  Array<std::uint32_t> contacts;    // of each impact: its contact
  Array<std::uint8_t> is_hit;       // of each impact: reported as a hit event
  Array<std::uint32_t> hit_bodies;  // bodies that got an impulse
};

// The distance at which shapes count as touching, m, from the size of their contact.
inline float touch_distance(const Contact& contact) { return 1.0e-5f * contact.size; }

// Resolves impacts of touching shapes that close faster than `threshold` (m/s); their bodies are listed in
// ImpactScratch::hit_bodies. Contacts without restitution are left to the solver. True if there was an impact.
bool resolve_impacts(RigidWorld& w, ImpactScratch& scratch, float threshold);

// Finds the inactive contacts (RigidWorld::inactive_contacts): shapes that are apart, or separate faster than
// `threshold` (m/s).
void list_inactive_contacts(RigidWorld& w, float threshold);

// The time of the first impact, or turning point, of inactive contacts within the tried step of `seconds`, s from its
// beginning; kNoImpact if there is none.
constexpr double kNoImpact = 1.0e30;
struct FirstImpact {
  double time = kNoImpact;
  bool is_turning_point = false;
};
FirstImpact find_first_impact(const RigidWorld& w, const StepCheckpoint& before, double seconds);

}  // namespace gyre
