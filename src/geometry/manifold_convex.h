// Which method makes the manifolds of which two convex kinds: the table behind collide_convex (geometry/manifold.h).
//
// Sharp boxes and hulls take an axis search and clip faces; spheres and pairs of capsules have closed forms; everything
// else finds the normal by GJK (cores apart) or EPA (cores overlapping) and clips the features that face each other.
#pragma once

#include "geometry/manifold.h"

namespace gyre {

enum class ConvexMethod : std::uint8_t {
  round,      // closed form (manifold_round)
  boxes,      // two boxes (manifold_box)
  polyhedra,  // box or hull against hull (manifold_hull)
  cores,      // GJK, EPA and support faces
};
const char* to_string(ConvexMethod method);

// What serves two convex kinds. Boxes with rounding take `cores` instead of `boxes` and `polyhedra`.
ConvexMethod convex_method(ShapeKind a, ShapeKind b);

}  // namespace gyre
