// Restitution of impacts, one sub-step at a time.
//
// A contact is hit when its points close faster than those of a resting contact and would touch within the
// sub-step. Within a manifold the points are solved together (Newton's law for all of them, as a small LCP).
// Manifolds follow one after the other until none closes, which propagates an impulse down a row of touching
// balls (E. Guendelman, R. Bridson, R. Fedkiw, "Nonconvex Rigid Bodies with Stacking", 2003). Friction acts
// within the impact, up to its share of the normal impulse.
//
// The speed after the impact follows from the energy of the sub-stepped motion, not from the speed at the
// boundary of the step. So a bounce does not depend on the phase of the step or on how early the contact was
// found. For a constant relative acceleration a (closing positive), semi-implicit Euler conserves E(u, s) =
// (u + a h / 2)^2 + 2 a s; the surfaces meet with speed sqrt(E). For a rebound speed of e sqrt(E) the
// separating speed w obeys (w + a h / 2)^2 + 2 a s' = e^2 E.
//
// The bodies meet after the time t = s / closing speed of the sub-step. They move on from there with the new velocities: an
// impulse that changes a velocity by dv also moves the body by -t dv. So s' = -t w, and neither momentum nor its moment depends
// on where in a sub-step they meet. Bodies with joints stay where they are: s' = s.
#pragma once

#include "base/function_ref.h"
#include "solver/contact/contact_block.h"

#include <span>

namespace gyre {

struct ImpactPoint {
  Vec3 from_a, from_b;
  float separation = 0.0f;  // as the step began
  float target = 0.0f;      // target of the separating speed
  float time = 0.0f;        // s, from the beginning of the sub-step until the surfaces meet
  float impulse = 0.0f;     // N s, of the present impact
  bool is_hit = false;
};

struct ImpactContact {
  Manifold* manifold = nullptr;
  std::int32_t body_a = kNoBody;
  std::int32_t body_b = kNoBody;
  float restitution = 0.0f;
  float friction = 0.0f;
  Vec3 normal;
  std::int32_t count = 0;
  ImpactPoint points[kMaxManifoldPoints];
  std::uint32_t constraint = 0;  // index
  bool speculative = false;      // its features are found anew before it bounces
  bool has_joint = false;        // bounces at once: a body may not be moved away from its joints
  // Before the forces of a sub-step: velocities, of B's centre against A's, and angular; after them: what they changed.
  Vec3 linear, angular_a, angular_b;
};

struct ImpactSettings {
  float substep = 0.0f;
  float threshold = 0.0f;  // m/s: slower impacts do not bounce
};

ImpactContact make_impact(const ContactConstraint& constraint, std::uint32_t index);
// Takes normal and points of the manifold.
void read_manifold(ImpactContact& contact);

// Before the forces of a sub-step: records the velocities of both bodies.
void record_approach(std::span<ImpactContact> contacts, ContactBodies bodies);
// Finds the features of a contact where its shapes meet within the sub-step; false if they do not meet.
using FindMeeting = FunctionRef<bool(ImpactContact&)>;
// After the forces, before the constraints: applies impulses to points that would touch in this sub-step.
void apply_restitution(std::span<ImpactContact> contacts, ContactBodies bodies,
                       const ImpactSettings& settings, FindMeeting find_meeting);

}  // namespace gyre
