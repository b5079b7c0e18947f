// One sub-step of a rope by backward Euler, solved exactly: the tension of each segment is an unknown beside the velocities, so that a rope
// that keeps its length is as easy as a soft one, at any ratio of masses and without iterations.
//
// With d the correction of the velocities u, places y = x + h u, n the directions of the segments and t = h T:
//
//   (M + h^2 K_tension + s K_bend) d + J^T t           = h (f + M g - K_bend y) + M (v - u) - h beta K_bend u
//   J d - t / (k h (h + beta))                         = (-C(y) - beta J u) / (h + beta),    J d = n (d_b - d_a),  C = l - l0
//
// (1 / k = 0 for segments that keep their length.) The unknowns of a particle and of the segment before it stand together, so the matrix is
// a band of half width 8, 7 without bending, and is factored as L D L^T: it is quasi-definite, so every pivot in this order exists.
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
  int most_iterations =
      10;  // with 3, ropes of rods that strike the ground are thrown by lengths that do not fit
  int least_iterations = 1;  // the stiffness of the tension is that of the iteration before
  std::span<const CarriedInertia> carried{};
};

struct RopeReport {
  int iterations = 0;
  double longest = 0.0;  // largest |C| / l0 at the end
};

// A sub-step between its parts: the factor of the last iteration and its result. Its memory is the arena's.
struct RopeStep {
  RopeReport report;
  double h = 0.0;
  double move = 0.0;  // s, for which a change of velocity moves the particles
  bool has_bending = false;
  std::span<double> band, right;
  std::span<DVec3> place, velocity;  // at the end of the sub-step
  std::span<Sym3> inverse;           // by particle, if find_rope_inverse_masses() was called
};

// Finds the velocities at the end of the sub-step, as if nothing touched the rope, and sets those of the particles.
RopeStep begin_rope(SoftBody& body, const RopeSettings& settings, Arena& arena);
// The blocks of the inverse of the whole matrix that belong to single particles, 1/kg: how a particle's velocity answers an impulse on it,
// with all others moving along. By the recurrence for a factored band (K. Takahashi, J. Fagan, M. Chen, 1973), in linear time.
void find_rope_inverse_masses(RopeStep& step, Arena& arena);
// The exact change of velocity by impulses (N s, by particle).
void respond_rope(SoftBody& body, RopeStep& step, std::span<const Vec3> impulses, std::span<Vec3> change);
// Adds a change that respond_rope() found.
void add_rope_change(SoftBody& body, RopeStep& step, std::span<const Vec3> change, double scale);
// Takes the part of the velocities that changes the lengths of segments where these end, by impulses along them. The scheme of two stages asks for it: the velocities of its last stage have
// an error along the segments, of the first order of the step, which would make the next stage push where the rope pulls. The place where it ends stays.
void keep_lengths(SoftBody& body, const RopeSettings& settings, RopeStep& step, Arena& arena);
// Moves the particles.
void finish_rope(SoftBody& body, const RopeStep& step);

// All of a sub-step of a rope that touches nothing.
RopeReport step_rope(SoftBody& body, const RopeSettings& settings, Arena& arena);

}  // namespace gyre
