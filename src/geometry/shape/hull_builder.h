// From points to a Hull: exact triangles (quickhull), vertices that do not matter taken out, flat neighbours joined to
// polygons, and everything held to the 255 vertices and 255 faces that a Hull can name.
//
// In: points in metres. Out: a Hull, or why the points make none.
// Guarantees: closed (V - E + F = 2, each edge between two faces), no vertex above any face plane by more than rounding,
// volume above 0, and, unless the 255 run out, every point within kHullTolerance of the largest extent (or of the points'
// own float precision, when they lie far from their origin).
#pragma once

#include "geometry/shape/hull.h"

#include <gyre/result.h>

#include <span>

namespace gyre {

// What a hull may lose, relative to its largest extent.
constexpr double kHullTolerance = 1.0e-6;

Result<Hull> build_hull(std::span<const Vec3> points);

}  // namespace gyre
