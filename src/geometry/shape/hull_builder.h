// Builds a Hull from points: exact triangles (quickhull), removal of vertices that do not matter, merging of flat
// neighbours into polygons, and the limits of 255 vertices and 255 faces.
//
// In: points in metres. Out: a Hull, or the reason why the points make none.
// Guarantees: closed (V - E + F = 2, each edge between two faces), no vertex above a face plane by more than rounding,
// and volume above 0. Unless the limit of 255 is reached, every point is within kHullTolerance of the largest extent
// (or of the float precision of the points, if they lie far from their origin).
#pragma once

#include "geometry/shape/hull.h"

#include <gyre/result.h>

#include <span>

namespace gyre {

// The tolerance of a hull, relative to its largest extent.
constexpr double kHullTolerance = 1.0e-6;

Result<Hull> build_hull(std::span<const Vec3> points);

}  // namespace gyre
