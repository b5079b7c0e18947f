// Which of four triangles certainly lie too far from a shape, by directions that the search for the best one (mesh_axis.h) knows
// as well: what is found apart here it would find apart too, only later.
//
// Balls and capsules: along the ways from the triangle's sides to the ends of the core; capsules also along those from its corners
// to the core, and across pairs of edges. Boxes: before their faces and across pairs of edges; hulls: before their faces. All by their squares, without a root.
#pragma once

#include "geometry/mesh_axis.h"

namespace gyre {

// Seen from the shape's origin; of a double-sided surface the side on which the shape's middle lies.
struct TriangleLanes {
  static constexpr int kLanes = PlacedConvex::kLanes;
  Vec3W<kLanes> corner[3], normal;
  Wide<kLanes> reach;  // the largest coordinate in the surface's frame, of corners and shape
};

// How far a search's own roundings may lie beside those here, and how much deeper than its lowest corner a shape may rest on a face.
Wide<TriangleLanes::kLanes> apart_slack(const TriangleLanes& triangles, const PlacedConvex& convex);

// Whether the surfaces lie more than `max_separation` apart; false only means that it is not known.
Mask<TriangleLanes::kLanes> is_apart(const TriangleLanes& triangles, const PlacedConvex& convex,
                                     float max_separation);

}  // namespace gyre
