// Where a triangle comes nearest to a convex shape, or is deepest in it, away from its corners.
//
// The signed distance to a convex shape is a convex function, whose slope is the unit normal. So a distance with its normal bounds the distance all over the triangle
// from below, and a descent along the triangle finds the least one. All kinds of convex shapes are searched alike, by find_point_distance.
//
// Source: S. Boyd, L. Vandenberghe, "Convex Optimization", 2004 (subgradients; alternating projection).
#pragma once

#include "geometry/query/point_query.h"

namespace gyre {

struct FaceDistance {
  double weight[3] = {};  // of the corners: the point of the triangle
  double distance = 0.0;  // m, negative inside
  DVec3
      normal;  // unit, out of the shape at the point; of a point inside it is that of the shape's nearest face
  DVec3 on_surface;  // m, of the shape
};

// True for shapes that are convex and bounded.
bool has_face_distance(const Shape& shape);

// Returns false if no point is nearer to the shape than `max_distance`, or none is nearer by more than `least_depth` (m) than all corners.
bool find_face_distance(const Shape& shape, const DVec3 (&corner)[3], double max_distance, double least_depth,
                        FaceDistance& out);

// Where a corner or an edge of the triangles of a mesh or height field comes nearest to the face between its corners, or is farthest through it: no farther
// away than `reach`. The outside is that of the triangle. The normal is that of the face. Returns false if none is nearer than `limit`.
bool find_surface_features(const Shape& surface, const DVec3 (&corner)[3], double reach, double limit,
                           FaceDistance& out);

}  // namespace gyre
