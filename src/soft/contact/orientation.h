// Orientation predicates: the sign of the volume of a tetrahedron and of the area of a triangle, exact for every input.
//
// In: points in double, whose products neither overflow nor underflow. Out: -1, 0 or 1. A filter in double decides all but nearly degenerate input; the
// rest is computed without rounding, as sums of doubles that do not overlap.
//
// Source: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
#pragma once

#include <gyre/math.h>

namespace gyre {

// The sign of (a - d) . ((b - d) x (c - d)).
int orient3(DVec3 a, DVec3 b, DVec3 c, DVec3 d);

struct PlanePoint {
  double u = 0.0, v = 0.0;
};
// The sign of (a - c) x (b - c): 1 if a, b, c turn to the left.
int orient2(PlanePoint a, PlanePoint b, PlanePoint c);

}  // namespace gyre
