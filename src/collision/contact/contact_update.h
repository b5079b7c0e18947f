// A full update of one contact by the narrow phase. Pairs that hardly moved since their last full update are recycled
// instead: see contact_recycle.h.
//
// In: the contact, its two shapes and bodies, and the view of the pair. Out: the manifolds in world axes, with the
// impulses of matched points, and with the anchors that recycling needs.
#pragma once

#include "collision/contact/contact_recycle.h"

namespace gyre {

// The smaller of two sizes, without those that are no sizes (see ColliderShape::size).
float smaller_size(float a, float b);

// Full update of a sensor's contact. Returns whether the two shapes overlap; stores no manifold.
bool test_sensor_overlap(const PairInput& pair, const PairView& view);

// Full update of any other contact. Returns whether its shapes touch. `cached`: triangles of a mesh contact, else null.
bool compute_manifold(const PairInput& pair, const PairView& view, CachedTriangles* cached);

}  // namespace gyre
