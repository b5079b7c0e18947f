// Triangles that have no say in the contacts of a ball, known without a search for its direction (mesh_axis.h).
//
// Where a ball lies over what is beyond one of a triangle's edges or corners, what is nearest is a point of that edge or corner, and the
// direction from there is no normal of the surface: it would be found, wait for others, and come to nothing.
#pragma once

#include "geometry/mesh_axis.h"

namespace gyre {

// `ball`: a core of one point, before the triangle's plane. False only means that it is not known.
bool is_ball_beside(const Surface& surface, const NearTriangle& triangle, const PlacedConvex& ball,
                    float face_separation);

}  // namespace gyre
