// Early rejection of triangles that cannot give a contact of a ball or capsule, without a search for the direction
// (mesh_axis.h).
//
// If such a shape lies beyond one of the edges or corners of a triangle, the closest point is on that edge or corner.
// If the direction from there is no normal of the surface, the search would find it, defer the triangle and drop it.

#pragma once

#include "geometry/manifold_mesh/mesh_axis.h"

namespace gyre {

// True if the triangle certainly gives no contact. The centre of the core must lie before the plane of the triangle.
// Always false for other shapes.
bool is_round_rejected(const Surface& surface, const LocalTriangle& triangle, const LocalConvex& round,
                       float face_separation);

}  // namespace gyre
