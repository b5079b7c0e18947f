// Moves the points of rolling contacts within a step.
//
// Manifolds are found once a step. Until the next one the contact point of a ball stays below its centre, that of a disc runs round its
// rim, and the point on the other shape goes with it: neither stays where it was, nor moves with the material. Fixed points are an error of
// first order in the step, which tilts a coin that rolls in a circle, and changes the speed of a body that rolls on a rotating one.
//
// A point of a curved shape is, from its body's centre of mass,
//   r = R core + reach u + rest
// R core is fixed in the body (a ball's centre, a point of a capsule's segment or of a cylinder's axis), and u is the unit vector towards
// the other shape: the normal, or for cylinders and cones its component at a right angle to their axis. This is exact on a plane for any
// rotation. Speeds are taken in the middle of a sub-step, separations at its beginning.
//
// A contact that carries a body alone is advanced in each half-step, where every share of its energy counts: a coin rolls on for minutes. A
// body held from several sides has its contacts advanced once, to the middle of the step. This is of second order, too, at an eighth of the
// cost, for there may be thousands. Fixed points would keep heaps awake.
//
// A fast-spinning body, which rotates by a large angle in a step, has its contacts advanced in each half-step whatever its shape: a corner
// moves with the body, and meets the inertia of that moment. With arms and inertia from the start of the step, an impulse that should stop
// the point could speed it up. Source of the idea: the rolling equations of D. Montana, "The kinematics of contact and grasp", 1988.
#pragma once

#include "base/arena/arena.h"
#include "rigid/solve/contact_lists.h"
#include "rigid/store/rigid_world.h"
#include "task/task_system.h"

namespace gyre {

struct RollingPoint {
  Vec3 first_arm;                 // m, of the curved body as the step began
  float first_separation = 0.0f;  // separation of the point then
  Vec3 core;                      // m, body frame
  float reach = 0.0f;
  Vec3 rest;  // m, world axes: half the separation, and rounding
  bool on_rim = false;
};

// The bodies of a contact of a curved shape with a flat one, or of a fast-spinning body.
struct RollingSides {
  std::uint32_t constraint = 0;
  std::int32_t body = kNoBody;  // the curved or fast-spinning one
  std::int32_t other = kNoBody;
  float side = 1.0f;  // 1 if it is the constraint's b, else -1
  bool once = false;  // held from several sides: the point is set once, to the middle of the step
  Vec3 center;        // shape's centre from the body's centre of mass, body frame
};
struct RollingContact : RollingSides {
  Vec3 axis;     // body frame, unit: axis of symmetry
  Vec3 outward;  // world axes: the normal, out of the curved shape
  Vec3 offset;   // m, from the other body's centre of mass to the curved one's, as the step began
  RollingPoint points[kMaxManifoldPoints];
  int count = 0;        // of points
  bool on_rim = false;  // any point on the rim
  AdvancedArms arms;    // at the last advance
  Vec3 drift;  // rad/s: change of the angular velocity by free rotation until the middle of the sub-step
};

// The bodies of the constraint's two sides.
inline std::int32_t body_a_of(const RollingSides& rolling) {
  return rolling.side > 0.0f ? rolling.other : rolling.body;
}
inline std::int32_t body_b_of(const RollingSides& rolling) {
  return rolling.side > 0.0f ? rolling.body : rolling.other;
}

struct RollingContacts {
  std::span<RollingContact> contacts;
  std::span<std::uint32_t> of_constraint;  // index in `contacts`, or kNotRolling
};
constexpr std::uint32_t kNotRolling = 0xffffffffu;

// The lever arm (m) that a ball's contact patch adds to spinning friction, because no point carries a ball's load. Without it a ball would
// spin for ever, and sliding friction would not know its spin (a tippe top would not turn over). 0 if several points or no ball touch.
// After P. Contensou, "Couplage entre frottement de glissement et frottement de pivotement dans la theorie de la toupie", 1963.
float contact_patch_spin_friction(const RigidWorld& w, const Contact& contact,
                                  const ContactConstraint& constraint);

// True if one of the two shapes is round and the other flat, the contact may carry load, and its manifold is not recycled. Contacts of two
// flat shapes cost no more than that test. `constraint` has its bodies and its manifold.
bool may_roll(const RigidWorld& w, const Contact& contact, const ContactConstraint& constraint);

// Finds the rolling contacts of the batch whose bodies rotate against each other, and all contacts of its fast-spinning bodies. `bodies`:
// those of the batch. Marks the bodies as read in each sub-step.
RollingContacts find_rolling_contacts(RigidWorld& w, const ContactLists& lists,
                                      std::span<const std::uint32_t> bodies, float seconds, Arena& arena,
                                      TaskSystem& tasks);

// Advances rolling.arms to a sub-step that begins now; its middle is `ahead` seconds away.
void advance_contact_point(const RigidWorld& w, RollingContact& rolling, float ahead);

}  // namespace gyre
