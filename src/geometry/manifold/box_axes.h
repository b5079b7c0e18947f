// The 15 axes of two boxes by number, and how the one that decides is chosen among them: what the search in lanes
// (box_search_lanes) shares with that of one pair (manifold_box).
#pragma once

#include "geometry/shape/shape.h"

namespace gyre::boxes {

// Axes by number: 0 to 2 A's face normals, 3 to 5 B's, 6 + 3 i + j the cross product of A's axis i and B's axis j.
constexpr int kFirstB = 3, kFirstEdge = 6, kAxisCount = 15, kNoAxis = -1;
constexpr int kNext[3] = {1, 2, 0}, kAfter[3] = {2, 0, 1};

// How much better an axis must be to replace the favoured one: a part of the depth and of the thinnest half extent.
constexpr float kDepthBias = 0.05f, kSizeBias = 1.0e-3f;
// Squared sine between two edges below which they have no axis of their own (the faces' axes serve), and below which
// float rounding would show, so that the axis is worked out again in double.
constexpr float kParallel = 1.0e-8f, kShallow = 1.0e-2f;
// Error of a separation times a cross product's length, relative to the sum of all lengths in it.
constexpr float kRounding = 4.0e-7f;

struct Axis {
  int number = kNoAxis;
  float separation = -kUnbounded;

  // Of an axis of two edges: which of A's, and which of B's.
  int edge_a() const { return (number - kFirstEdge) / 3; }
  int edge_b() const { return (number - kFirstEdge) % 3; }
};

}  // namespace gyre::boxes
