// Triangles that have no say in the contacts of a ball or capsule, known without a search for its direction (mesh_axis.h).
//
// Where such a shape lies over what is beyond one of a triangle's edges or corners, what is nearest is a point of that edge or corner, and
// the direction from there is no normal of the surface: it would be found, wait for others, and come to nothing.

#pragma once

#include "geometry/manifold_mesh/mesh_axis.h"

namespace gyre {

// The core's middle must lie before the triangle's plane. False only means that it is not known, as of every other shape.
bool is_round_rejected(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& round,
                     float face_separation);

}  // namespace gyre
