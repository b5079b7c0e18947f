// Pairs of features of soft surfaces that are near each other: a vertex and a triangle, or two edges, without a common vertex, of one surface or of two.
//
// In: surfaces, positions, the planned moves of vertices, and a limit for each vertex: how far from its plan it may end, m. Out: pairs that matter within
// these moves, in the order of their keys, which do not depend on positions: those at which forces may act, which may come within the sum of
// limits and radii of both features; and others that could come nearer than a share of their thickness, `least_gap`. Limit and radius
// of a feature are the largest of its vertices'.
//
// Points of two features move against each other by no more than the largest difference of the moves of two of their vertices; so a pair that is farther
// apart than this difference and the limits is missing. So is one that an axis keeps apart by more than the limits at both ends of the
// plan, the same way round, since all moves are straight. Features that move alike are pairs only where they are near each other.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/soft_surface.h"
#include "soft/contact/surface_candidates.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

struct SurfacePair {
  // The vertices of feature A, one or two of them, then those of feature B.
  std::uint32_t vertex[4] = {};
  std::uint16_t on_a = 1;
  // True if forces may act here. Where the closest point of a triangle lies on its boundary, other triangles and edges have the same point or a
  // nearer one; of all these pairs one touches, along a normal of the surface and not across a flat sheet's edges.
  bool touches = true;
  // Of the closest points, a = sum of weight times position over A, b likewise over B: positive on A, where they sum to 1, negative on B.
  float weight[4] = {};
  float thickness = 0.0f;  // m: the radii at the closest points together
  float friction[2] = {};  // static, dynamic
  DVec3
      normal{};  // from B to A, of unit length; zero where parts of a split vertex are in one place: they have no direction, and are free
  double distance = 0.0;  // m
  std::uint64_t key = 0;
};

// Pairs that one worker has found in one block of candidates.
struct FoundPairs {
  int worker = 0;
  std::size_t begin = 0, end = 0;  // in the worker's list
};

// Memory that lasts between searches.
struct PairSearch {
  SurfaceCandidates candidates;
  std::vector<Array<SurfacePair>> found;  // by worker
  Array<FoundPairs> blocks;
};

// The candidates are brought up to date where they must be; what is found does not depend on them.
void find_surface_pairs(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                        std::span<const DVec3> moves, std::span<const float> limits, float least_gap,
                        Arena& arena, TaskSystem& tasks, PairSearch& search, Array<SurfacePair>& pairs);

}  // namespace gyre
