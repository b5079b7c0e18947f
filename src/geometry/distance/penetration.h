// How deep two overlapping cores lie in each other, and along which direction they part most easily.
//
// In: the pair and the simplex with which GJK found the overlap. Out: depth, normal, and the two points that touch last.
// Works for every pair of convex cores; for two polyhedra geometry/distance/separating_axis.h is exact and faster.
//
// The polytope grows from any tetrahedron inside B - A; faces are ranked by their signed distance from the origin, so the
// origin may lie on or slightly outside a face (shapes that only touch) and the search still ends at the best direction.
// Memory is bounded and on the stack; when it is full the best direction so far is the answer, and it is always one along
// which moving the shapes by the depth parts them.
//
// Source: G. van den Bergen, "Proximity Queries and Penetration Depth Computation on 3D Game Objects", 2001 (EPA).
#pragma once

#include "geometry/distance/gjk.h"

namespace gyre {

struct CorePenetration {
  double depth = 0.0;  // moving B by depth * normal parts the cores; negative if they are apart after all
  DVec3 normal;        // unit, from A to B
  DVec3 on_a, on_b;    // A's frame; on_a - on_b = depth * normal
  int iterations = 0;
};

CorePenetration core_penetration(const CorePair& pair, const CoreDistance& start);

}  // namespace gyre
