// Contacts of round shapes in closed form: spheres with everything convex, capsules with each other.
//
// In: two shapes, where B is in A's frame, and how far apart they may be. Out: one point with the exact normal (for
// capsules lying side by side, two). Deep inside, where no direction is nearest, some fixed unit normal is taken.
//
// Source: C. Ericson, "Real-Time Collision Detection", 2005, chapter 5.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

// Whether collide_round answers for two kinds (in either order).
constexpr bool is_round_pair(ShapeKind a, ShapeKind b) {
  return a == ShapeKind::sphere || b == ShapeKind::sphere ||
         (a == ShapeKind::capsule && b == ShapeKind::capsule);
}

void collide_round(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out);

}  // namespace gyre
