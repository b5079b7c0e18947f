// Whether two shapes that are both not convex (planes, meshes, height fields) share a point: what a sensor made of one asks
// of a visitor made of the other. They make no contacts, because no dynamic body may be one.
#pragma once

#include "geometry/shape/shape.h"

namespace gyre {

// Meshes and height fields are surfaces without thickness: what lies wholly inside a closed mesh does not overlap it. Planes are
// solid below. Touching counts.
//
// The triangles of the surface that has fewer, as far as they lie in the other's box, against those of the other whose boxes they
// meet; two triangles by the separating axis test in double (C. Ericson, "Real-Time Collision Detection", 2005, 5.2.10).
bool surfaces_overlap(const Shape& a, const Shape& b, const Transform& a_from_b);

}  // namespace gyre
