// Contacts of two convex cores of any kind, each rounded by its radius. The normal comes from GJK if the cores are
// apart and from EPA if they overlap; the points come from the features that face each other along it.
//
// Source: the support-face construction after D. Gregorius, "Robust Contact Creation for Physics Simulations", GDC
// 2015.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

// Clipped points replace the closest points, or the deepest ones, if their smallest separation misses that of the pair
// by no more than this fraction of the thinner inner radius.
constexpr float kMissTolerance = 1.0e-3f;
// For overlapping sharp polyhedra this fraction of the depth is allowed too. A pair that missed its depth every time
// would never separate.
constexpr float kDepthTolerance = 0.1f;

// As collide_convex, for every pair of convex kinds.
void collide_cores(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out);

}  // namespace gyre
