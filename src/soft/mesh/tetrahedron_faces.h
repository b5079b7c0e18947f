// The faces of tetrahedra, sorted by their vertices, so that those of neighbours stand beside each other.
#pragma once

#include "base/container/array.h"

#include <cstdint>
#include <span>

namespace gyre {

struct TetrahedronFace {
  std::uint32_t low, middle, high;      // its vertices, ascending
  std::uint32_t tetrahedron, opposite;  // the number, and which of its corners is not in the face

  bool has_vertices_of(const TetrahedronFace& other) const {
    return low == other.low && middle == other.middle && high == other.high;
  }
};

// `tetrahedra`: four vertices each. Faces of the same vertices are in the order of the tetrahedra.
Array<TetrahedronFace> sorted_faces(std::span<const std::uint32_t> tetrahedra);

}  // namespace gyre
