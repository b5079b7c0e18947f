// Which method makes the manifolds of which two shapes: the table behind collide_convex and collide_shapes
// (geometry/manifold/manifold.h), which docs/collision.md shows.
//
// Sharp boxes and hulls take an axis search and clip faces; spheres and pairs of capsules have closed forms; everything
// else that is convex finds the normal by GJK (cores apart) or EPA (cores overlapping) and clips the features that face each
// other. On triangles a sphere has seven features, polyhedra and capsules search axes, and what is curved takes GJK and EPA.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

enum class ContactMethod : std::uint8_t {
  none,            // two shapes of which neither is convex
  round,           // closed form (manifold_round)
  boxes,           // two boxes (manifold_box)
  polyhedra,       // box or hull against hull (manifold_hull)
  cores,           // GJK, EPA and support faces (manifold_core)
  plane,           // the lowest points (manifold)
  seven_features,  // a sphere on triangles (manifold_mesh with sphere_triangle)
  axes,            // a polyhedron or capsule on triangles (manifold_mesh with mesh_axis)
  nearest,         // a cylinder or cone on triangles (the same, by GJK and EPA)
};
constexpr int kContactMethodCount = 9;
const char* to_string(ContactMethod method);

// What serves two shapes. Boxes with rounding take `cores` instead of `boxes` and `polyhedra`.
ContactMethod contact_method(const Shape& a, const Shape& b);

}  // namespace gyre
