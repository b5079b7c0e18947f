// The table of contact methods by kinds of shapes, behind collide_convex and collide_shapes
// (geometry/manifold/manifold.h). docs/collision.md shows it.
//
// Sharp boxes and hulls search axes and clip faces. Spheres and pairs of capsules have closed forms. All other convex
// pairs find the normal by GJK (separated cores) or EPA (overlapping cores) and clip the features that face each other.
// Against triangles a sphere tests seven features, polyhedra and capsules search axes, and curved shapes use GJK and
// EPA.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

enum class ContactMethod : std::uint8_t {
  none,            // neither shape is convex
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

// The method for two shapes. Boxes with rounding take `cores` instead of `boxes` and `polyhedra`.
ContactMethod contact_method(const Shape& a, const Shape& b);

}  // namespace gyre
