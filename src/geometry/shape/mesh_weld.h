// Welding: finds the vertices of a triangle list that have the same position.
//
// In: finite vertices and valid indices. Out: for each vertex the lowest one with its position. Equal coordinates are
// one position. So are coordinates that differ by at most a millionth of the mesh's extent, unless that would make an
// edge of a triangle vanish.
#pragma once

#include <gyre/math.h>

#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

std::vector<std::uint32_t> weld_vertices(std::span<const Vec3> vertices,
                                         std::span<const std::uint32_t> indices);

}  // namespace gyre
