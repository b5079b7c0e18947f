// Checks that triangles bound a solid, so that volume integrals have a meaning: closed, wound alike, wound outwards,
// without self-intersection, and without a piece inside another except as a hole.
//
// In: triangles with valid indices and finite vertices. Out: the first error, with its triangle and vertices.
#pragma once

#include <gyre/math.h>
#include <gyre/result.h>

#include <cstdint>
#include <span>

namespace gyre {

struct TriangleSurface {
  std::span<const Vec3> vertices;
  std::span<const std::uint32_t> indices;
  std::span<const std::uint32_t> source;  // numbers that name triangles in errors; if empty, their indices
  std::span<const std::uint32_t> welded;  // for each vertex, the representative of its position

  std::uint32_t triangle_count() const { return std::uint32_t(indices.size() / 3); }
  std::uint32_t name(std::uint32_t triangle) const { return source.empty() ? triangle : source[triangle]; }
  DVec3 corner(std::uint32_t triangle, int i) const {
    return DVec3(vertices[indices[3 * std::size_t(triangle) + std::size_t(i)]]);
  }
};

// Checks that indices are in range and in threes, and that vertices are finite. Does not need `welded`.
Error check_surface_data(const TriangleSurface& surface);
// Checks that each edge is used equally often in both directions.
Error check_edges(const TriangleSurface& surface);
// Checks that no edge passes through a triangle, and that the space behind each triangle is inside exactly once and the
// space before it not at all.
Error check_covered_once(const TriangleSurface& surface);

}  // namespace gyre
