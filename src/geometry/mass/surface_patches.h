// The surface of a convex shape as flat patches, for drag.
//
// In: a shape, and a plane; the surface above it is excluded. Out: positions, outward normals and areas, in the shape's
// frame. Boxes and hulls give each face as triangles from its centre, each with the three points that integrate a
// quadratic exactly; the plane cuts faces exactly. Round shapes give rings of sixteen patches with exact areas; a patch
// that the plane cuts counts by the fraction of its height below.
//
// projected_area is the area of the shadow of the shape along a direction, in closed form. Sums over the patches of
// round shapes deviate from it by up to a few percent and are scaled to it.
#pragma once

#include "base/function_ref.h"
#include "geometry/shape/shape.h"

namespace gyre {

struct SurfacePatch {
  DVec3 position;     // m
  DVec3 normal;       // unit, outward
  double area = 0.0;  // m^2
};

// All patches below {p : dot(normal, p) = level}; kUnbounded gives the whole surface. Convex kinds only.
void for_each_patch(const Shape& shape, DVec3 normal, double level,
                    FunctionRef<void(const SurfacePatch&)> fn);

// The area (m^2) of the shape's shadow along the unit vector `direction`. Convex kinds only.
double projected_area(const Shape& shape, DVec3 direction);

}  // namespace gyre
