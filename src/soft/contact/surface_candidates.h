// Candidates: pairs of features of soft surfaces without a common vertex that may be within reach of each other, kept until the surfaces have moved too far.
//
// In: surfaces, positions, planned moves, and how far each vertex reaches. Out: a list that has every pair which the plan may bring within the reach of
// both features (that of a feature being the largest of its vertices'), and some more. A pair is left out if its boxes, as far as they
// reach, are separated by one axis at both ends of the plan, or if its distance is more than the reach and the largest difference of the moves of
// two of its vertices. Features that move alike, however fast, are no candidates. It only saves time: what is found from it is the same
// whenever it was made.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/feature_filter.h"
#include "soft/contact/soft_surface.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

// Numbers of the first triangle and edge of a surface over all surfaces.
struct FeatureBase {
  std::uint32_t triangle = 0, edge = 0;
};

struct SurfaceCandidates {
  Array<SurfaceCandidate> corners, edges;  // ascending by numbers
  Array<FeatureBase> bases;                // by surface
  Array<PlacedSurface> surfaces;           // for which they were made, as are
  Array<DVec3> positions, moves;           // these,
  Array<float> reach;                      // and these, m, by vertex
  int made = 0;                            // how often
};

// By vertex, the largest value of it and the vertices that share an edge with it: so every vertex of a feature has at least the largest value of the
// feature.
std::span<float> spread_over_features(std::span<const PlacedSurface> surfaces, std::span<const float> values,
                                      Arena& arena);

// Makes the list anew unless it has all for `reach` (m, by vertex, spread over features) at these positions and moves. A new one is made for `ahead`, likewise
// spread, which is no less.
void update_candidates(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                       std::span<const DVec3> moves, std::span<const float> reach,
                       std::span<const float> ahead, Arena& arena, SurfaceCandidates& candidates);

// Input of the filter of pairs.
void fill_filter(std::span<const DVec3> positions, std::span<const DVec3> moves, std::span<const float> reach,
                 DVec3 origin, std::span<FilterVertex> out);

}  // namespace gyre
