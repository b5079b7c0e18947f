// Tolerances of the separating axis test: for polytopes (separating_axis) and for boxes (geometry/manifold/box_axes.h).
#pragma once

namespace gyre {

// How much better an axis must be to replace the favoured one: fractions of the depth and of the thinner shape (the
// inner radius of a polytope, the half extent of a box).
constexpr float kSatDepthBias = 0.05f, kSatSizeBias = 1.0e-3f;
// Squared sine between two edges below which they have no axis of their own. The axes of the faces serve.
constexpr double kSatParallel = 1.0e-8;
// Squared sine below which rounding to float would show in the axis of two edges, so that it is computed in double.
constexpr float kSatShallow = 1.0e-2f;

}  // namespace gyre
