// Merges the triangles of a convex hull into polygons where they are flat within a tolerance.
//
// In: a closed, convex, triangulated surface. Out: convex polygons of the same vertices, still closed. A merge must
// leave at least three faces at each vertex and every corner convex.
#pragma once

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// A loop of vertices, counter-clockwise seen from outside.
using FaceLoop = std::vector<std::uint8_t>;

// The face loops for at most 255 vertices. Each element of `triangles` has three indices. Corners of one face lie
// within `tolerance` of its plane.
std::vector<FaceLoop> join_flat_faces(std::span<const DVec3> vertices, std::span<const FaceLoop> triangles,
                                      double tolerance);

// Twice the area of the loop along its normal (M. E. Newell's method).
DVec3 loop_normal(std::span<const DVec3> vertices, std::span<const std::uint8_t> loop);

}  // namespace gyre
