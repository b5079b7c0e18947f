// One contact brought up to date by a full look through the narrow phase. What has hardly moved since its last one need not
// be looked at: see contact_recycle.h.
//
// In: the contact, its two shapes and bodies, how far to look. Out: the contact's manifolds, in world axes, with the
// impulses of the points that were there before, and with anchors from which they are found again.
#pragma once

#include "collision/contact/contact_recycle.h"

namespace gyre {

// The smaller of two sizes, of those that are sizes at all (see ColliderShape::size).
float smaller_size(float a, float b);

// Full look of a sensor's contact: whether the two shapes overlap. Keeps no manifold.
bool test_sensor_overlap(const ContactPair& pair, const View& view);

// Full look of any other contact; returns whether its shapes touch. `kept`: of a contact with a mesh, else null.
bool compute_manifold(const ContactPair& pair, const View& view, CachedTriangles* cached);

}  // namespace gyre
