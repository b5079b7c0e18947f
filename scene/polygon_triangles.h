// Triangulation of a polygon, concave or not, by clipping ears.
//
// In: corners in order, nearly in one plane. Out: corner numbers, three a triangle, wound like the polygon. Corners on the line
// between their neighbours get triangles with an area too. A polygon that crosses itself gets triangles that cover it somehow.
// G. Meisters, "Polygons have ears", 1975; M. Newell (normal of a polygon), in I. Sutherland et al., "A Characterization of Ten
// Hidden-Surface Algorithms", 1974.
#pragma once

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

// The time grows with the square of the number of corners, unless a fan from the first corner serves.
std::vector<std::uint32_t> triangulate_polygon(std::span<const Vec3> corners);
// True if a fan from the first corner serves: each of its triangles has an area and faces the side of the polygon.
bool is_fan(std::span<const Vec3> corners);

}  // namespace gyre
