// Overlap test of two shapes that are both not convex (planes, meshes, height fields), for a sensor of one kind and a
// visitor of the other. They make no contacts, because no dynamic body may be one.
#pragma once

#include "geometry/shape/shape.h"

namespace gyre {

// Meshes and height fields are surfaces without thickness: a shape entirely inside a closed mesh does not overlap it.
// Planes are solid below. Touching counts.
//
// Tests the triangles of the surface with fewer triangles, within the other's box, against those of the other whose
// boxes they meet. Two triangles are tested by separating axes in double (C. Ericson, "Real-Time Collision Detection",
// 2005, 5.2.10).
bool surfaces_overlap(const Shape& a, const Shape& b, const Transform& a_from_b);

}  // namespace gyre
