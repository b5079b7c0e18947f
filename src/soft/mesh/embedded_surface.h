// Embeds points in a mesh of tetrahedra, so that a fine surface moves with a coarse solid.
//
// In: the mesh, the size of its tetrahedra, and points. Out: for each point the four corners of the tetrahedron nearest to it, the lowest of
// equally near ones, and barycentric weights, which sum to 1. Weights of a point outside are negative in part: it is extrapolated.
#pragma once

#include "base/container/array.h"

#include <gyre/math.h>

#include <cstdint>
#include <span>

namespace gyre {

struct EmbeddedPoint {
  std::uint32_t corner[4] = {};
  float weight[4] = {};
};

struct EmbeddedSurface {
  Array<EmbeddedPoint> points;
  Array<std::uint32_t> triangles;  // three points each, seen from outside counter-clockwise
};

// `cell`: m, about the length of an edge. `distance` becomes the distance of each point from its tetrahedron, m.
Array<EmbeddedPoint> embed_points(std::span<const Vec3> vertices, std::span<const std::uint32_t> tetrahedra,
                                  double cell, std::span<const Vec3> points, Array<double>& distance);

}  // namespace gyre
