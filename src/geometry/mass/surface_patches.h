// The surface of a convex shape as flat patches: what a stream pushes on.
//
// In: a shape, and a plane above which nothing is wanted. Out: places, outward normals and areas, in the shape's frame. Boxes and
// hulls give every face in triangles from its middle, each with the three points at which a quadratic is summed exactly; faces
// are cut by the plane exactly. Round shapes give rings of sixteen patches whose sizes are exact; a patch that the plane cuts
// counts by the share of its height that is below.
//
// projected_area is the shadow that the shape throws along a direction, in closed form: sums over the patches of round shapes
// miss it by up to a few percent, and are scaled to it.
#pragma once

#include "base/function_ref.h"
#include "geometry/shape/shape.h"

namespace gyre {

struct SurfacePatch {
  DVec3 place;        // m
  DVec3 normal;       // unit, outward
  double area = 0.0;  // m^2
};

// Everything below {p : dot(normal, p) = level}; `level` kUnbounded for the whole surface. Convex kinds.
void for_each_patch(const Shape& shape, DVec3 normal, double level,
                    FunctionRef<void(const SurfacePatch&)> fn);

// The area (m^2) of the shape's shadow along the unit vector `direction`. Convex kinds.
double projected_area(const Shape& shape, DVec3 direction);

}  // namespace gyre
