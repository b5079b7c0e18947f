// Removes triangles without area from a triangle list, so that surfaces stay closed.
//
// A triangle whose corners lie on one line has the corner in the middle on the long side of its neighbour. The neighbour is divided
// there, and the flat triangle is gone (an edge flip). A flat triangle without such a neighbour is left out.
//
// In: finite vertices, valid indices, the representatives of weld_vertices(). Out: the triangles that remain, of representatives.
#pragma once

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

struct TriangleList {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t>
      source;  // for each triangle the number of the one in the input whose surface it covers
};

TriangleList without_flat_triangles(std::span<const Vec3> vertices, std::span<const std::uint32_t> indices,
                                    std::span<const std::uint32_t> welded);

}  // namespace gyre
