// Impacts with restitution, one sub-step at a time.
//
// A contact is hit when its points close faster than a resting contact can and would meet within the sub-step. Within a
// manifold the points answer together (Newton's law for all of them, as a small LCP); manifolds answer one after the
// other until none is closing, which hands a blow down a row of touching balls (E. Guendelman, R. Bridson, R. Fedkiw,
// "Nonconvex Rigid Bodies with Stacking", 2003). Friction acts within the blow, up to its share of the normal impulse.
//
// The speed after the blow is found from the energy of the sub-stepped motion, not from the speed that happens to stand
// at the step's boundary, so a bounce does not depend on the phase of the step or on how early the contact was seen.
// For a constant relative acceleration a (closing positive), E(u, s) = (u + a h / 2)^2 + 2 a s is what kick and drift
// conserve; the surfaces meet with speed sqrt(E). Leaving with e sqrt(E) takes the speed w for which
//   (w + a h / 2)^2 + 2 a s = e^2 E    at once, at the distance s, if the body rises that far,
//   w = a h / 2 + e sqrt(E)            after it has been set down on the surface, otherwise.
#pragma once

#include "solver/contact/contact_block.h"

#include <span>

namespace gyre {

struct ImpactPoint {
  Vec3 from_a, from_b;
  float separation = 0.0f;  // as the step began
  float force_speed = 0.0f;        // a h: closing speed that the forces of this sub-step added
  float target = 0.0f;      // separating speed asked for
  float impulse = 0.0f;     // N s, of the present blow
  bool is_hit = false;
  bool pending = false;     // to be kicked after it has been set down
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
  float threshold = 0.0f;  // m/s: slower than this nothing bounces
};

ImpactContact make_impact(const ContactConstraint& constraint);

// Before the forces of a sub-step: remembers how fast the points close.
void record_approach(std::span<ImpactContact> contacts, ContactBodies bodies);
// After the forces, before the constraints: strikes what would meet in this sub-step.
void apply_restitution(std::span<ImpactContact> contacts, ContactBodies bodies,
                       const ImpactSettings& settings);
// After the bodies have moved: kicks what has been set down.
void apply_delayed_restitution(std::span<ImpactContact> contacts, ContactBodies bodies,
                               const ImpactSettings& settings);

}  // namespace gyre
