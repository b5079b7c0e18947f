// Crossings: pairs of an edge and a triangle without a common vertex that have a point in common. Touching counts. The number is exact, whatever the
// positions: it is made of the signs of exact predicates (soft/contact/orientation.h) and of nothing else. So it judges all that is to keep surfaces
// apart.
#pragma once

#include "base/arena/arena.h"
#include "base/container/array.h"
#include "soft/contact/soft_surface.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

// True if the segment p-q and the triangle a, b, c (which may have no area) have a point in common.
bool segment_meets_triangle(DVec3 p, DVec3 q, DVec3 a, DVec3 b, DVec3 c);

// Crossings of each surface with itself and of each pair of surfaces.
long count_crossings(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions, Arena& arena);

// An edge of one surface that passes through a triangle of another, or of the same: its ends are on different sides. What only touches is none.
struct EdgeCrossing {
  std::uint32_t edge_surface = 0, edge = 0;  // numbers of the placed surface, and of the edge in it
  std::uint32_t triangle_surface = 0, triangle = 0;
};
// All of them; their order follows from the surfaces alone.
void list_passing_edges(std::span<const PlacedSurface> surfaces, std::span<const DVec3> positions,
                        Arena& arena, Array<EdgeCrossing>& crossings);

}  // namespace gyre
