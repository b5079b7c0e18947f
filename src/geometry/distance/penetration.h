// Penetration depth of two overlapping cores, by EPA.
//
// In: the pair, and the simplex with which GJK found the overlap. Out: the depth, the normal, and the two points that
// touch last when the cores move apart along it. Works for every pair of convex cores; for two polyhedra
// geometry/distance/separating_axis.h is exact and faster.
//
// The polytope grows from any tetrahedron inside B - A. Faces are ranked by their signed distance from the origin, so
// the origin may lie on a face or slightly outside (shapes that only touch), and the search still ends at the best
// direction. The memory is bounded and on the stack. When it is full, the answer is the best direction so far; moving
// the shapes by the depth along it always separates them.
//
// Source: G. van den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects", 2001 (EPA).
#pragma once

#include "geometry/distance/gjk.h"

namespace gyre {

struct CorePenetration {
  double depth = 0.0;  // moving B by depth * normal separates the cores; negative if they do not overlap
  DVec3 normal;        // unit, from A to B
  DVec3 on_a, on_b;    // in A's frame; on_a - on_b = depth * normal
  int iterations = 0;
};

CorePenetration core_penetration(const CorePair& pair, const CoreDistance& start);

}  // namespace gyre
