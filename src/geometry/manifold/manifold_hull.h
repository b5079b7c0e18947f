// Contacts of sharp polyhedra (boxes and hulls): the best axis, then the faces that meet along it cut against each other,
// or the crossing of two edges.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

// Two shapes out of hulls and boxes of rounding 0, as collide_convex.
void collide_polyhedra(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                       PairCache& cache, LocalManifold& out);

}  // namespace gyre
