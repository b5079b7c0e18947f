// Contacts of two convex cores of any kind, each swept by its ball: the normal comes from GJK while the cores are apart
// and from EPA when they overlap, the points from the features that face each other along it.
//
// Source: the support-face construction after D. Gregorius, "Robust Contact Creation for Physics Simulations", GDC 2015.
#pragma once

#include "geometry/manifold.h"

namespace gyre {

// As collide_convex, for every pair of convex kinds.
void collide_cores(const Shape& a, const Shape& b, const Transform& a_from_b, float max_separation,
                   PairCache& cache, LocalManifold& out);

}  // namespace gyre
