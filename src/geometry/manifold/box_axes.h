// The 15 axes of two boxes by number, and the tolerances of the choice among them. Shared by the search for one pair
// (manifold_box) and the search in lanes (box_search_lanes).
#pragma once

#include "geometry/distance/sat_tolerance.h"
#include "geometry/shape/shape.h"

namespace gyre::boxes {

// 0 to 2 are A's face normals, 3 to 5 B's; 6 + 3 i + j is the cross product of A's axis i and B's axis j.
constexpr int kFirstB = 3, kFirstEdge = 6, kAxisCount = 15, kNoAxis = -1;
constexpr int kNext[3] = {1, 2, 0}, kAfter[3] = {2, 0, 1};

// The tolerances of all separating axis tests. The search in lanes compares floats.
constexpr float kDepthBias = kSatDepthBias, kSizeBias = kSatSizeBias;
constexpr float kParallel = float(kSatParallel), kShallow = kSatShallow;
static_assert(kParallel == 1.0e-8f);
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
