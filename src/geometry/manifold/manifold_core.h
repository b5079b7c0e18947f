// Contacts of two convex cores of any kind, each swept by its ball: the normal comes from GJK while the cores are apart
// and from EPA when they overlap, the points from the features that face each other along it.
//
// Source: the support-face construction after D. Gregorius, "Robust Contact Creation for Physics Simulations", GDC 2015.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

// Clipped points stand for the nearest pair of points, or for the deepest overlap, if the deepest of them misses it by
// no more than this part of the thinner shape's inner radius
constexpr float kMissTolerance = 1.0e-3f;
// ... and, of sharp polyhedra that overlap, this part of the depth too: what is lost again and again would never come
// free.
constexpr float kDepthTolerance = 0.1f;

// As collide_convex, for every pair of convex kinds.
void collide_cores(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out);

}  // namespace gyre
