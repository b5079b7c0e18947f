// Where the points of contacts that roll are within a step.
//
// Manifolds are found once a step. Until the next one a ball's point of contact stays below its centre, that of a disc runs
// round its rim, and the point on what they roll on goes with it: neither stays where it was, nor goes with the material. To
// leave them behind is an error of the first order in the step, which tilts a coin that rolls in a circle and slows or speeds
// what rolls on something that turns.
//
// A point of a curved shape is, from its body's centre of mass,
//   r = R core + reach u + rest
// with R core fixed in the body (a ball's centre, a point of a capsule's segment or of a cylinder's axis), and u the unit vector
// towards the other shape: the normal, or for cylinders and cones the part of it at a right angle to their axis. All of it is
// exact on a plane, however far the body turns. Speeds are taken in the middle of a sub-step, separations at its beginning.
//
// What one contact bears alone is followed in each part of a step: there every share of its energy counts, for a coin rolls on for
// minutes. What is held from several sides, and there may be thousands of those, is taken along once, to where its contact is in
// the middle of the step: of the second order too, at an eighth of the cost. To leave these where they were keeps heaps awake.
// What whirls, by a good part of a turn in a step, is followed in each part whatever its shape: a corner goes with the body, and the inertia
// that it meets is that of by then. Where the step began, both were another body's, and what stopped it there could speed it up.
// Source of the idea: the rolling equations of D. Montana, "The kinematics of contact and grasp", 1988.
#pragma once

#include "rigid/solve/solve_step.h"

namespace gyre {

struct RollingPoint {
  Vec3 first_arm;                 // m, as the step began: of the curved body,
  float first_separation = 0.0f;  // and how far the point was from the other one
  Vec3 core;                      // m, body frame
  float reach = 0.0f;
  Vec3 rest;  // m, world axes: half the gap, and rounding
  bool on_rim = false;
};

// Who rolls on whom in a contact of a curved shape with a flat one, or whirls beside what.
struct RollingSides {
  std::uint32_t constraint = 0;
  std::int32_t body = kNoBody;  // that is curved, or whirls
  std::int32_t other = kNoBody;
  float side = 1.0f;  // 1 if it is the constraint's b, else -1
  bool once = false;  // held from several sides: it stays where it is in the middle of the step
  Vec3 center;        // of the shape from the body's centre of mass, body frame
};
struct RollingContact : RollingSides {
  Vec3 axis;     // body frame, unit: of symmetry
  Vec3 outward;  // world axes: the normal, out of the curved shape
  Vec3 offset;   // m, from the other body's centre of mass to the curved one's, as the step began
  RollingPoint points[kMaxManifoldPoints];
  int count = 0;        // of them
  bool on_rim = false;  // some of them
  AdvancedArms arms;    // as last followed
  Vec3
      drift;  // rad/s: what free rotation adds to the body's angular velocity until the middle of the sub-step
};

// Whose the constraint's two sides are.
inline std::int32_t body_a_of(const RollingSides& rolling) {
  return rolling.side > 0.0f ? rolling.other : rolling.body;
}
inline std::int32_t body_b_of(const RollingSides& rolling) {
  return rolling.side > 0.0f ? rolling.body : rolling.other;
}

struct RollingContacts {
  std::span<RollingContact> contacts;
  std::span<std::uint32_t> of_constraint;  // its place among them; kNotRolling
};
constexpr std::uint32_t kNotRolling = 0xffffffffu;

// What a ball's patch of contact adds to the spinning friction (m), as a ball's load is never borne by a point: otherwise it
// would spin for ever, and friction against sliding would not know that the ball spins (a tippe top would not turn over).
// 0 where more than one point or no ball touches. After P. Contensou, "Couplage entre frottement de glissement et frottement
// de pivotement dans la theorie de la toupie", 1963.
float contact_patch_spin_friction(const RigidWorld& w, const Contact& contact,
                                  const ContactConstraint& constraint);

// Whether one of the two shapes is round and the other flat, and what holds them apart is looked at anew: of what is flat all
// through no contact is, and nothing more is asked. `constraint` has its bodies and its manifold.
bool may_roll(const RigidWorld& w, const Contact& contact, const ContactConstraint& constraint);

// Those among the constraints of the batch, which has these bodies, that may roll and whose bodies turn against each other, and all of what
// whirls. Marks these bodies as ones whose place others look at.
RollingContacts find_rolling_contacts(RigidWorld& w, const BatchScratch& scratch,
                                      std::span<const std::uint32_t> bodies, float seconds, Arena& arena,
                                      TaskSystem& tasks);

// Into its arms: where the contact is in a sub-step that begins now, with its middle in `ahead` seconds.
void advance_contact_point(const RigidWorld& w, RollingContact& rolling, float ahead);

}  // namespace gyre
