// The submerged part of a convex shape below a plane, for buoyancy.
//
// In: a shape and a plane in the shape's frame. Out: the volume and its centre, and the area, centre and spread of the
// cut (the waterplane), in the same frame. Everything is in double.
//
// Boxes and hulls are exact: sums of tetrahedra from a point of the plane, so that the cut itself adds nothing. A
// sphere is a cap in closed form. Slices of a capsule, cylinder or cone across the axis are discs from which a line
// cuts a segment; their integral along the axis is a Gauss-Legendre sum in pieces, each substituted so that it has no
// root at its ends. Its error is below 1e-8 of the whole volume. A rounded box is the sharp one of the same extents,
// scaled to its own volume.
//
// Sources: B. Mirtich, "Fast and Accurate Computation of Polyhedral Mass Properties", 1996 (integrals over polyhedra);
// E. Catto, "Exact Buoyancy for Polyhedra", Game Programming Gems 6, 2006 (a point of the plane as apex); textbook
// segments of circles.
#pragma once

#include "geometry/mass/mass.h"
#include "geometry/shape/shape.h"

namespace gyre {

struct SubmergedPart {
  double volume = 0.0;  // m^3
  DVec3 center;         // of the volume; without meaning if that is 0
  double area = 0.0;    // m^2, of the cut; 0 if the plane does not cut the shape
  DVec3 area_center;
  SecondMoments spread;  // m^4, of the cut about its centre
};

// The part of the shape with dot(normal, p) < level. `normal` has length 1. Empty for kinds that are not convex.
SubmergedPart submerged_part(const Shape& shape, DVec3 normal, double level);

// The whole volume (m^3) of a convex kind.
double volume_of(const Shape& shape);

}  // namespace gyre
