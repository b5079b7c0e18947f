// Where two edges cross and the faces beside them are all but parallel.
//
// There the edges' axis beats the faces' by little, and as two plates rock on each other now one pair of edges wins and now
// another, each time with a single point, which holds nothing level: crossed planks trembled for ever. So the faces are taken
// whole. Their cut polygon holds the very point where the edges cross, and its other points are as real: places of the one
// surface within, or above, the other body.
#pragma once

#include "geometry/manifold/manifold.h"

namespace gyre {

// Cosine between the axis of the edges and a face's normal above which the face is asked (3.6 degrees).
constexpr float kNearFace = 0.998f;

// What rests on another is sunk by no more than this part of `thin`.
constexpr float kResting = 0.1f;

// Whether the manifold of the face says what the edges say, `separation`, and not a quite different depth. `thin` is the
// smallest half extent of the two. Of what rests the face may be twice as deep; from deep overlaps the edges lead out sooner.
inline bool replaces_crossing(const LocalManifold& face, float separation, float thin) {
  if (face.count < 2) return false;
  float low = face.points[0].separation;
  for (int i = 1; i < face.count; ++i) low = min(low, face.points[i].separation);
  const float depth = max(-separation, 0.0f);
  const float slack = 0.02f * absolute(separation) + 1.0e-3f * thin;
  return low <= separation + slack && low >= -depth - min(depth, kResting * thin) - 0.05f * thin;
}

}  // namespace gyre
