// One contact brought up to date: a full look through the narrow phase, or, where the two bodies have hardly moved against
// each other since then, the old points found again from their anchors (recycling).
//
// In: the contact, its two shapes and bodies, how far to look. Out: the contact's manifolds, in world axes, with the
// impulses of the points that were there before.
//
// Recycling. Let T be the rigid motion of B in A's body frame since the last full look. The point of B at an anchor moves
// by d = T(p) - p, so the separation there changes by dot(d, n) and the point midway by d / 2. With the features that meet
// unchanged this leaves out only products of the slide and the tilt. Where B is a core swept by a ball on something flat
// (a ball, a capsule), p is the core's point above the contact, the contact goes with it by the whole of d, and so follows
// what rolls exactly; where that is A, the two change places. Motion is always measured from the last FULL look, so errors
// do not add up.
#pragma once

#include "collision/collide.h"
#include "collision/contact_store.h"

namespace gyre {

// The two sides of a contact.
struct ContactPair {
  const ColliderShape* shape_a;
  const ColliderShape* shape_b;
  const BodyLook* look_a;
  const BodyLook* look_b;
  Vec3 center_a, center_b;  // centres of mass, body frames
};

// The smaller of two sizes, of those that are sizes at all (see ColliderShape::size).
float smaller_size(float a, float b);

// Full look of a sensor's contact: whether the two shapes overlap. Keeps no manifold.
bool look_at_sensor(Contact& contact, const ContactPair& pair);

// Brings the manifolds of a contact up to date; returns whether its shapes touch.
bool update_contact(ContactStore& store, Contact& contact, const ContactPair& pair, bool may_recycle);

}  // namespace gyre
