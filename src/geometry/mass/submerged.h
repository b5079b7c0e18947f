// How much of a convex shape lies below a plane, and where: what buoyancy is made of.
//
// In: a shape and a plane in the shape's frame. Out: volume and centre of the part below, and area, centre and spread of the
// cut (the waterplane), in the same frame. All in double.
//
// Boxes and hulls: exact, as sums of tetrahedra from a point of the plane, so that the cut itself adds nothing. Sphere: the cap
// in closed form. Capsule, cylinder and cone: slices across the axis are discs of which a line cuts off a segment, exact again;
// their integral along the axis is Gauss-Legendre's in pieces, each substituted so that it has no root at its ends: within 1e-8
// of the whole volume. A rounded box counts as the sharp one of the same extents, scaled to the volume that it has.
//
// Sources: B. Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties", 1996 (integrals over polyhedra); E. Catto,
// "Exact Buoyancy for Polyhedra", Game Programming Gems 6, 2006 (a point of the plane as apex); textbook segments of circles.
#pragma once

#include "geometry/mass/mass.h"
#include "geometry/shape/shape.h"

namespace gyre {

struct SubmergedPart {
  double volume = 0.0;  // m^3
  DVec3 center;         // of the volume; of no use where that is 0
  double area = 0.0;    // m^2, of the cut; 0 where the plane does not cut the shape
  DVec3 area_center;
  SecondMoments spread;  // m^4, of the cut about its centre
};

// The part of the shape for which dot(normal, p) < level. `normal` has length 1. Nothing for kinds that are not convex.
SubmergedPart submerged_part(const Shape& shape, DVec3 normal, double level);

// The whole volume (m^3) of a convex kind.
double volume_of(const Shape& shape);

}  // namespace gyre
