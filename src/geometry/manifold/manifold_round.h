// Contacts of round shapes in closed form: spheres with every convex shape, capsules with capsules.
//
// In: two shapes, the pose of B in A's frame, and the largest separation. Out: one point with the exact normal (two for
// parallel capsules). If no direction is closest, as deep inside, the normal is some fixed unit vector.
//
// Source: C. Ericson, "Real-Time Collision Detection", 2005, chapter 5.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

// True if collide_round serves two kinds, in either order.
constexpr bool is_round_pair(ShapeKind a, ShapeKind b) {
  return a == ShapeKind::sphere || b == ShapeKind::sphere ||
         (a == ShapeKind::capsule && b == ShapeKind::capsule);
}

void collide_round(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out);

}  // namespace gyre
