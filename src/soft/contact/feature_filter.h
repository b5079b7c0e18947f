// The filter of pairs of features: leaves out pairs that are surely out of reach, several side by side.
//
// For each pair a direction is found that is nearly that of the shortest way between both features. If the extents of the features along it are
// farther apart than their reach, then so are the features, however good the direction is. Rounding is in the reach of the vertices. So a pair
// within reach is never left out; others may stay.
#pragma once

#include <cstdint>

namespace gyre {

// A vertex and a triangle, or two edges: vertices 0 against 1 2 3, or 0 1 against 2 3.
struct SurfaceCandidate {
  std::uint32_t vertex[4];
  std::uint32_t a, b;  // numbers over all surfaces: of the vertex and the triangle, or of the edges
  std::uint32_t surface_a, surface_b;  // indices of the placed surfaces
};

struct FilterVertex {
  float x, y, z;                 // m, from a common origin
  float reach;                   // m, with what rounding may take
  float move_x, move_y, move_z;  // m: features within reach and the difference of their moves are kept
  float unused;
};

// Write the indices of pairs that may be within reach, ascending; return how many there are. `kept` has room for `count` rounded up to eight.
using FeatureFilter = int (*)(const SurfaceCandidate* pairs, int count, const FilterVertex* vertices,
                              std::uint32_t* kept);
struct FeatureFilters {
  FeatureFilter corners, edges;
};

// The fastest ones for this machine.
const FeatureFilters& select_feature_filters();

}  // namespace gyre
