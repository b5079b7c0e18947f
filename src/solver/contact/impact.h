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
// separating speed w is
//
// (w + a h / 2)^2 + 2 a s = e^2 E at once, at the distance s, if the body rises that far,
//
// w = a h / 2 + e sqrt(E) delayed until the body has reached the surface, otherwise.
#pragma once

#include "solver/contact/contact_block.h"

#include <span>

namespace gyre {

struct ImpactPoint {
  Vec3 from_a, from_b;
  float separation = 0.0f;  // as the step began
  float force_speed = 0.0f;  // a h: closing speed added by the forces of this sub-step
  float target = 0.0f;       // target of the separating speed
  float impulse = 0.0f;      // N s, of the present impact
  bool is_hit = false;
  bool pending = false;  // restitution is delayed until the body has reached the surface
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
};

struct ImpactSettings {
  float substep = 0.0f;
  float threshold = 0.0f;  // m/s: slower impacts do not bounce
};

ImpactContact make_impact(const ContactConstraint& constraint);

// Before the forces of a sub-step: records the closing speed of the points.
void record_approach(std::span<ImpactContact> contacts, ContactBodies bodies);
// After the forces, before the constraints: applies impulses to points that would touch in this sub-step.
void apply_restitution(std::span<ImpactContact> contacts, ContactBodies bodies,
                       const ImpactSettings& settings);
// After the bodies have moved: applies delayed restitution.
void apply_delayed_restitution(std::span<ImpactContact> contacts, ContactBodies bodies,
                               const ImpactSettings& settings);

}  // namespace gyre
