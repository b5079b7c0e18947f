// The 15 axes of two boxes by number, and the tolerances of the choice among them. Shared by the search for one pair
// (manifold_box) and the search in lanes (box_search_lanes).
#pragma once

#include "geometry/shape/shape.h"

namespace gyre::boxes {

// 0 to 2 are A's face normals, 3 to 5 B's; 6 + 3 i + j is the cross product of A's axis i and B's axis j.
constexpr int kFirstB = 3, kFirstEdge = 6, kAxisCount = 15, kNoAxis = -1;
constexpr int kNext[3] = {1, 2, 0}, kAfter[3] = {2, 0, 1};

// How much better an axis must be to replace the favoured one: fractions of the depth and of the smallest half extent.
constexpr float kDepthBias = 0.05f, kSizeBias = 1.0e-3f;
// Squared sine below which two edges have no axis of their own (the axes of the faces serve), and below which rounding
// to float would show, so that the axis is recomputed in double.
constexpr float kParallel = 1.0e-8f, kShallow = 1.0e-2f;
// Error of a separation times the length of its cross product, relative to the sum of all lengths in it.
constexpr float kRounding = 4.0e-7f;

struct Axis {
  int number = kNoAxis;
  float separation = -kUnbounded;

  // Of an axis of two edges: the number of A's edge direction, and of B's.
  int edge_a() const { return (number - kFirstEdge) / 3; }
  int edge_b() const { return (number - kFirstEdge) % 3; }
};

}  // namespace gyre::boxes
