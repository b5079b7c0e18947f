// One contact brought up to date by a full look through the narrow phase. What has hardly moved since its last one need not
// be looked at: see contact_recycle.h.
//
// In: the contact, its two shapes and bodies, how far to look. Out: the contact's manifolds, in world axes, with the
// impulses of the points that were there before, and with anchors from which they are found again.
#pragma once

#include "collision/contact_recycle.h"

namespace gyre {

// The two sides of a contact.
struct ContactPair {
  const ColliderShape* shape_a;
  const ColliderShape* shape_b;
  const BodyLook* look_a;
  const BodyLook* look_b;
  Vec3 center_a, center_b;  // centres of mass, body frames
};

// Full look of a sensor's contact: whether the two shapes overlap. Keeps no manifold.
bool look_at_sensor(Contact& contact, const ContactPair& pair);

// Full look of any other contact; returns whether its shapes touch.
bool look_anew(ContactStore& store, Contact& contact, const ContactPair& pair, const View& view);

}  // namespace gyre
