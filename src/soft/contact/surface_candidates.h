// Candidates: pairs of features of soft surfaces without a common vertex that may be within reach of each other, kept from sub-step to sub-step.
//
// Each vertex has a track: a straight way at a constant speed over kTrackSteps sub-steps, at whose end it stays, and a reach about it. All tracks may move
// together. A list of candidates has every pair that comes within the reach of both features while their vertices keep to their tracks
// (the reach of a feature being the largest of its vertices'), and some more. A pair is left out if its boxes, as far as they reach, are
// separated by one axis at both ends of the tracks, or if its distance is more than the reach and the largest difference of the ways of two of its
// vertices. Features that move alike, however fast, are no candidates.
//
// A vertex that leaves its track gets a new one, and pairs of features that have such a vertex are searched for again: where a few vertices are stopped,
// few pairs are. All this only saves time: what is found from the list is the same whenever it was made.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/feature_filter.h"
#include "soft/contact/soft_surface.h"
#include "task/task_system.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// Numbers of the first triangle and edge of a surface over all surfaces.
struct FeatureBase {
  std::uint32_t triangle = 0, edge = 0;
};

// Leaves of surface a that one worker holds against those of b; `rest`: see for_each_marked_pair().
struct SearchBlock {
  std::uint32_t a, b;
  std::size_t begin, end;  // nodes of a
  bool rest;
};

// Candidates that one worker has found, and its room for the filter.
struct FoundCandidates {
  Array<SurfaceCandidate> corners, edges;
  Array<std::uint32_t> kept;
};

struct SurfaceCandidates {
  Array<SurfaceCandidate> corners, edges;  // ascending by numbers
  Array<FeatureBase> bases;                // by surface
  Array<PlacedSurface> surfaces;           // for which they were made
  // By vertex, the track: where it begins, and its way in a sub-step, m; how far from it the vertex reaches, m.
  Array<DVec3> start, way;
  Array<float> reach;
  Array<SearchBlock> blocks;
  Array<SurfaceCandidate> before;      // the list that a new one replaces
  std::vector<FoundCandidates> found;  // by worker, in the last search
  int time = 0;                        // sub-steps since tracks began
  bool is_far = false;                 // made so far from the origin that it holds for one sub-step only
  long new_tracks = 0;                 // vertices that got one, so far

  // Call this when a sub-step has ended.
  void advance() { ++time; }
};

// By vertex, the largest value of it and the vertices that share an edge with it: so every vertex of a feature has at least the largest value of the
// feature.
std::span<float> spread_over_features(std::span<const PlacedSurface> surfaces, std::span<const float> values,
                                      Arena& arena);

// Brings the list up to date for `reach` (m, by vertex, spread over features) at these positions and moves, those of one sub-step. New tracks reach as
// far as `ahead`, likewise spread, which is no less.
void update_candidates(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                       std::span<const DVec3> moves, std::span<const float> reach,
                       std::span<const float> ahead, Arena& arena, TaskSystem& tasks,
                       SurfaceCandidates& candidates);

// Input of the filter of pairs.
void fill_filter(std::span<const DVec3> positions, std::span<const DVec3> moves, std::span<const float> reach,
                 DVec3 origin, std::span<FilterVertex> out);

}  // namespace gyre
