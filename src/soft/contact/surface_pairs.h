// Pairs of features of soft surfaces that are near each other: a vertex and a triangle, or two edges, without a common vertex, of one surface or of two.
//
// In: surfaces, positions, and a pad for each vertex (m). Out: every pair whose distance is at most the sum of its two pads, in the order of its key,
// which does not depend on positions. The pad of a feature is the largest of its vertices'.
//
// If a vertex moves by no more than its pad less its radius, then each pair that comes nearer than the sum of its radii is among those
// found: points of a feature move no further than its vertices.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/soft_surface.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

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
  DVec3 normal{};          // from B to A, of unit length
  double distance = 0.0;   // m
  std::uint64_t key = 0;
};

void find_surface_pairs(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                        std::span<const float> pads, Arena& arena, Array<SurfacePair>& pairs);

}  // namespace gyre
