// One sub-step of a rope by backward Euler, solved exactly: the tension of each segment is an unknown beside the velocities, so that a rope
// that keeps its length is as easy as a soft one, at any ratio of masses and without iterations.
//
// With d the correction of the velocities u, places y = x + h u, n the directions of the segments and t = h T:
//
//   (M + h^2 K_tension + s K_bend) d + J^T t           = h (f + M g - K_bend y) + M (v - u) - h beta K_bend u
//   J d - t / (k h (h + beta))                         = (-C(y) - beta J u) / (h + beta),    J d = n (d_b - d_a),  C = l - l0
//
// (1 / k = 0 for segments that keep their length.) The unknowns of a particle and of the segment before it stand together, so the matrix is
// a band of half width 10, 7 without bending, and is factored as L D L^T: it is quasi-definite, so every pivot in this order exists.
// Each iteration of Newton's begins where the last one ended; the second is made only if segments have turned enough to show.
//
// Sources: L. H. Thomas, "Elliptic Problems in Linear Difference Equations over a Network", 1949; R. J. Vanderbei, "Symmetric Quasidefinite
// Matrices", 1995.
#pragma once

#include "base/arena/arena.h"
#include "soft/body/soft_body.h"

namespace gyre {

struct RopeSettings {
  float step = 0.0f;  // s
  Vec3 gravity{};     // m/s^2
  int most_iterations = 3;
};

struct RopeReport {
  int iterations = 0;
  double longest = 0.0;  // largest |C| / l0 at the end
};

RopeReport step_rope(SoftBody& body, const RopeSettings& settings, Arena& arena);

}  // namespace gyre
