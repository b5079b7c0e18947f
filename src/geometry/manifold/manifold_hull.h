// Manifold of two sharp polyhedra (boxes and hulls): finds the best axis, then clips the faces that meet along it, or
// computes the crossing of two edges.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

// As collide_convex, for hulls and boxes of rounding 0.
void collide_polyhedra(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                       PairCache& cache, LocalManifold& out);

}  // namespace gyre
