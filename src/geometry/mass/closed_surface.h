// Whether triangles bound a solid, so that integrals over its volume mean something: closed, wound alike, wound outwards,
// not crossing itself, no part inside another but as a hole.
//
// In: triangles with valid indices and finite vertices. Out: the first thing that is wrong, by triangle and vertices.
#pragma once

#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>
#include <span>

namespace gyre {

struct TriangleSurface {
  std::span<const Vec3> vertices;
  std::span<const std::uint32_t> indices;
  std::span<const std::uint32_t> source;  // numbers by which triangles are named; if empty, their place
  std::span<const std::uint32_t> welded;  // for each vertex, the one that stands for its place

  std::uint32_t triangle_count() const { return std::uint32_t(indices.size() / 3); }
  std::uint32_t name(std::uint32_t triangle) const { return source.empty() ? triangle : source[triangle]; }
  DVec3 corner(std::uint32_t triangle, int i) const {
    return DVec3(vertices[indices[3 * std::size_t(triangle) + std::size_t(i)]]);
  }
};

// Indices in range and in threes, finite vertices; needs no `welded`.
Error check_surface_data(const TriangleSurface& surface);
// Each edge is run through as often one way as the other.
Error check_edges(const TriangleSurface& surface);
// No edge passes through a triangle, and the space on the two sides of each triangle is covered once inside and not at all
// outside.
Error check_covered_once(const TriangleSurface& surface);

}  // namespace gyre
