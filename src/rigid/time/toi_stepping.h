// Impacts at their times: which pairs meet first in a step that was tried, and what happens to those that have met.
//
// In adaptive steps a contact acts only while its shapes touch and do not part. The others wait: they are apart, or part from each
// other. A step is tried with them left out; the bodies' motion then tells when the first two of them meet, and the step is done
// again as long as that. Shapes that have met, and close, are struck at that moment (solver/contact/impact.h): one blow after the other until
// none closes, which hands it down a row of balls in touch.
//
// The time: the motion of the tried step, taken as straight and even, by conservative advancement (collision/continuous/time_of_impact.h); then
// put right by how far bodies at their mean acceleration are from that straight way then. What parts and would be back within the step
// is cut at the turn between: from there on it is apart like any other pair.
// Meshes and height fields are no part of this: their contacts act as in a fixed step.
#pragma once

#include "base/arena/arena.h"
#include "rigid/store/rigid_world.h"
#include "solver/contact/impact.h"

namespace gyre {

// What a tried step changes, to take it back.
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
  Array<BodyMotion> other;  // what the step was with half the sub-steps
  Array<ImpactContact> impacts;
  Array<std::uint32_t> contacts;   // of each
  Array<std::uint8_t> is_hit;     // of each: to be told as a hit
  Array<std::uint32_t> hit_bodies;  // bodies
};

// How near shapes are that touch, m, by the size of their contact.
inline float touch_distance(const Contact& contact) { return 1.0e-5f * contact.size; }

// Strikes what touches and closes faster than `threshold` (m/s), and says whom: ImpactScratch::struck. What has no restitution is left to
// the solver. Returns whether there was anything.
bool resolve_impacts(RigidWorld& w, ImpactScratch& scratch, float threshold);

// Says which contacts wait (RigidWorld::waiting): those apart, and those that part faster than `threshold`.
void list_inactive_contacts(RigidWorld& w, float threshold);

// When the first of those that wait meet within the step of `seconds` that was tried, or a turn must be waited for; s from its
// beginning. kNoImpact if none do.
constexpr double kNoImpact = 1.0e30;
struct FirstImpact {
  double time = kNoImpact;
  bool is_turning_point = false;
};
FirstImpact find_first_impact(const RigidWorld& w, const StepCheckpoint& before, double seconds);

}  // namespace gyre
