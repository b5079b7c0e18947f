// Contacts at two crossing edges with nearly parallel faces around them.
//
// There the axis of the edges beats those of the faces by little. When two plates rock on each other, different pairs
// of edges win in turn, each with a single point, which cannot carry a plate: crossed planks trembled for ever. So the
// manifold of the faces is used. Its clipped polygon has the crossing point of the edges among its points, and the
// others are as real: points of one surface inside or above the other body.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

// Cosine (3.6 degrees) between the axis of the edges and a face normal above which the face is tried.
constexpr float kNearFace = 0.998f;

// The depth of a resting contact is at most this fraction of `thin`.
constexpr float kResting = 0.1f;

// True if the manifold of the face has nearly the separation of the edges. `thin` is the smallest half extent of the
// two. For a resting contact the face may be twice as deep; out of deep overlaps the edges give the shorter exit.
inline bool replaces_crossing(const LocalManifold& face, float separation, float thin) {
  if (face.count < 2) return false;
  float low = face.points[0].separation;
  for (int i = 1; i < face.count; ++i) low = min(low, face.points[i].separation);
  const float depth = max(-separation, 0.0f);
  const float slack = 0.02f * absolute(separation) + 1.0e-3f * thin;
  return low <= separation + slack && low >= -depth - min(depth, kResting * thin) - 0.05f * thin;
}

}  // namespace gyre
